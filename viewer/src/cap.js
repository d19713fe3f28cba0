// Where the section plane cuts a surface: the cut's outline, and its inside filled.
import * as THREE from "three";
import { capMaterials } from "./materials.js";

/**
 * Ends of the segments in which a plane x[axis] = place cuts triangles, three numbers each, two ends a segment. A corner
 * on the plane counts as above it, so that the outlines of a closed surface are closed.
 */
export function cutSegments(points, triangles, axis, place) {
  const ends = [];
  for (let t = 0; t < triangles.length; t += 3) {
    const corners = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const heights = corners.map((c) => points[c + axis] - place);
    if (heights[0] >= 0 === heights[1] >= 0 && heights[0] >= 0 === heights[2] >= 0) continue;
    for (let i = 0; i < 3; ++i) {
      const j = (i + 1) % 3;
      if (heights[i] >= 0 === heights[j] >= 0) continue;
      // From below to above whichever way the side runs: both its triangles find the same place.
      const [low, high] = heights[i] < heights[j] ? [i, j] : [j, i];
      const share = heights[low] / (heights[low] - heights[high]);
      for (let k = 0; k < 3; ++k) ends.push(k === axis ? place : points[corners[low] + k] + share * (points[corners[high] + k] - points[corners[low] + k]));
    }
  }
  return new Float32Array(ends);
}

/**
 * Fills outlines in the plane: triangles from one point to every segment flip the pixels they cover, so that those inside
 * an odd number of outlines remain; a square over all of them is drawn there.
 */
export function capMesh(ends, axis, place) {
  const hub = [0, 0, 0];
  hub[axis] = place;
  const fan = new Float32Array((9 * ends.length) / 6);
  for (let s = 0; s < ends.length / 6; ++s) {
    fan.set(hub, 9 * s);
    fan.set(ends.subarray(6 * s, 6 * s + 6), 9 * s + 3);
  }
  const square = [];
  for (const [u, v] of [[-1, -1], [1, -1], [1, 1], [-1, -1], [1, 1], [-1, 1]]) {
    const corner = [u, v];
    corner.splice(axis, 0, place);
    square.push(...corner);
  }
  const materials = capMaterials();
  const group = new THREE.Group();
  [fan, new Float32Array(square)].forEach((positions, i) => {
    const geometry = new THREE.BufferGeometry();
    geometry.setAttribute("position", new THREE.BufferAttribute(positions, 3));
    const mesh = new THREE.Mesh(geometry, materials[i]);
    mesh.frustumCulled = false;
    mesh.renderOrder = 1 + i; // after the surface
    group.add(mesh);
  });
  return group;
}
