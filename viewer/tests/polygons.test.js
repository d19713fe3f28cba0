import assert from "node:assert/strict";
import { test } from "node:test";
import { outlines, uniqueEdges, valences } from "../src/polygons.js";

/** A polygon from its least corner on. */
const fromLeast = (polygon) => {
  const first = polygon.indexOf(Math.min(...polygon));
  return [...polygon.slice(first), ...polygon.slice(0, first)];
};

const facesOf = ({ offsets, corners }) =>
  Array.from({ length: offsets.length - 1 }, (_, f) => fromLeast([...corners.subarray(offsets[f], offsets[f + 1])]));

test("outlines come back whichever diagonals divide a face, and whichever corner comes first", () => {
  // A pentagon, a quad and a triangle side by side, as decoded: corners of triangles are rotated.
  const triangles = [4, 0, 1, 1, 2, 4, 2, 3, 4, 5, 2, 1, 6, 2, 5, 7, 3, 2];
  const expected = [[0, 1, 2, 3, 4], [1, 5, 6, 2], [2, 7, 3]];
  for (let turn = 0; turn < 3; ++turn) {
    const turned = triangles.map((_, i) => triangles[3 * Math.floor(i / 3) + ((i + turn) % 3)]);
    assert.deepEqual(facesOf(outlines(turned, [5, 4, 3])), expected);
  }
});

test("every edge is there once, and vertices know how many they have", () => {
  // A cube: 12 edges, three at each of 8 vertices (Euler: 8 - 12 + 6 = 2).
  const quads = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
  const offsets = Uint32Array.from({ length: 7 }, (_, f) => 4 * f);
  const edges = uniqueEdges(offsets, Uint32Array.from(quads.flat()), 8);
  assert.equal(edges.length / 2, 12);
  assert.deepEqual([...valences(edges, 8)], Array(8).fill(3));
  // Without its lid the cube has the same edges, four of them with one face only.
  const open = uniqueEdges(offsets.slice(0, 6), Uint32Array.from(quads.filter((_, f) => f !== 1).flat()), 8);
  const pairs = (list) => [...Array(list.length / 2).keys()].map((i) => `${list[2 * i]} ${list[2 * i + 1]}`).sort();
  assert.deepEqual(pairs(open), pairs(edges));
});
