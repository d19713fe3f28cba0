import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import { pickAt } from "../src/pick.js";

const width = 1600;
const height = 1000;

/** A square seen from the front, and a line that crosses it at x = 0.7, this far before it. */
function stageWithLine(z) {
  const camera = new THREE.PerspectiveCamera(32, width / height, 0.01, 10);
  camera.position.set(0, 0, 1.7);
  camera.updateMatrixWorld();
  const surface = { points: new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), triangles: [0, 1, 2, 0, 2, 3], about: {} };
  const lines = { points: new Float32Array([0.7, -0.5, z, 0.7, 0.5, z]), segments: () => [{ pairs: [0, 1], lines: [0] }, { pairs: [], lines: [] }] };
  const run = { surface, lines: () => lines };
  const whole = { x: 0, width };
  const stage = {
    areas: () => [{ pane: 0, height, clip: whole, look: whole }],
    aim: () => camera,
    runs: [run],
    view: { panes: [{ run: 0, base: "input", layers: new Set(["minimum"]) }], section: { axis: "none" } },
  };
  const at = new THREE.Vector3(0.7, 0, z).project(camera);
  return pickAt(stage, ((at.x + 1) / 2) * width, height / 2);
}

test("a line is picked before a surface, not through it", () => {
  assert.equal(stageWithLine(0.001).kind, "line");
  assert.equal(stageWithLine(-0.05).kind, "input");
});
