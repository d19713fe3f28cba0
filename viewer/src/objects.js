// What is drawn of one run: built when first shown, kept from then on.
import * as THREE from "three";
import { capMesh, cutSegments } from "./cap.js";
import { cutColour, endColours, familyColours, guideColour } from "./colours.js";
import { edgeMaterial, markMaterial, strokeMaterial, surfaceMaterial } from "./materials.js";
import { directionsAt } from "./model.js";
import { distanceEnd, faceTints, inputTints } from "./tints.js";

const glyphCount = 3500;

const attribute = (array, size = 3) => new THREE.BufferAttribute(array, size);

/** Objects of a run, by layer. Runs on one surface share its objects. */
export class RunObjects {
  constructor(run, runs, shared) {
    this.run = run;
    this.runs = runs;
    this.shared = shared;
    this.made = new Map();
    this.cuts = new Map();
  }

  get(name, make) {
    if (!this.made.has(name)) this.made.set(name, make());
    return this.made.get(name);
  }

  input(colouring) {
    return this.shared.get(this.run.surface, `input ${colouring}`, () => {
      const { surface } = this.run;
      const geometry = this.shared.get(surface, "input geometry", () => {
        const made = new THREE.BufferGeometry();
        made.setAttribute("position", attribute(surface.points));
        made.setAttribute("normal", attribute(surface.normals()));
        made.setIndex(attribute(surface.triangles, 1));
        return made;
      });
      return tinted(geometry, inputTints(surface, colouring), surfaceMaterial({ flat: false }));
    });
  }

  result(colouring) {
    return this.get(`result ${colouring}`, () => {
      const result = this.run.result();
      const geometry = this.get("result geometry", () => {
        const made = new THREE.BufferGeometry();
        made.setAttribute("position", attribute(spread(result.points, result.triangles)));
        return made;
      });
      const tints = faceTints(this.run, colouring, distanceEnd(this.runs));
      const ofCorner = new Uint32Array(result.triangles.length);
      for (let c = 0; c < ofCorner.length; ++c) ofCorner[c] = result.faceOfTriangle[Math.floor(c / 3)];
      return tinted(geometry, spread(tints, ofCorner), surfaceMaterial({ flat: true }));
    });
  }

  edges() {
    return this.get("edges", () => wires(this.run.result().points, this.run.result().edges()));
  }

  triangles() {
    const { surface } = this.run;
    return this.shared.get(surface, "triangles", () => wires(surface.points, surface.edges()));
  }

  family(family) {
    return this.get(`family ${family}`, () => {
      const lines = this.run.lines();
      return strokes(lines.points, lines.segments()[family].pairs, familyColours[family], 2.2);
    });
  }

  seeds() {
    return this.get("seeds", () => {
      const lines = this.run.lines();
      const traced = lines.rows.filter((row) => row.family < 2);
      return marks(lines.points, traced.map((row) => row.seed), traced.map((row) => familyColours[row.family]), 10, true);
    });
  }

  ends() {
    return this.get("ends", () => {
      const lines = this.run.lines();
      const places = [];
      const colours = [];
      for (const row of lines.rows) {
        if (row.isClosed) continue;
        places.push(row.first, row.end - 1);
        colours.push(endColours[row.startReason], endColours[row.endReason]);
      }
      return marks(lines.points, places, colours, 9, false);
    });
  }

  /** Guide lines that were given. */
  guides() {
    const { surface } = this.run;
    return this.shared.get(surface, "guides", () => strokes(surface.guides(), [...Array(surface.guides().length / 3).keys()], guideColour, 4));
  }

  /** The cut of a surface, "input" or "result", with a plane; only the last one of each is kept. */
  cut(base, { axis, place }) {
    const key = `${axis} ${place}`;
    const last = this.cuts.get(base);
    if (last?.key === key) return last.object;
    last?.object.traverse((part) => {
      part.geometry?.dispose();
      part.material?.dispose();
    });
    const { points, triangles, about } = base === "input" ? this.run.surface : this.run.result();
    const k = "xyz".indexOf(axis);
    const ends = cutSegments(points, triangles, k, place - 0.5);
    const object = new THREE.Group();
    if (about.is_closed && ends.length > 0) object.add(capMesh(ends, k, place - 0.5));
    const outline = strokes(ends, [...Array(ends.length / 3).keys()], cutColour, 2);
    outline.material.uniforms.section = { value: new THREE.Vector4(0, 0, 0, 1) }; // rounding must not cut it off
    object.add(outline);
    this.cuts.set(base, { key, object });
    return object;
  }

  /** Short strokes along both directions; `which` is "principal" or "cross". */
  directions(which) {
    return this.shared.get(this.run.surface, `directions ${which}`, () => glyphs(this.run.surface, which));
  }
}

/** Objects by surface and name. */
export class SharedObjects {
  constructor() {
    this.made = new Map();
  }
  get(surface, name, make) {
    if (!this.made.has(surface)) this.made.set(surface, new Map());
    const named = this.made.get(surface);
    if (!named.has(name)) named.set(name, make());
    return named.get(name);
  }
}

/** Triples of `values` at the given indices. */
function spread(values, indices) {
  const result = new values.constructor(3 * indices.length);
  for (let i = 0; i < indices.length; ++i) {
    const at = 3 * indices[i];
    result[3 * i] = values[at];
    result[3 * i + 1] = values[at + 1];
    result[3 * i + 2] = values[at + 2];
  }
  return result;
}

function tinted(geometry, tints, material) {
  const own = new THREE.BufferGeometry();
  own.setIndex(geometry.index);
  for (const [name, values] of Object.entries(geometry.attributes)) own.setAttribute(name, values);
  own.setAttribute("tint", new THREE.BufferAttribute(tints, 3, true));
  return still(new THREE.Mesh(own, material));
}

/** Everything is in view nearly always; three.js need not find out. */
function still(object) {
  object.frustumCulled = false;
  object.matrixAutoUpdate = false;
  return object;
}

function wires(points, edges) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", attribute(points));
  geometry.setIndex(attribute(edges, 1));
  return still(new THREE.LineSegments(geometry, edgeMaterial()));
}

/** Strokes between pairs of points. */
export function strokes(points, pairs, colour, width) {
  const geometry = new THREE.InstancedBufferGeometry();
  const corners = new Float32Array([0, -0.5, 0, 1, -0.5, 0, 1, 0.5, 0, 0, 0.5, 0]);
  geometry.setAttribute("position", attribute(corners));
  geometry.setIndex([0, 1, 2, 0, 2, 3]);
  const a = new Float32Array((3 * pairs.length) / 2);
  const b = new Float32Array(a.length);
  for (let i = 0; i < pairs.length / 2; ++i) {
    for (let k = 0; k < 3; ++k) {
      a[3 * i + k] = points[3 * pairs[2 * i] + k];
      b[3 * i + k] = points[3 * pairs[2 * i + 1] + k];
    }
  }
  geometry.setAttribute("a", new THREE.InstancedBufferAttribute(a, 3));
  geometry.setAttribute("b", new THREE.InstancedBufferAttribute(b, 3));
  geometry.instanceCount = pairs.length / 2;
  const mesh = still(new THREE.Mesh(geometry, strokeMaterial(colour, width)));
  mesh.material.side = THREE.DoubleSide;
  return mesh;
}

export function marks(points, places, colours, size, ring) {
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", attribute(spread(points, places)));
  const tints = Uint8Array.from(colours.flat());
  geometry.setAttribute("tint", new THREE.BufferAttribute(tints, 3, true));
  return still(new THREE.Points(geometry, markMaterial(size, ring)));
}

function glyphs(surface, which) {
  const chosen = evenVertices(surface, glyphCount);
  const group = new THREE.Group();
  for (const [arm, colour] of [["along", familyColours[0]], ["across", familyColours[1]]]) {
    const points = new Float32Array(6 * chosen.vertices.length);
    const pairs = [];
    chosen.vertices.forEach((vertex, i) => {
      const trusted = which === "cross" ? 1 : surface.confidence[vertex];
      const half = 0.34 * chosen.spacing * (0.25 + 0.75 * trusted);
      const direction = directionsAt(surface, vertex, which)[arm];
      for (let k = 0; k < 3; ++k) {
        const middle = surface.points[3 * vertex + k];
        points[6 * i + k] = middle - half * direction[k];
        points[6 * i + 3 + k] = middle + half * direction[k];
      }
      pairs.push(2 * i, 2 * i + 1);
    });
    group.add(strokes(points, pairs, colour, 1.6));
  }
  return group;
}

/** About `count` vertices, none nearer to another than a spacing that suits the area. */
function evenVertices({ points, triangles }, count) {
  const spacing = Math.sqrt(surfaceArea(points, triangles) / count) || 1;
  const cubes = new Map(); // by place: the vertices chosen there
  const key = (x, y, z) => (x * 4096 + y) * 4096 + z;
  const vertices = [];
  for (let v = 0; v < points.length / 3; ++v) {
    const p = points.subarray(3 * v, 3 * v + 3);
    const [x, y, z] = [0, 1, 2].map((k) => Math.floor((p[k] + 1) / spacing));
    if (isTaken(cubes, key, points, p, spacing, x, y, z)) continue;
    vertices.push(v);
    const place = key(x, y, z);
    if (cubes.has(place)) cubes.get(place).push(v);
    else cubes.set(place, [v]);
  }
  return { vertices, spacing };
}

function isTaken(cubes, key, points, p, spacing, x, y, z) {
  for (let i = 0; i < 27; ++i) {
    for (const other of cubes.get(key(x - 1 + (i % 3), y - 1 + (Math.floor(i / 3) % 3), z - 1 + Math.floor(i / 9))) ?? []) {
      const q = 3 * other;
      if (Math.hypot(points[q] - p[0], points[q + 1] - p[1], points[q + 2] - p[2]) < spacing) return true;
    }
  }
  return false;
}

function surfaceArea(points, triangles) {
  let twice = 0;
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]];
    const ux = points[b] - points[a], uy = points[b + 1] - points[a + 1], uz = points[b + 2] - points[a + 2];
    const vx = points[c] - points[a], vy = points[c + 1] - points[a + 1], vz = points[c + 2] - points[a + 2];
    twice += Math.hypot(uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
  }
  return twice / 2;
}
