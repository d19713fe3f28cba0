// The panel beside the drawing: what each pane shows.
import { cssColour, endColours, endNames, familyColours, guideColour, scaleGradient, sideColours, unjudgedColour } from "./colours.js";
import { count, el, figure, percent } from "./dom.js";
import { facesShown } from "./numbers.js";
import { colouringsOf, curvatureEnd, distanceEnd, labelColour, shownColouring } from "./tints.js";

/** Builds the panel; call `refresh` after the view has changed elsewhere. */
export class Controls {
  constructor(runs, view, changed) {
    this.runs = runs;
    this.view = view;
    this.changed = changed;
    this.root = el("aside", { class: "controls", "aria-label": "What is shown" });
    this.refresh();
  }

  get pane() {
    return this.view.panes[this.view.edited];
  }

  set(change) {
    change();
    this.refresh();
    this.changed();
  }

  refresh() {
    const focus = document.activeElement?.dataset?.key;
    this.root.replaceChildren(
      ...[this.compare(), this.which(), this.surface(), this.lines(), this.directions(), this.section(), this.notes()].filter(Boolean),
    );
    if (focus) this.root.querySelector(`[data-key="${focus}"]`)?.focus();
  }

  /** Buttons of which one is chosen. */
  choice(label, options, chosen, choose) {
    return el("div", { class: "choice", role: "group", "aria-label": label },
      options.map(([value, text, key]) =>
        el("button", { "aria-pressed": String(value === chosen), "data-key": `${label} ${value}`, title: key ? `${text} (${key})` : text, onclick: () => this.set(() => choose(value)) }, text)));
  }

  toggle(name, text, { colour, detail, key } = {}) {
    const { layers } = this.pane;
    return el("label", { class: "toggle", title: key && `${text} (${key})` },
      el("input", { type: "checkbox", checked: layers.has(name), "data-key": `layer ${name}`, onchange: () => this.set(() => flip(layers, name)) }),
      colour && el("i", { class: "swatch line", style: `background:${cssColour(colour)}` }),
      el("span", {}, text), detail !== undefined && el("small", {}, detail));
  }

  compare() {
    const { view } = this;
    const box = el("section", {}, this.choice("Compare", [["one", "One view"], ["side", "Side by side", "S"], ["wipe", "Wipe", "W"]], view.compare, (value) => compareBy(view, value)));
    if (view.compare !== "one") {
      box.append(this.choice("View to set", [[0, "Left view"], [1, "Right view"]], view.edited, (value) => (view.edited = value)));
    }
    return box;
  }

  which() {
    if (this.runs.length < 2) return null;
    const { pane } = this;
    return el("section", {}, el("h2", {}, "Run"),
      el("select", { "data-key": "run", "aria-label": "Run", onchange: (event) => this.set(() => (pane.run = Number(event.target.value))) },
        this.runs.map((run, i) => el("option", { value: i, selected: i === pane.run }, run.about.name))));
  }

  surface() {
    const { pane } = this;
    const run = this.runs[pane.run];
    const box = el("section", {}, el("h2", {}, "Surface"),
      this.choice("Surface", [["input", "Input", "1"], ["result", "Result", "2"], ["none", "None", "0"]], pane.base, (value) => (pane.base = value)));
    if (pane.base !== "none") {
      const shown = shownColouring(run, pane.base, pane.colour[pane.base]);
      box.append(el("select", { "data-key": "colour", "aria-label": "Colour", title: "Colour (C)", onchange: (event) => this.set(() => (pane.colour[pane.base] = event.target.value)) },
        colouringsOf(run, pane.base).map(([value, label]) => el("option", { value, selected: value === shown }, label))));
      box.append(legend(run, this.runs, pane.base, shown));
    }
    box.append(this.toggle("edges", "Edges of the result", { key: "E" }), this.toggle("triangles", "Edges of the input"));
    return box;
  }

  lines() {
    const run = this.runs[this.pane.run];
    const lines = run.lines();
    if (!lines) return null;
    const names = { minimum: "Minimum curvature", maximum: "Maximum curvature", boundary: "Boundaries", feature: "Features" };
    const of = (family) => lines.rows.filter((row) => row.family === family).length;
    const box = el("section", {}, el("h2", {}, "Lines"),
      Object.entries(names).map(([name, text], family) => of(family) > 0 && this.toggle(name, text, { colour: familyColours[family], detail: count(of(family)), key: "L: all" })),
      this.toggle("seeds", "Where they began"), this.toggle("ends", "Where and why they ended"));
    if (this.pane.layers.has("ends")) box.append(endLegend(lines));
    return box;
  }

  directions() {
    if (!this.runs[this.pane.run].surface.about.directions) return null;
    const { guides } = this.runs[this.pane.run].surface.about;
    return el("section", {}, el("h2", {}, "Directions"),
      this.toggle("principal", "Principal directions", { key: "D" }), this.toggle("cross", "Cross field that lines follow"),
      guides && this.toggle("guides", "Guide lines", { colour: guideColour, detail: count(guides.lines) }));
  }

  section() {
    const { section } = this.view;
    const box = el("section", {}, el("h2", {}, "Section"),
      this.choice("Section", [["none", "None"], ["x", "X", "X"], ["y", "Y"], ["z", "Z"]], section.axis, (value) => (section.axis = value)));
    if (section.axis !== "none") {
      box.append(el("div", { class: "row" },
        el("input", { type: "range", min: 0, max: 1, step: 0.005, value: section.place, "aria-label": "Place of the section", oninput: (event) => {
          section.place = Number(event.target.value);
          this.changed();
        } }),
        el("button", { "data-key": "flip", title: "Show the other half", onclick: () => this.set(() => (section.flipped = !section.flipped)) }, "Flip")));
      const { base } = this.pane;
      const shown = base !== "none" && (base === "input" ? this.runs[this.pane.run].surface : this.runs[this.pane.run].result());
      if (shown && !shown.about.is_closed) box.append(el("p", { class: "quiet" }, "The surface is open: its cut is a line."));
    }
    return box;
  }

  notes() {
    const run = this.runs[this.pane.run];
    const texts = [facesShown(run.surface), ...run.about.missing].filter(Boolean);
    return texts.length > 0 && el("section", { class: "notes" }, texts.map((text) => el("p", {}, text)));
  }
}

/** One view is the left one, so that one is set then. */
export function compareBy(view, how) {
  view.compare = how;
  if (how === "one") view.edited = 0;
}

export function flip(set, name) {
  if (!set.delete(name)) set.add(name);
}

function legend(run, runs, base, colouring) {
  if (base === "result") {
    if (colouring === "sides") return sidesLegend(run);
    if (colouring === "alignment") return alignmentLegend();
    if (colouring === "labels") return labelsLegend(run);
    if (colouring === "distance") return ramp("distance", ["0", `${percent(distanceEnd(runs), 2)} of the diagonal`]);
    return "";
  }
  if (colouring === "confidence") return ramp("confidence", ["0: unreliable", "1: clear"]);
  if (!["k_min", "k_max"].includes(colouring)) return "";
  const end = figure(curvatureEnd(run.surface) / run.surface.about.diagonal, 2);
  return ramp("diverging", [`\u2212${end}`, "0", `+${end}`], ["concave", "flat", "convex"]);
}

const ramp = (scale, marks, names = []) =>
  el("div", { class: "ramp" }, el("i", { style: `background:${scaleGradient(scale)}` }),
    el("div", {}, marks.map((mark) => el("span", {}, mark))),
    names.length > 0 && el("div", {}, names.map((name) => el("span", {}, name))));

function alignmentLegend() {
  const box = ramp("alignment", ["0\u00b0", "22.5\u00b0", "45\u00b0"], ["along it", "random", "across"]);
  box.append(el("ul", { class: "key" }, el("li", {}, el("i", { class: "swatch", style: `background:${cssColour(unjudgedColour)}` }), el("span", {}, "no clear curvature"))));
  return box;
}

function labelsLegend(run) {
  const { kind, names } = run.about.result.labels;
  const tally = new Map();
  for (const label of run.result().labels()) tally.set(label, (tally.get(label) ?? 0) + 1);
  const shown = [...tally].sort((a, b) => b[1] - a[1]).slice(0, 8);
  return el("ul", { class: "key" }, shown.map(([label, faces]) =>
    el("li", {}, el("i", { class: "swatch", style: `background:${cssColour(labelColour(label))}` }), el("span", {}, names[label] ?? `${kind} ${label}`), el("small", {}, count(faces)))),
    tally.size > shown.length && el("li", {}, el("span", {}, `and ${tally.size - shown.length} more`)));
}

function sidesLegend(run) {
  const { sides } = run.result();
  const tally = { 3: 0, 4: 0, 5: 0, more: 0 };
  for (const side of sides) ++tally[side in tally ? side : "more"];
  const names = { 3: "triangles", 4: "quads", 5: "pentagons", more: "larger" };
  return el("ul", { class: "key" }, Object.entries(names).filter(([key]) => tally[key] > 0).map(([key, name]) =>
    el("li", {}, el("i", { class: "swatch", style: `background:${cssColour(sideColours[key])}` }), el("span", {}, name), el("small", {}, count(tally[key])))));
}

function endLegend(lines) {
  const tally = endNames.map(() => 0);
  for (const row of lines.rows) {
    if (row.isClosed) continue;
    ++tally[row.startReason];
    ++tally[row.endReason];
  }
  return el("ul", { class: "key" }, endNames.map((name, i) => tally[i] > 0 &&
    el("li", {}, el("i", { class: "swatch dot", style: `background:${cssColour(endColours[i])}` }), el("span", {}, name), el("small", {}, count(tally[i])))));
}
