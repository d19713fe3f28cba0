// Surfaces, results and lines as arrays in the scene's coordinates; decoded when first needed.
import { directionFrom, gridPoints, signedValue } from "./decode.js";
import { outlines, uniqueEdges, valences } from "./polygons.js";

const once = (make) => {
  let made;
  return () => (made ??= make());
};

/** All runs of a report. */
export function openModel(report, decode) {
  const surfaces = report.surfaces.map((surface) => openSurface(surface, decode));
  return report.runs.map((run) => openRun(run, surfaces[run.surface], decode));
}

function openSurface(surface, decode) {
  const rows = new Uint16Array(decode(surface.positions));
  const frame = { diagonal: surface.diagonal, centre: boxCentre(rows, surface) };
  const { points, extras } = gridPoints(rows, surface, frame);
  const triangles = new Uint32Array(decode(surface.triangles));
  return {
    about: surface,
    frame,
    points,
    triangles,
    confidence: Float32Array.from(extras, (value) => value / 65535),
    curvature: once(() => surface.curvature && curvatures(new Int16Array(decode(surface.curvature)))),
    directions: once(() => surface.directions && new Int8Array(decode(surface.directions))),
    normals: once(() => vertexNormals(points, triangles)),
    colours: once(() => surface.colours && new Uint8Array(decode(surface.colours))),
    guides: once(() => surface.guides && gridPoints(new Uint16Array(decode(surface.guides.ends)), surface, frame).points),
    edges: once(() => uniqueEdges(everyThird(triangles.length), triangles, points.length / 3)),
  };
}

function boxCentre(rows, grid) {
  const high = [0, 0, 0];
  for (let i = 0; i < rows.length; ++i) {
    if (i % 4 < 3) high[i % 4] = Math.max(high[i % 4], rows[i]);
  }
  return grid.low.map((low, k) => low + (high[k] * grid.step) / 2);
}

const everyThird = (count) => Uint32Array.from({ length: count / 3 + 1 }, (_, f) => 3 * f);

function curvatures(rows) {
  const count = rows.length / 2;
  const kMin = new Float32Array(count);
  const kMax = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    kMin[i] = signedValue(rows[2 * i]);
    kMax[i] = signedValue(rows[2 * i + 1]);
  }
  return { kMin, kMax };
}

function vertexNormals(points, triangles) {
  const normals = new Float32Array(points.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    const n = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    for (const corner of [a, b, c]) for (let k = 0; k < 3; ++k) normals[corner + k] += n[k];
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
    for (let k = 0; k < 3; ++k) normals[i + k] /= length;
  }
  return normals;
}

/** Directions of minimum curvature (or of the cross field) at a vertex, and across it. */
export function directionsAt(surface, vertex, which) {
  const bytes = surface.directions();
  const at = 4 * vertex + (which === "cross" ? 2 : 0);
  const along = directionFrom(bytes[at], bytes[at + 1]);
  const n = surface.normals().subarray(3 * vertex, 3 * vertex + 3);
  const across = [
    n[1] * along[2] - n[2] * along[1],
    n[2] * along[0] - n[0] * along[2],
    n[0] * along[1] - n[1] * along[0],
  ];
  return { along, across };
}

function openRun(run, surface, decode) {
  return {
    about: run,
    surface,
    result: once(() => openResult(run.result, surface.frame, decode)),
    lines: once(() => run.lines && openLines(run.lines, surface.frame, decode)),
  };
}

function openResult(result, frame, decode) {
  const { points } = gridPoints(new Uint16Array(decode(result.positions)), result, frame);
  const triangles = new Uint32Array(decode(result.triangles));
  const rows = new Uint8Array(decode(result.face_rows));
  const faces = rows.length / 4;
  const sides = Uint8Array.from({ length: faces }, (_, f) => rows[4 * f]);
  const faceOfTriangle = new Uint32Array(triangles.length / 3);
  let triangle = 0;
  for (let f = 0; f < faces; ++f) {
    for (let i = 2; i < sides[f]; ++i) faceOfTriangle[triangle++] = f;
  }
  const { offsets, corners } = outlines(triangles, sides);
  const edges = once(() => uniqueEdges(offsets, corners, points.length / 3));
  return {
    about: result,
    points,
    triangles,
    sides,
    faceOfTriangle,
    offsets,
    corners,
    edges,
    isConcave: (face) => rows[4 * face + 1] >= 128,
    /** Mean angle of a face's edges to the curvature, degrees; undefined where that means nothing. */
    angle: (face) => (rows[4 * face + 1] % 128 === 127 ? undefined : (rows[4 * face + 1] % 128) / 2),
    distanceShare: (face) => (rows[4 * face + 2] + 256 * rows[4 * face + 3]) / 65535,
    colours: once(() => result.colours && new Uint8Array(decode(result.colours))),
    labels: once(() => result.labels && new Uint32Array(decode(result.labels.of_face))),
    valence: once(() => valences(edges(), points.length / 3)),
    vertexLines: once(() => result.vertex_lines && new Uint32Array(decode(result.vertex_lines))),
  };
}

function openLines(lines, frame, decode) {
  const { points, extras } = gridPoints(new Uint16Array(decode(lines.points)), lines, frame);
  const buffer = decode(lines.rows);
  const view = new DataView(buffer);
  const rows = [];
  for (let at = 0; at < buffer.byteLength; at += 16) {
    rows.push({
      first: view.getUint32(at, true),
      end: points.length / 3,
      seed: view.getUint32(at + 4, true),
      length: view.getFloat32(at + 8, true),
      family: view.getUint8(at + 12),
      startReason: view.getUint8(at + 13),
      endReason: view.getUint8(at + 14),
      isClosed: view.getUint8(at + 15) !== 0,
    });
    if (rows.length > 1) rows.at(-2).end = rows.at(-1).first;
  }
  return { about: lines, points, families: extras, rows, segments: once(() => segmentsByFamily(rows, extras)) };
}

/** By family: pairs of points, and the line of each pair. */
function segmentsByFamily(rows, families) {
  const segments = [0, 1, 2, 3].map(() => ({ pairs: [], lines: [] }));
  rows.forEach((row, line) => {
    for (let p = row.first; p + 1 < row.end; ++p) {
      segments[families[p]].pairs.push(p, p + 1);
      segments[families[p]].lines.push(line);
    }
  });
  return segments;
}
