// The report's page: reads its data, builds the parts, and keeps them in step.
import { Controls, compareBy, flip } from "./controls.js";
import { readReport } from "./decode.js";
import { el } from "./dom.js";
import { figuresPage, headline } from "./figures.js";
import { openModel } from "./model.js";
import { exists, mark, numbersPanel } from "./numbers.js";
import { originPage } from "./origin.js";
import { pickAt } from "./pick.js";
import { makeStage } from "./stage.js";
import { firstView, fromHash, toHash } from "./state.js";
import { colouringsOf, shownColouring } from "./tints.js";

const tabs = [["surface", "Surface"], ["figures", "Figures"], ["origin", "Origin"]];

const keys = [
  ["1, 2, 0", "input, result, no surface"],
  ["C", "next colouring"],
  ["E", "edges of the result"],
  ["L", "lines"],
  ["D", "principal directions"],
  ["X", "section: next axis"],
  ["S, W", "side by side, wipe"],
  ["Arrows", "turn"],
  ["R", "whole model"],
  ["T", "light or dark"],
  ["Esc", "close"],
];

class App {
  constructor(report, runs) {
    this.report = report;
    this.runs = runs;
    this.address = location.hash;
    this.view = fromHash(this.address, firstView(runs.length), runs.length);
    this.numbers = el("div", { class: "numbers", hidden: true, role: "status" });
    this.labels = el("div", { class: "labels" });
    this.divider = el("div", { class: "divider", hidden: true, title: "Drag to wipe" });
    this.help = this.helpBox();
    this.controls = new Controls(runs, this.view, () => this.update());
    this.frame = el("div", { class: "stage" });
    this.surface = el("div", { class: "surface" }, this.frame, this.controls.root);
    this.pages = { surface: this.surface };
    this.body = el("div", { class: "body" }, this.surface);
    document.getElementById("app").replaceChildren(this.header(), this.body, this.help);
    this.stage = makeStage(this.frame, runs, this.view, () => this.noteAddress());
    this.frame.append(this.labels, this.divider, this.numbers);
    this.listen();
    this.update();
  }

  header() {
    const names = this.runs.map((run) => run.about.name);
    document.title = `${names.join(", ")} \u2013 strake report`;
    this.tabButtons = tabs.map(([name, text]) =>
      el("button", { role: "tab", "data-tab": name, onclick: () => this.set(() => (this.view.tab = name)) }, text));
    return el("header", { class: "top" }, el("h1", {}, names.length > 3 ? `${names.length} runs` : names.join(", ")),
      el("nav", { role: "tablist" }, this.tabButtons),
      el("div", { class: "tools" },
        el("button", { class: "icon", title: "Whole model (R)", onclick: () => this.resetCamera() }, "\u2922"),
        el("button", { class: "icon", title: "Light or dark (T)", onclick: () => this.switchTheme() }, "\u25d0"),
        el("button", { class: "icon", title: "Keys (?)", onclick: () => this.help.showModal() }, "?")));
  }

  helpBox() {
    const box = el("dialog", { class: "help" }, el("h2", {}, "Keys and pointer"),
      el("dl", {}, keys.map(([key, text]) => [el("dt", {}, key), el("dd", {}, text)]),
        el("dt", {}, "Drag, wheel"), el("dd", {}, "turn, zoom; right button or two fingers move"),
        el("dt", {}, "Click"), el("dd", {}, "numbers of a face, vertex or line"),
        el("dt", {}, "Address"), el("dd", {}, "always links to what is shown")),
      el("form", { method: "dialog" }, el("button", {}, "Close")));
    return box;
  }

  set(change) {
    change();
    this.controls.refresh();
    this.update();
  }

  /** Shows the view as it is now. */
  update() {
    const { view } = this;
    if (view.pick && !exists(view.pick, this.runs)) view.pick = null;
    for (const button of this.tabButtons) button.setAttribute("aria-selected", String(button.dataset.tab === view.tab));
    this.pages[view.tab] ??= view.tab === "figures" ? figuresPage(this.runs) : originPage(this.runs, this.report);
    // What is put in anew loses focus, place of scrolling, and the slider that is being dragged.
    if (this.body.firstChild !== this.pages[view.tab]) this.body.replaceChildren(this.pages[view.tab]);
    mark(this.stage.highlight, view.pick, this.runs);
    this.numbers.hidden = !view.pick;
    if (view.pick) this.numbers.replaceChildren(...numbersPanel(view.pick, this.runs, () => this.set(() => (view.pick = null))));
    this.showLabels();
    // Half a pane wants another distance, unless the user has chosen one.
    if (this.fitted !== view.compare && !view.camera) this.stage.reset();
    this.fitted = view.compare;
    this.noteAddress();
    this.stage.draw();
  }

  showLabels() {
    const { view } = this;
    this.divider.hidden = view.compare === "one";
    this.divider.classList.toggle("movable", view.compare === "wipe");
    this.divider.style.left = `${100 * (view.compare === "side" ? 0.5 : view.split)}%`;
    const panes = view.compare === "one" ? [view.panes[0]] : view.panes;
    this.labels.replaceChildren(...panes.map((pane) => {
      const run = this.runs[pane.run];
      return el("div", { class: "label" }, this.runs.length > 1 && el("b", {}, run.about.name),
        pane.base === "input" ? el("span", {}, "input") :
        headline(run).map(([label, value]) => el("span", {}, el("b", {}, value), ` ${label}`)));
    }));
    this.labels.classList.toggle("two", panes.length === 2);
  }

  /** The text that the address is to have. */
  get link() {
    return toHash(this.view);
  }

  /** The address is replaced at most a few times a second: browsers refuse more. */
  noteAddress() {
    clearTimeout(this.addressTimer);
    this.addressTimer = setTimeout(() => {
      if (location.hash !== this.address) return; // a new one has come in, its event is on the way
      history.replaceState(null, "", this.link);
      this.address = location.hash;
    }, 150);
  }

  resetCamera() {
    this.stage.reset();
    this.noteAddress();
  }

  switchTheme() {
    const root = document.documentElement;
    const dark = (root.dataset.theme ?? (matchMedia("(prefers-color-scheme: dark)").matches ? "dark" : "light")) === "dark";
    root.dataset.theme = dark ? "light" : "dark";
    this.stage.draw();
  }

  listen() {
    const { canvas } = this.stage;
    let down = null;
    canvas.addEventListener("pointerdown", (event) => (down = [event.clientX, event.clientY]));
    canvas.addEventListener("pointerup", (event) => {
      if (!down || Math.hypot(event.clientX - down[0], event.clientY - down[1]) > 5 || event.button !== 0) return;
      this.set(() => (this.view.pick = pickAt(this.stage, event.offsetX, event.offsetY)));
    });
    this.divider.addEventListener("pointerdown", (event) => {
      if (this.view.compare !== "wipe") return;
      this.divider.setPointerCapture(event.pointerId);
      this.divider.onpointermove = (move) => {
        const box = this.frame.getBoundingClientRect();
        this.view.split = Math.min(Math.max((move.clientX - box.left) / box.width, 0.02), 0.98);
        this.showLabels();
        this.noteAddress();
        this.stage.draw();
      };
      this.divider.onpointerup = () => (this.divider.onpointermove = null);
    });
    document.addEventListener("keydown", (event) => this.key(event));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.stage.draw());
    addEventListener("hashchange", () => {
      if (location.hash === this.address) return;
      this.address = location.hash;
      Object.assign(this.view, fromHash(location.hash, firstView(this.runs.length), this.runs.length));
      this.stage.placeCamera();
      this.set(() => {});
    });
  }

  key(event) {
    if (event.ctrlKey || event.metaKey || event.altKey || this.help.open) return;
    if (event.target.matches("input[type=range], select")) return;
    const { view } = this;
    const pane = view.panes[view.edited];
    const step = Math.PI / 24;
    const turns = { ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, -step], ArrowDown: [0, step] };
    if (turns[event.key] && view.tab === "surface") {
      event.preventDefault();
      this.stage.turn(...turns[event.key]);
      return;
    }
    const base = (name) => () => (pane.base = name);
    const actions = {
      1: base("input"),
      2: base("result"),
      0: base("none"),
      c: () => nextColour(pane, this.runs[pane.run]),
      e: () => flip(pane.layers, "edges"),
      l: () => flipLines(pane.layers),
      d: () => flip(pane.layers, "principal"),
      x: () => (view.section.axis = { none: "x", x: "y", y: "z", z: "none" }[view.section.axis]),
      s: () => compareBy(view, view.compare === "side" ? "one" : "side"),
      w: () => compareBy(view, view.compare === "wipe" ? "one" : "wipe"),
      Escape: () => (view.pick = null),
    };
    const name = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    if (name === "t") return this.switchTheme();
    if (name === "r") return this.resetCamera();
    if (name === "?") return this.help.showModal();
    if (Object.hasOwn(actions, name)) this.set(actions[name]);
  }
}

function flipLines(layers) {
  const families = ["minimum", "maximum", "boundary", "feature"];
  const any = families.some((name) => layers.has(name));
  for (const name of families) any ? layers.delete(name) : layers.add(name);
}

function nextColour(pane, run) {
  if (pane.base === "none") return;
  const names = colouringsOf(run, pane.base).map(([name]) => name);
  pane.colour[pane.base] = names[(names.indexOf(shownColouring(run, pane.base, pane.colour[pane.base])) + 1) % names.length];
}

async function start() {
  try {
    const { report, decode } = await readReport(document);
    const app = new App(report, openModel(report, decode));
    app.stage.drawNow();
    document.documentElement.dataset.ready = String(Math.round(performance.now()));
    window.strakeReport = app;
  } catch (error) {
    document.getElementById("app").replaceChildren(el("p", { class: "waiting" }, `This report cannot be shown: ${error.message}`));
    throw error;
  }
}

start();
