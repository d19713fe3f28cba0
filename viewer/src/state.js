// What is shown, and its text in the address: a link to a view.

import { inputColourings, resultColourings } from "./tints.js";

export const layerNames = [
  "edges", "triangles", "minimum", "maximum", "boundary", "feature", "ends", "seeds", "principal", "cross", "guides",
];

/** The view a report opens with. */
export function firstView(runCount) {
  const pane = (run, base, colour, layers) => ({ run, base, colour: { input: colour, result: colour }, layers: new Set(layers) });
  const left = pane(0, "result", "plain", ["edges"]);
  left.colour = { input: "k_max", result: "sides" };
  const right = pane(runCount > 1 ? 1 : 0, runCount > 1 ? "result" : "input", "plain", runCount > 1 ? ["edges"] : ["minimum", "maximum", "feature", "boundary"]);
  right.colour = { input: "plain", result: "sides" };
  return {
    tab: "surface",
    compare: "one",
    split: 0.5,
    edited: 0,
    panes: [left, right],
    camera: null,
    section: { axis: "none", place: 0.5, flipped: false },
    pick: null,
  };
}

const short = (number) => String(Number(number.toPrecision(4)));

/** A view as text for the address. */
export function toHash(view) {
  const parts = {
    tab: view.tab,
    compare: view.compare === "one" ? undefined : `${view.compare},${short(view.split)}`,
    a: paneText(view.panes[0]),
    b: view.compare === "one" ? undefined : paneText(view.panes[1]),
    camera: view.camera?.map(short).join(","),
    section:
      view.section.axis === "none"
        ? undefined
        : [view.section.axis, short(view.section.place), view.section.flipped ? "flipped" : ""].join(","),
    pick: view.pick ? `${view.pick.run},${view.pick.kind},${view.pick.index}` : undefined,
  };
  const shown = Object.entries(parts).filter(([, text]) => text !== undefined);
  return `#${shown.map(([name, text]) => `${name}=${text}`).join("&")}`;
}

const paneText = (pane) =>
  [pane.run, pane.base, pane.colour.input, pane.colour.result, [...pane.layers].join("+")].join(",");

/** Takes over what a text from an address says; what it cannot say is left as it is. */
export function fromHash(hash, view, runCount) {
  const parts = new Map(hash.replace(/^#/, "").split("&").map((part) => part.split("=", 2)));
  const list = (name) => (parts.get(name) ?? "").split(",");
  if (["surface", "figures", "origin"].includes(parts.get("tab"))) view.tab = parts.get("tab");
  const [compare, split] = list("compare");
  if (["side", "wipe"].includes(compare)) view.compare = compare;
  if (Number(split) > 0 && Number(split) < 1) view.split = Number(split);
  ["a", "b"].forEach((name, i) => parts.has(name) && readPane(list(name), view.panes[i], runCount));
  const camera = list("camera").map(Number);
  if (parts.has("camera") && camera.length === 6 && camera.every(Number.isFinite)) view.camera = camera;
  const [axis, place, flipped] = list("section");
  if (["x", "y", "z"].includes(axis)) {
    view.section = { axis, place: Math.min(Math.max(Number(place) || 0, 0), 1), flipped: flipped === "flipped" };
  }
  const [run, kind, index] = list("pick");
  if (isRun(run, runCount) && ["face", "vertex", "line", "input"].includes(kind) && Number.isInteger(Number(index))) {
    view.pick = { run: Number(run), kind, index: Number(index) };
  }
  return view;
}

const isRun = (text, runCount) => Number.isInteger(Number(text)) && Number(text) >= 0 && Number(text) < runCount;

function readPane([run, base, input, result, layers], pane, runCount) {
  if (isRun(run, runCount)) pane.run = Number(run);
  if (["input", "result", "none"].includes(base)) pane.base = base;
  if (Object.hasOwn(inputColourings, input)) pane.colour.input = input;
  if (Object.hasOwn(resultColourings, result)) pane.colour.result = result;
  pane.layers = new Set((layers ?? "").split("+").filter((name) => layerNames.includes(name)));
}
