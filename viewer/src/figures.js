// Tables and histograms of all runs.
import { runColours } from "./colours.js";
import { count, el, figure, percent } from "./dom.js";

const whole = (value) => count(value);
const share = (value) => percent(value);
const degrees = (value) => `${figure(value)}\u00b0`;
const yes = (value) => (value ? "yes" : "no");

// Heading; then label, where the report of the stage evaluate says it, how it is written.
const figures = [
  ["Size"],
  ["vertices", "topology.candidate.vertices", whole],
  ["faces", "faces.count", whole],
  ["quads, share of faces", "faces.quad_share", share],
  ["quads, share of area", "faces.quad_area_share", share],
  ["triangles", "faces.triangles", whole],
  ["pentagons", "faces.pentagons", whole],
  ["Distance, shares of the diagonal"],
  ["RMS, both ways", "distance.rms_share", share],
  ["largest, both ways", "distance.max_share", share],
  ["largest, from result to input", "distance.to_reference.max_share", share],
  ["largest, from input to result", "distance.from_reference.max_share", share],
  ["normals, mean deviation", "normals.mean_deg", degrees],
  ["Directions"],
  ["edges within 10\u00b0 of curvature", "alignment.within_10_deg_share", share],
  ["mean angle to curvature", "alignment.mean_deg", degrees],
  ["edges within 10\u00b0 of the cross field", "alignment.cross.within_10_deg_share", share],
  ["Regularity"],
  ["vertices with 4 edges", "valence.share_4", share],
  ["T-joints", "valence.t_joints", whole],
  ["smallest angle", "angles.min_deg", degrees],
  ["largest angle", "angles.max_deg", degrees],
  ["concave faces", "faces.concave", whole],
  ["quads flat at a corner", "faces.flat_quads", whole],
  ["crossing pairs of faces", "shape.self_intersecting_pairs", whole],
  ["Topology"],
  ["oriented manifold", "topology.candidate.oriented_manifold", yes],
  ["same as the input", "topology.equal", yes],
  ["components", "topology.candidate.components", whole],
  ["boundary loops", "topology.candidate.boundary_loops", whole],
  ["genus", "topology.candidate.genus", whole],
  ["features kept, share of length", "features.kept_share", share],
  ["boundary kept, share of length", "boundary.kept_share", share],
];

export const stageOf = (run, name) => run.about.stages.find((record) => record.stage === name);

/** A figure of the stage evaluate; undefined where there is none. */
export const measure = (run, path) =>
  path.split(".").reduce((object, key) => object?.[key], stageOf(run, "evaluate")?.result);

export function figuresPage(runs) {
  return el("main", { class: "page" }, warnings(runs), el("h2", {}, "How values are spread"), runKey(runs), histograms(runs),
    el("h2", {}, "Figures"), table(runs));
}

function warnings(runs) {
  const texts = runs.flatMap((run) =>
    run.about.stages.flatMap((record) => record.warnings.map((text) => [run.about.name, record.stage, text])));
  if (texts.length === 0) return el("p", { class: "calm" }, "No stage had a warning.");
  return el("div", { class: "warnings", role: "note" }, el("h2", {}, "Warnings"),
    el("ul", {}, texts.map(([run, stage, text]) => el("li", {}, el("b", {}, runs.length > 1 ? `${run}, ${stage}: ` : `${stage}: `), text))));
}

export function runHeads(runs) {
  return runs.map((run, i) => el("th", { scope: "col" },
    runs.length > 1 && runSwatch(i), run.about.name));
}

const runSwatch = (i) => el("i", { class: "swatch", style: `background:${runColours[i % runColours.length]}` });

/** Which colour is which run, where there are several. */
const runKey = (runs) => runs.length > 1 &&
  el("ul", { class: "key runs" }, runs.map((run, i) => el("li", {}, runSwatch(i), run.about.name)));

function table(runs) {
  const groups = [];
  for (const [label, path, write] of figures) {
    if (!path) {
      groups.push({ title: label, rows: [] });
      continue;
    }
    const values = runs.map((run) => measure(run, path));
    if (values.every((value) => value === undefined)) continue;
    groups.at(-1).rows.push(el("tr", {}, el("th", { scope: "row" }, label), values.map((value) => el("td", {}, value === undefined ? "\u2013" : write(value)))));
  }
  return tables(runs, groups);
}

/** Groups of rows: a card each for one run, one table for several, so that columns stay in line. */
export function tables(runs, groups) {
  const full = groups.filter(({ rows }) => rows.length > 0);
  if (runs.length === 1) {
    return el("div", { class: "cards" }, full.map(({ title, rows }) =>
      el("div", { class: "scroll" }, el("table", {}, title && el("caption", {}, title), el("tbody", {}, rows)))));
  }
  const heads = el("thead", {}, el("tr", {}, el("td", {}), runHeads(runs)));
  return el("div", { class: "scroll" }, el("table", {}, heads, full.map(({ title, rows }) =>
    el("tbody", {}, title && el("tr", { class: "head" }, el("th", { colSpan: runs.length + 1, scope: "colgroup" }, title)), rows))));
}

const plots = [
  ["valence", "Edges at inner vertices", (b) => figure(b + 0.5), "even"],
  ["angles", "Angles at corners", (b) => `${figure(b)}\u00b0`, "even"],
  ["edge_lengths", "Lengths of edges, share of the diagonal", (b) => percent(b, 2), "ratio"],
  ["alignment", "Angle of edges to the curvature, by length", (b) => `${figure(b)}\u00b0`, "even"],
  ["distance", "Distance of faces, share of the diagonal", (b) => percent(b, 2), "ratio"],
];

function histograms(runs) {
  return el("div", { class: "plots" }, plots.map(([name, title, write]) => {
    const having = runs.filter((run) => run.about.histograms[name]?.shares.some((share) => share > 0));
    return having.length > 0 && el("figure", {}, el("figcaption", {}, title), plot(runs, name, write));
  }));
}

const width = 340;
const side = 26;
const height = 150;
const floor = 124;

function plot(runs, name, write) {
  const all = runs.map((run) => run.about.histograms[name]);
  const { bounds } = all.find(Boolean);
  const isCount = name === "valence";
  const used = bounds.slice(1).map((_, i) => all.some((histogram) => histogram?.shares[i] > 0));
  const first = Math.max(used.indexOf(true), 0);
  const last = Math.max(used.lastIndexOf(true), first);
  const top = Math.max(...all.flatMap((histogram) => histogram?.shares ?? [0]), 1e-9);
  const x = (bin) => side + ((bin - first) / (last + 1 - first)) * (width - 2 * side);
  const y = (value) => floor - (value / top) * (floor - 14);
  const drawing = el("svg:svg", { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": name });
  all.forEach((histogram, i) => histogram && drawing.append(runs.length === 1 ? bars(histogram) : steps(histogram, i)));
  drawing.append(el("svg:line", { x1: side, x2: width - side, y1: floor, y2: floor, class: "axis" }));
  drawing.append(el("svg:text", { x: side, y: 8, class: "peak" }, percent(top, 2)));
  const every = Math.max(1, Math.ceil((last - first + 1) / (isCount ? 8 : 5)));
  for (let bin = first; bin <= last + (isCount ? 0 : 1); bin += every) {
    drawing.append(el("svg:text", { x: x(bin + (isCount ? 0.5 : 0)), y: floor + 16, class: "tick" }, write(bounds[bin])));
  }
  return drawing;

  function hint(histogram, bin) {
    const range = isCount ? write(bounds[bin]) : `${write(bounds[bin])} to ${write(bounds[bin + 1])}`;
    return el("svg:title", {}, `${range}: ${percent(histogram.shares[bin])}`);
  }
  function bars(histogram) {
    const group = el("svg:g", { class: "bars" });
    for (let bin = first; bin <= last; ++bin) {
      const [left, right] = [x(bin), x(bin + 1)];
      group.append(el("svg:rect", { x: left + 0.5, width: Math.max(right - left - 1, 0.5), y: y(histogram.shares[bin]), height: floor - y(histogram.shares[bin]) }, hint(histogram, bin)));
    }
    return group;
  }
  function steps(histogram, run) {
    let path = `M${x(first)} ${floor}`;
    for (let bin = first; bin <= last; ++bin) path += `V${y(histogram.shares[bin]).toFixed(1)}H${x(bin + 1).toFixed(1)}`;
    return el("svg:path", { d: `${path}V${floor}`, class: "steps", style: `stroke:${runColours[run % runColours.length]}` }, el("svg:title", {}, runs[run].about.name));
  }
}

/** A few figures for the head of the drawing. */
export function headline(run) {
  const result = run.result();
  const quads = result.sides.reduce((sum, side) => sum + (side === 4 ? 1 : 0), 0) / Math.max(result.sides.length, 1);
  const rms = measure(run, "distance.rms_share");
  const most = measure(run, "distance.max_share");
  return [
    ["vertices", count(result.points.length / 3)],
    ["faces", count(result.sides.length)],
    ["quads", percent(quads)],
    ...(rms === undefined ? [] : [["RMS", percent(rms)], ["largest distance", percent(most)]]),
  ];
}
