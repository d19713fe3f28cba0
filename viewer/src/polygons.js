// Polygons out of the triangles they were divided into.

/**
 * Outlines of faces: face f has the corners offsets[f] .. offsets[f + 1] - 1, counter-clockwise.
 * Triangles of a face follow each other; a face of n sides has n - 2 of them.
 */
export function outlines(triangles, sides) {
  const offsets = new Uint32Array(sides.length + 1);
  for (let f = 0; f < sides.length; ++f) offsets[f + 1] = offsets[f] + sides[f];
  const corners = new Uint32Array(offsets[sides.length]);
  let triangle = 0;
  for (let f = 0; f < sides.length; ++f) {
    const end = triangle + sides[f] - 2;
    outline(triangles, triangle, end, corners, offsets[f]);
    triangle = end;
  }
  return { offsets, corners };
}

/** Writes the outline of the triangles first .. end - 1 to `corners` from `at` on. */
function outline(triangles, first, end, corners, at) {
  const next = new Map();
  for (let t = first; t < end; ++t) {
    for (let i = 0; i < 3; ++i) {
      const a = triangles[3 * t + i];
      const b = triangles[3 * t + ((i + 1) % 3)];
      // A side that another triangle of the face runs along the other way is an inner one.
      if (next.get(b)?.delete(a)) continue;
      if (!next.has(a)) next.set(a, new Set());
      next.get(a).add(b);
    }
  }
  let from = triangles[3 * first];
  for (let i = 0; i < end - first + 2; ++i) {
    corners[at + i] = from;
    const [to] = next.get(from) ?? [from];
    next.get(from)?.delete(to);
    from = to;
  }
}

/** Every edge once, as pairs of vertices. */
export function uniqueEdges(offsets, corners, vertexCount) {
  const edges = [];
  const seen = new Set();
  for (let f = 0; f + 1 < offsets.length; ++f) {
    for (let c = offsets[f]; c < offsets[f + 1]; ++c) {
      const a = corners[c];
      const b = corners[c + 1 < offsets[f + 1] ? c + 1 : offsets[f]];
      const key = a < b ? a * vertexCount + b : b * vertexCount + a;
      if (seen.has(key)) continue;
      seen.add(key);
      edges.push(a, b);
    }
  }
  return new Uint32Array(edges);
}

/** Number of edges at each vertex. */
export function valences(edges, vertexCount) {
  const valence = new Uint16Array(vertexCount);
  for (const vertex of edges) ++valence[vertex];
  return valence;
}
