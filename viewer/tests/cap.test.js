import assert from "node:assert/strict";
import { test } from "node:test";
import { cutSegments } from "../src/cap.js";

// The cube from -1/2 to 1/2, each side in two triangles.
const points = Float32Array.from([0, 1, 2, 3, 4, 5, 6, 7].flatMap((v) => [(v & 1) - 0.5, ((v >> 1) & 1) - 0.5, (v >> 2) - 0.5]));
const triangles = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]].flatMap(([a, b, c, d]) => [a, b, c, a, c, d]);

const ends = (axis, place) => {
  const numbers = cutSegments(points, triangles, axis, place);
  return Array.from({ length: numbers.length / 3 }, (_, i) => [...numbers.subarray(3 * i, 3 * i + 3)]);
};

test("the cut of a cube is a square in the plane, and closed", () => {
  for (const axis of [0, 1, 2]) {
    // Also through the corners of one side, which count as above.
    for (const place of [-0.25, 0, 0.3, 0.5]) {
      const cut = ends(axis, place);
      assert.ok(cut.every((end) => Math.abs(end[axis] - place) < 1e-6));
      const visits = new Map();
      let length = 0;
      let area = 0;
      for (let i = 0; i < cut.length; i += 2) {
        const [a, b] = [cut[i], cut[i + 1]].map((end) => end.filter((_, k) => k !== axis));
        length += Math.hypot(a[0] - b[0], a[1] - b[1]);
        area += Math.abs(a[0] * b[1] - a[1] * b[0]) / 2; // from the middle, which is inside
        for (const end of [cut[i], cut[i + 1]]) visits.set(end.join(), (visits.get(end.join()) ?? 0) + 1);
      }
      assert.ok(Math.abs(length - 4) < 1e-5 && Math.abs(area - 1) < 1e-5, `${axis} ${place}: ${length} ${area}`);
      assert.ok([...visits.values()].every((count) => count % 2 === 0), "an outline is open");
    }
    assert.equal(ends(axis, 0.6).length, 0);
    assert.equal(ends(axis, -0.5).length, 0, "all corners are above");
  }
});
