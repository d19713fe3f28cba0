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

const from = []; // sides that have no opposite yet
const to = [];

/** Writes the outline of the triangles first .. end - 1 to `corners` from `at` on. */
function outline(triangles, first, end, corners, at) {
  let open = 0;
  for (let t = 3 * first; t < 3 * end; t += 3) {
    for (let i = 0; i < 3; ++i) {
      const a = triangles[t + i];
      const b = triangles[t + ((i + 1) % 3)];
      // A side that another triangle of the face runs along the other way is an inner one.
      let side = 0;
      while (side < open && (from[side] !== b || to[side] !== a)) ++side;
      if (side < open) {
        --open;
        from[side] = from[open];
        to[side] = to[open];
      } else {
        from[open] = a;
        to[open++] = b;
      }
    }
  }
  let corner = from[0];
  for (let i = 0; i < end - first + 2; ++i) {
    corners[at + i] = corner;
    let side = 0;
    while (side < open - 1 && from[side] !== corner) ++side;
    corner = to[side];
    --open;
    from[side] = from[open];
    to[side] = to[open];
  }
}

/** Every edge of an oriented manifold once, as pairs of vertices. */
export function uniqueEdges(offsets, corners, vertexCount) {
  // Sides by their smaller vertex: those that run up, and those that run down.
  const first = new Uint32Array(vertexCount + 1);
  const forEachSide = (use) => {
    for (let f = 0; f + 1 < offsets.length; ++f) {
      let a = corners[offsets[f + 1] - 1];
      for (let c = offsets[f]; c < offsets[f + 1]; ++c) {
        use(a, corners[c]);
        a = corners[c];
      }
    }
  };
  let count = 0;
  forEachSide((a, b) => a < b && ++first[a + 1]);
  for (let v = 0; v < vertexCount; ++v) first[v + 1] += first[v];
  const upper = new Uint32Array(first[vertexCount]);
  const filled = first.slice();
  const edges = new Uint32Array(2 * corners.length);
  const add = (a, b) => {
    edges[count++] = a;
    edges[count++] = b;
  };
  forEachSide((a, b) => {
    if (a >= b) return;
    upper[filled[a]++] = b;
    add(a, b);
  });
  forEachSide((a, b) => {
    if (a <= b) return;
    let i = first[b];
    while (i < first[b + 1] && upper[i] !== a) ++i;
    if (i === first[b + 1]) add(b, a);
  });
  return edges.slice(0, count);
}

/** Number of edges at each vertex. */
export function valences(edges, vertexCount) {
  const valence = new Uint16Array(vertexCount);
  for (const vertex of edges) ++valence[vertex];
  return valence;
}
