import assert from "node:assert/strict";
import { test } from "node:test";
import { describe } from "../src/numbers.js";

test("the angles of a concave face are those inside it", () => {
  const points = new Float32Array([0, 0, 0, 2, 0, 0, 0.5, 0.5, 0, 0, 2, 0]); // a dart, reflex at vertex 2
  const result = {
    points,
    sides: [4],
    offsets: [0, 4],
    corners: new Uint32Array([0, 1, 2, 3]),
    isConcave: () => true,
    angle: () => undefined,
    distanceShare: () => 0,
  };
  const surface = { frame: { diagonal: 1 }, about: { diagonal: 1 } };
  const run = { surface, result: () => result, about: { result: { largest_distance: 0 } } };
  const { rows } = describe({ run: 0, kind: "face", index: 0 }, [run]);
  const inside = 360 - 90 - 2 * (Math.atan2(0.5, 1.5) * 180) / Math.PI;
  assert.equal(new Map(rows).get("angles"), `${((Math.atan2(0.5, 1.5) * 180) / Math.PI).toFixed(1)}° to ${Math.round(inside)}°`);
});
