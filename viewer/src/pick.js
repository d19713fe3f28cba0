// What lies under a place of the drawing: a vertex, a line, a face, or a place of the input.
import * as THREE from "three";

const vertexReach = 8; // CSS pixels
const lineReach = 6;

/** \return {run, kind, index}, or null where there is nothing */
export function pickAt(stage, x, y) {
  const area = stage.areas().find(({ clip }) => x >= clip.x && x < clip.x + clip.width);
  if (!area) return null;
  const camera = stage.aim(area);
  const pane = stage.view.panes[area.pane];
  const run = stage.runs[pane.run];
  const at = new THREE.Vector2(((x - area.look.x) / area.look.width) * 2 - 1, 1 - (y / area.height) * 2);
  const caster = new THREE.Raycaster();
  caster.setFromCamera(at, camera);
  const screen = projector(camera, area);
  const surface = pane.base === "result" ? run.result() : run.surface;
  const hit = pane.base === "none" ? null : nearestHit(caster.ray, surface, sectionOf(stage));
  // Through the filled cut one sees nothing of what lies behind it.
  if (hit?.isInside && surface.about.is_closed && stage.view.section.axis !== "none") return null;
  const limit = hit ? screen(caster.ray.at(hit.distance, new THREE.Vector3()).toArray(), 0, [0, 0, 0])[2] + 0.01 : Infinity;
  const near = (kind, index) => index >= 0 && { run: pane.run, kind, index };
  return (
    (pane.base === "result" && hit && near("vertex", nearestCorner(run.result(), hit, screen, x, y))) ||
    near("line", nearestLine(run, pane.layers, screen, x, y, limit, sectionOf(stage))) ||
    (hit && (pane.base === "result"
      ? near("face", run.result().faceOfTriangle[hit.triangle])
      : near("input", hit.corner))) ||
    null
  );
}

const sectionOf = (stage) => {
  const { axis, place, flipped } = stage.view.section;
  if (axis === "none") return () => false;
  const k = "xyz".indexOf(axis);
  return (point) => (flipped ? point[k] < place - 0.5 : point[k] > place - 0.5);
};

/** Projects points to CSS pixels and their depth before the eye, which is less than their distance beside the middle. */
function projector(camera, area) {
  const matrix = new THREE.Matrix4().multiplyMatrices(camera.projectionMatrix, camera.matrixWorldInverse);
  const m = matrix.elements;
  return (points, index, out) => {
    const x = points[3 * index], y = points[3 * index + 1], z = points[3 * index + 2];
    const w = m[3] * x + m[7] * y + m[11] * z + m[15];
    out[0] = area.look.x + (0.5 + (0.5 * (m[0] * x + m[4] * y + m[8] * z + m[12])) / w) * area.look.width;
    out[1] = (0.5 - (0.5 * (m[1] * x + m[5] * y + m[9] * z + m[13])) / w) * area.height;
    out[2] = w;
    return out;
  };
}

/** The first triangle a ray meets on this side of the section. */
export function nearestHit(ray, { points, triangles }, isCut) {
  const [ox, oy, oz] = ray.origin.toArray();
  const [dx, dy, dz] = ray.direction.toArray();
  let best = null;
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t], b = 3 * triangles[t + 1], c = 3 * triangles[t + 2];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    const px = dy * vz - dz * vy, py = dz * vx - dx * vz, pz = dx * vy - dy * vx;
    const det = ux * px + uy * py + uz * pz;
    if (det === 0) continue;
    const sx = ox - points[a], sy = oy - points[a + 1], sz = oz - points[a + 2];
    const u = (sx * px + sy * py + sz * pz) / det;
    if (u < 0 || u > 1) continue;
    const qx = sy * uz - sz * uy, qy = sz * ux - sx * uz, qz = sx * uy - sy * ux;
    const v = (dx * qx + dy * qy + dz * qz) / det;
    if (v < 0 || u + v > 1) continue;
    const distance = (vx * qx + vy * qy + vz * qz) / det;
    if (distance <= 0 || (best && distance >= best.distance)) continue;
    if (isCut([ox + distance * dx, oy + distance * dy, oz + distance * dz])) continue;
    const weights = [1 - u - v, u, v];
    const corner = triangles[t + weights.indexOf(Math.max(...weights))];
    best = { triangle: t / 3, distance, corner, isInside: det < 0 };
  }
  return best;
}

function nearestCorner(result, hit, screen, x, y) {
  const face = result.faceOfTriangle[hit.triangle];
  let best = -1;
  let reach = vertexReach;
  for (let c = result.offsets[face]; c < result.offsets[face + 1]; ++c) {
    const [px, py] = screen(result.points, result.corners[c], [0, 0, 0]);
    const distance = Math.hypot(px - x, py - y);
    if (distance < reach) [best, reach] = [result.corners[c], distance];
  }
  return best;
}

function nearestLine(run, layers, screen, x, y, limit, isCut) {
  const lines = run.lines();
  if (!lines) return -1;
  let best = -1;
  let reach = lineReach;
  const p = [0, 0, 0];
  const q = [0, 0, 0];
  ["minimum", "maximum", "boundary", "feature"].forEach((name, family) => {
    if (!layers.has(name)) return;
    const { pairs, lines: lineOf } = lines.segments()[family];
    for (let i = 0; i < lineOf.length; ++i) {
      screen(lines.points, pairs[2 * i], p);
      screen(lines.points, pairs[2 * i + 1], q);
      if (Math.min(p[2], q[2]) <= 0 || Math.min(p[2], q[2]) > limit) continue;
      const distance = distanceToSegment(x, y, p, q);
      const at = 3 * pairs[2 * i];
      if (distance >= reach || isCut(lines.points.subarray(at, at + 3))) continue;
      [best, reach] = [lineOf[i], distance];
    }
  });
  return best;
}

function distanceToSegment(x, y, p, q) {
  const dx = q[0] - p[0];
  const dy = q[1] - p[1];
  const square = dx * dx + dy * dy;
  const t = square > 0 ? Math.min(Math.max(((x - p[0]) * dx + (y - p[1]) * dy) / square, 0), 1) : 0;
  return Math.hypot(p[0] + t * dx - x, p[1] + t * dy - y);
}
