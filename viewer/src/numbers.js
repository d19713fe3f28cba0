// The numbers of what was picked, and its mark in the drawing.
import { endNames, familyNames } from "./colours.js";
import { coordinate, count, el, figure, percent } from "./dom.js";
import { marks, strokes } from "./objects.js";
import { faceDistance } from "./tints.js";

const accent = [255, 200, 0];

/** {title, rows: [label, text][]} of a pick. */
export function describe(pick, runs) {
  const run = runs[pick.run];
  return { face: describeFace, vertex: describeVertex, line: describeLine, input: describeInput }[pick.kind](run, pick.index);
}

/** Whether the run has such an element: a link may come from another report. */
export function exists(pick, runs) {
  const run = runs[pick.run];
  const counts = {
    face: () => run.result().sides.length,
    vertex: () => run.result().points.length / 3,
    line: () => run.lines()?.rows.length ?? 0,
    input: () => run.surface.points.length / 3,
  };
  return pick.index >= 0 && pick.index < counts[pick.kind]();
}

const at = (points, i) => [...points.subarray(3 * i, 3 * i + 3)];
const minus = (a, b) => a.map((x, k) => x - b[k]);
const dot = (a, b) => a.reduce((sum, x, k) => sum + x * b[k], 0);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Model coordinates of a point of the scene. */
function modelPoint(run, point) {
  const { diagonal, centre } = run.surface.frame;
  return point.map((x, k) => x * diagonal + centre[k] + run.surface.about.origin[k]);
}
const pointText = (run, point) => modelPoint(run, point).map((x) => coordinate(x, run.surface.frame.diagonal)).join(", ");

function describeFace(run, face) {
  const result = run.result();
  const { diagonal } = run.surface.frame;
  const corners = [...result.corners.subarray(result.offsets[face], result.offsets[face + 1])];
  const places = corners.map((v) => at(result.points, v));
  const angles = [];
  const turns = [];
  const lengths = [];
  let normal = [0, 0, 0];
  places.forEach((p, i) => {
    const next = places[(i + 1) % places.length];
    const before = places[(i + places.length - 1) % places.length];
    const [u, v] = [minus(next, p), minus(before, p)];
    turns.push(cross(u, v));
    angles.push((Math.atan2(Math.hypot(...turns[i]), dot(u, v)) * 180) / Math.PI);
    lengths.push(Math.hypot(...u) * diagonal);
    normal = normal.map((x, k) => x + cross(minus(p, places[0]), minus(next, places[0]))[k]);
  });
  turns.forEach((turn, i) => dot(turn, normal) < 0 && (angles[i] = 360 - angles[i])); // a reflex corner
  const distance = faceDistance(run, face);
  return {
    title: `Face ${face}`,
    rows: [
      ["sides", result.sides[face] + (result.isConcave(face) ? ", concave" : "")],
      ["vertices", corners.join(", ")],
      ["area", figure((Math.hypot(...normal) / 2) * diagonal * diagonal, 4)],
      ["edge lengths", `${figure(Math.min(...lengths))} to ${figure(Math.max(...lengths))}`],
      ["angles", `${figure(Math.min(...angles))}\u00b0 to ${figure(Math.max(...angles))}\u00b0`],
      ["angle to the curvature", result.angle(face) === undefined ? "no clear curvature" : `${figure(result.angle(face))}\u00b0, mean of its edges`],
      ["largest distance", `${figure(distance * diagonal)} (${percent(distance)})`],
    ],
  };
}

function describeVertex(run, vertex) {
  const result = run.result();
  const lines = result.vertexLines() && [0, 1].map((k) => result.vertexLines()[2 * vertex + k]).filter((line) => line > 0);
  return {
    title: `Vertex ${vertex}`,
    rows: [
      ["position", pointText(run, at(result.points, vertex))],
      ["edges", String(result.valence()[vertex])],
      ["lines through it", lines?.length ? lines.map((line) => lineName(run, line - 1)).join(", ") : "none"],
    ],
  };
}

function lineName(run, line) {
  const row = run.lines()?.rows[line];
  return row ? `${line} (${familyNames[row.family]})` : String(line);
}

function describeLine(run, line) {
  const row = run.lines().rows[line];
  const { diagonal } = run.surface.frame;
  const ends = row.isClosed
    ? [["ends", "nowhere: closed"]]
    : [
        ["starts", endNames[row.startReason]],
        ["ends", endNames[row.endReason]],
      ];
  return {
    title: `Line ${line}`,
    rows: [
      ["family", familyNames[row.family]],
      ["length", `${figure(row.length)} (${percent(row.length / diagonal)})`],
      ...ends,
      ["seed", pointText(run, at(run.lines().points, row.seed))],
    ],
  };
}

function describeInput(run, vertex) {
  const { surface } = run;
  const curvature = surface.curvature();
  const rows = [["position", pointText(run, at(surface.points, vertex))]];
  if (curvature) {
    const radius = (k) => (Math.abs(k) < 1e-6 ? "flat" : `${figure(k / surface.frame.diagonal)} (radius ${figure(surface.frame.diagonal / Math.abs(k))})`);
    rows.push(["minimum curvature", radius(curvature.kMin[vertex])]);
    rows.push(["maximum curvature", radius(curvature.kMax[vertex])]);
    rows.push(["confidence", figure(surface.confidence[vertex])]);
  }
  return { title: "Place on the input", rows };
}

/** Fills `group` with the mark of a pick. */
export function mark(group, pick, runs) {
  group.clear();
  if (!pick) return;
  const run = runs[pick.run];
  if (pick.kind === "line") {
    const row = run.lines().rows[pick.index];
    const pairs = [];
    for (let p = row.first; p + 1 < row.end; ++p) pairs.push(p, p + 1);
    group.add(strokes(run.lines().points, pairs, accent, 5));
    group.add(marks(run.lines().points, [row.seed], [accent], 14, false));
  } else if (pick.kind === "face") {
    const result = run.result();
    const corners = [...result.corners.subarray(result.offsets[pick.index], result.offsets[pick.index + 1])];
    group.add(strokes(result.points, corners.flatMap((v, i) => [v, corners[(i + 1) % corners.length]]), accent, 4));
  } else {
    const points = pick.kind === "vertex" ? run.result().points : run.surface.points;
    group.add(marks(points, [pick.index], [accent], 15, false));
  }
}

/** The panel with the numbers. */
export function numbersPanel(pick, runs, close) {
  const { title, rows } = describe(pick, runs);
  return [
    el("header", {}, el("strong", {}, title), runs.length > 1 && el("span", { class: "quiet" }, runs[pick.run].about.name),
      el("button", { class: "icon", title: "Close (Esc)", onclick: close }, "\u00d7")),
    el("dl", {}, rows.map(([label, text]) => [el("dt", {}, label), el("dd", {}, text)])),
  ];
}

export const facesShown = (surface) => {
  const { faces, shown_faces: shown, shown_deviation_share: deviation } = surface.about;
  if (shown === faces) return null;
  return `The input is drawn with ${count(shown)} of its ${count(faces)} faces, about ${percent(deviation, 2)} of the diagonal off at most; figures are those of the whole input.`;
};
