// The drawing area: camera, panes, section. Draws when something has changed, not all the time.
import * as THREE from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { el } from "./dom.js";
import { section } from "./materials.js";
import { RunObjects, SharedObjects } from "./objects.js";
import { shownColouring } from "./tints.js";

const firstDirection = new THREE.Vector3(0.55, 0.35, 0.85).normalize();
const margin = 1.12;
const headroom = 44; // pixels at the top that labels cover
const restMs = 600;

/** What the browser draws with: "processor" where there is none for graphics, "none" where it does not draw at all. */
function graphics() {
  const gl = document.createElement("canvas").getContext("webgl2");
  if (!gl) return "none";
  const name = gl.getExtension("WEBGL_debug_renderer_info");
  const isSoftware = Boolean(name) && /swiftshader|llvmpipe|software|basic render/i.test(gl.getParameter(name.UNMASKED_RENDERER_WEBGL));
  gl.getExtension("WEBGL_lose_context")?.loseContext();
  return isSoftware ? "processor" : "graphics";
}

/** A stage, or what stands in for it where the browser cannot draw. */
export function makeStage(container, runs, view, changed) {
  const means = graphics();
  return means === "none" ? new NoStage(container) : new Stage(container, runs, view, changed, means === "processor");
}

/** Draws nothing, so that figures and origin can be read all the same. */
class NoStage {
  constructor(container) {
    this.highlight = new THREE.Group();
    this.canvas = el("p", { class: "waiting" },
      "This browser does not draw in space: it has no WebGL 2, or it is switched off. Figures and origin are there; surfaces are shown by another browser, or once its settings allow hardware acceleration.");
    container.append(this.canvas);
  }

  areas() {
    return [];
  }

  draw() {}
  drawNow() {}
  placeCamera() {}
  reset() {}
  turn() {}
}

class Stage {
  /**
   * \param changed  called after the user has moved the camera
   * \param isSoftware  whether there is no graphics processor: multisampling takes three times as long then
   */
  constructor(container, runs, view, changed, isSoftware) {
    this.runs = runs;
    this.view = view;
    const shared = new SharedObjects();
    this.objects = runs.map((run) => new RunObjects(run, runs, shared));
    this.isSoftware = isSoftware;
    this.renderer = new THREE.WebGLRenderer({ antialias: !this.isSoftware, preserveDrawingBuffer: true, stencil: true });
    THREE.ColorManagement.enabled = false;
    this.renderer.outputColorSpace = THREE.LinearSRGBColorSpace;
    this.renderer.autoClear = false;
    this.canvas = this.renderer.domElement;
    this.canvas.tabIndex = 0;
    this.canvas.setAttribute("aria-label", "Surfaces; drag to turn, click to ask for numbers");
    container.append(this.canvas);
    this.camera = new THREE.PerspectiveCamera(32, 1, 0.01, 10);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.minDistance = 0.01;
    this.controls.maxDistance = 8;
    this.controls.addEventListener("change", () => {
      this.draw();
      if (this.isPlacing) return;
      this.view.camera = [...this.camera.position.toArray(), ...this.controls.target.toArray()];
      changed();
    });
    this.highlight = new THREE.Group();
    this.placeCamera();
    new ResizeObserver(() => this.resize()).observe(container);
    this.resize();
  }

  /** Takes the camera from the view, or the first one. */
  placeCamera() {
    const [x, y, z, tx, ty, tz] = this.view.camera ?? this.fitting();
    this.camera.position.set(x, y, z);
    this.controls.target.set(tx, ty, tz);
    this.isPlacing = true;
    this.controls.update();
    this.isPlacing = false;
  }

  /** Where the camera stands and looks at to show all of the first pane's run. */
  fitting() {
    const { clientWidth, clientHeight } = this.canvas;
    const share = this.view.compare === "side" ? 0.5 : 1;
    const half = Math.tan((this.camera.fov * Math.PI) / 360);
    const covered = clientHeight > 0 ? headroom / clientHeight : 0;
    const up = (half * (1 - covered)) / margin;
    const aside = (half * share * clientWidth) / clientHeight / margin || up;
    const axes = [new THREE.Vector3(0, 1, 0).cross(firstDirection).normalize()];
    axes.push(firstDirection.clone().cross(axes[0]));
    const { points } = this.runs[this.view.panes[0].run].surface;
    const target = new THREE.Vector3();
    for (const axis of axes) target.addScaledVector(axis, middle(points, axis));
    const point = new THREE.Vector3();
    let distance = 0.1;
    for (let i = 0; i < points.length; i += 3) {
      point.fromArray(points, i).sub(target);
      const needed = Math.max(Math.abs(point.dot(axes[0])) / aside, Math.abs(point.dot(axes[1])) / up);
      distance = Math.max(distance, point.dot(firstDirection) + needed);
    }
    target.addScaledVector(axes[1], distance * half * covered); // the model sits below the labels
    return [...firstDirection.clone().multiplyScalar(distance).add(target).toArray(), ...target.toArray()];
  }

  reset() {
    this.view.camera = null;
    this.placeCamera();
    this.draw();
  }

  /** Turns the camera by angles in radians. */
  turn(around, up) {
    const offset = this.camera.position.clone().sub(this.controls.target);
    const at = new THREE.Spherical().setFromVector3(offset);
    at.theta += around;
    at.phi += up;
    at.makeSafe();
    this.camera.position.copy(this.controls.target).add(new THREE.Vector3().setFromSpherical(at));
    this.controls.update();
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    const size = `${clientWidth} ${clientHeight} ${devicePixelRatio}`;
    if (clientWidth === 0 || clientHeight === 0 || size === this.size) return;
    this.size = size;
    this.setRatio(Math.min(devicePixelRatio, 2));
    if (!this.view.camera) this.reset();
    this.draw();
  }

  draw() {
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => this.drawNow());
  }

  setRatio(ratio) {
    const { clientWidth, clientHeight } = this.canvas.parentElement;
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
  }

  /** Places of the panes in CSS pixels: what they may draw on, and what their camera looks at. */
  areas() {
    const { clientWidth: width, clientHeight: height } = this.canvas;
    const { compare, split } = this.view;
    const whole = { x: 0, width };
    if (compare === "one") return [{ pane: 0, height, clip: whole, look: whole }];
    if (compare === "side") {
      const half = Math.floor(width / 2);
      const right = { x: half, width: width - half };
      return [
        { pane: 0, height, clip: { x: 0, width: half }, look: { x: 0, width: half } },
        { pane: 1, height, clip: right, look: right },
      ];
    }
    const at = Math.round(split * width);
    return [
      { pane: 0, height, clip: { x: 0, width: at }, look: whole },
      { pane: 1, height, clip: { x: at, width: width - at }, look: whole },
    ];
  }

  /** \param fine  smooth edges in software too; without it they follow when nothing has changed for a while */
  drawNow(fine = !this.isSoftware) {
    const { renderer } = this;
    cancelAnimationFrame(this.waiting);
    this.waiting = null;
    clearTimeout(this.resting);
    if (!fine) this.resting = setTimeout(() => this.drawNow(true), restMs);
    this.isFine = fine;
    const ratio = fine && this.isSoftware ? 2 : Math.min(devicePixelRatio, 2);
    if (renderer.getPixelRatio() !== ratio) this.setRatio(ratio);
    this.setSection();
    renderer.setScissorTest(false);
    renderer.setClearColor(getComputedStyle(this.canvas).backgroundColor);
    renderer.clear();
    renderer.setScissorTest(true);
    for (const area of this.areas()) {
      renderer.setScissor(area.clip.x, 0, area.clip.width, area.height);
      renderer.setViewport(area.look.x, 0, area.look.width, area.height);
      renderer.render(this.scene(area), this.aim(area));
    }
  }

  /** The camera for an area. */
  aim(area) {
    const distance = this.camera.position.length();
    this.camera.aspect = area.look.width / area.height;
    this.camera.near = Math.max(distance - 1.2, distance * 0.01, 0.002);
    this.camera.far = distance + 1.2;
    this.camera.updateProjectionMatrix();
    this.camera.updateMatrixWorld();
    return this.camera;
  }

  setSection() {
    const { axis, place, flipped } = this.view.section;
    const normal = { none: [0, 0, 0], x: [1, 0, 0], y: [0, 1, 0], z: [0, 0, 1] }[axis];
    const sign = flipped ? -1 : 1;
    section.value.set(...normal.map((n) => n * sign), axis === "none" ? 1 : sign * (place - 0.5));
  }

  /** What a pane shows. */
  scene(area) {
    const scene = new THREE.Scene();
    const shown = visibleObjects(this.view.panes[area.pane], this.view.section, this.objects);
    const ink = new THREE.Color(getComputedStyle(this.canvas).color);
    for (const [name, object] of shown) {
      object.traverse((part) => prepare(part, name, ink, area, this.renderer.getPixelRatio()));
      scene.add(object);
    }
    if (this.view.pick && this.view.pick.run === this.view.panes[area.pane].run) {
      this.highlight.traverse((part) => prepare(part, "pick", ink, area, this.renderer.getPixelRatio()));
      scene.add(this.highlight);
    }
    return scene;
  }
}

/** Half way between the extremes of points along an axis. */
function middle(points, axis) {
  let [low, high] = [Infinity, -Infinity];
  for (let i = 0; i < points.length; i += 3) {
    const place = points[i] * axis.x + points[i + 1] * axis.y + points[i + 2] * axis.z;
    low = Math.min(low, place);
    high = Math.max(high, place);
  }
  return (low + high) / 2;
}

function prepare(part, name, ink, area, ratio) {
  const uniforms = part.material?.uniforms;
  if (!uniforms) return;
  uniforms.size?.value.set(area.look.width / 2, area.height / 2);
  if (uniforms.ratio) uniforms.ratio.value = ratio;
  if (uniforms.opacity) {
    uniforms.colour.value.copy(ink);
    // Many edges would turn the surface black.
    const edges = part.geometry.index.count / 2;
    uniforms.opacity.value = name === "triangles" ? 0.22 : Math.min(Math.max(60 / Math.sqrt(edges), 0.35) * (ratio > 1 ? 1.3 : 1), 0.9);
  }
}

/** Names and objects of all that a pane shows. */
function visibleObjects(pane, section, objects) {
  const of = objects[pane.run];
  const lines = of.run.lines();
  const shown = [];
  if (pane.base !== "none") shown.push([pane.base, of[pane.base](shownColouring(of.run, pane.base, pane.colour[pane.base]))]);
  if (pane.base !== "none" && section.axis !== "none") shown.push(["cut", of.cut(pane.base, section)]);
  if (pane.layers.has("edges")) shown.push(["edges", of.edges()]);
  if (pane.layers.has("triangles")) shown.push(["triangles", of.triangles()]);
  if (lines) {
    ["minimum", "maximum", "boundary", "feature"].forEach((name, family) => {
      if (pane.layers.has(name) && lines.segments()[family].pairs.length > 0) shown.push([name, of.family(family)]);
    });
    if (pane.layers.has("seeds")) shown.push(["seeds", of.seeds()]);
    if (pane.layers.has("ends")) shown.push(["ends", of.ends()]);
  }
  if (pane.layers.has("guides") && of.run.surface.guides()) shown.push(["guides", of.guides()]);
  for (const which of ["principal", "cross"]) {
    if (pane.layers.has(which) && of.run.surface.directions()) shown.push([which, of.directions(which)]);
  }
  return shown;
}
