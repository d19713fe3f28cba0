// Shaders. Colours are used as they are on the screen, so that they match the legends.
import * as THREE from "three";

/** The section plane, the same for all that is drawn: what lies beyond is left out. */
export const section = { value: new THREE.Vector4(0, 0, 0, 1) };

const beyondSection = "if (dot(place, section.xyz) > section.w) discard;";

// Moves a point towards the eye along the ray through it: it covers what lies right behind it.
const lift = (share) => `view.xyz *= ${(1 - share).toFixed(5)};`;

export function surfaceMaterial({ flat }) {
  return new THREE.ShaderMaterial({
    side: THREE.DoubleSide,
    uniforms: { section, inside: { value: new THREE.Color(0.45, 0.47, 0.52) } },
    vertexShader: `
      attribute vec3 tint;
      varying vec3 place, seen, facing, colour;
      void main() {
        place = (modelMatrix * vec4(position, 1.0)).xyz;
        vec4 view = viewMatrix * vec4(place, 1.0);
        seen = view.xyz;
        facing = ${flat ? "vec3(0.0)" : "normalMatrix * normal"};
        colour = tint;
        gl_Position = projectionMatrix * view;
      }`,
    fragmentShader: `
      uniform vec4 section;
      uniform vec3 inside;
      varying vec3 place, seen, facing, colour;
      void main() {
        ${beyondSection}
        vec3 n = ${flat ? "normalize(cross(dFdx(seen), dFdy(seen)))" : "normalize(gl_FrontFacing ? facing : -facing)"};
        float key = max(dot(n, normalize(vec3(-0.35, 0.55, 0.9))), 0.0);
        float fill = 0.5 + 0.5 * dot(n, normalize(vec3(0.5, -0.5, 0.6)));
        float shine = pow(max(dot(reflect(normalize(seen), n), normalize(vec3(-0.35, 0.55, 0.9))), 0.0), 24.0);
        vec3 base = gl_FrontFacing ? colour : inside;
        gl_FragColor = vec4(base * (0.36 + 0.46 * key + 0.26 * fill) + 0.08 * shine, 1.0);
      }`,
  });
}

/** Of a cut: what flips pixels, and what is drawn where they were flipped an odd number of times. */
export function capMaterials() {
  const vertexShader = "void main() { gl_Position = projectionMatrix * viewMatrix * modelMatrix * vec4(position, 1.0); }";
  const flip = new THREE.ShaderMaterial({
    side: THREE.DoubleSide, vertexShader, fragmentShader: "void main() { gl_FragColor = vec4(1.0); }",
    colorWrite: false, depthWrite: false, depthTest: false,
    stencilWrite: true, stencilFunc: THREE.AlwaysStencilFunc, stencilZPass: THREE.InvertStencilOp, stencilWriteMask: 1,
  });
  const fill = new THREE.ShaderMaterial({
    side: THREE.DoubleSide, vertexShader,
    uniforms: { ratio: { value: 1 } },
    fragmentShader: `
      uniform float ratio;
      void main() {
        bool isHatch = mod(gl_FragCoord.x + gl_FragCoord.y, 9.0 * ratio) < 1.5 * ratio;
        gl_FragColor = vec4(isHatch ? vec3(0.63, 0.55, 0.42) : vec3(0.85, 0.78, 0.65), 1.0);
      }`,
    stencilWrite: true, stencilFunc: THREE.EqualStencilFunc, stencilRef: 1, stencilFuncMask: 1,
    stencilFail: THREE.ZeroStencilOp, stencilZFail: THREE.ZeroStencilOp, stencilZPass: THREE.ZeroStencilOp,
  });
  return [flip, fill];
}

/** One pixel wide lines, on indexed segments. */
export function edgeMaterial() {
  return new THREE.ShaderMaterial({
    transparent: true,
    uniforms: { section, colour: { value: new THREE.Color() }, opacity: { value: 0.6 } },
    vertexShader: `
      varying vec3 place;
      void main() {
        place = (modelMatrix * vec4(position, 1.0)).xyz;
        vec4 view = viewMatrix * vec4(place, 1.0);
        ${lift(0.0008)}
        gl_Position = projectionMatrix * view;
      }`,
    fragmentShader: `
      uniform vec4 section;
      uniform vec3 colour;
      uniform float opacity;
      varying vec3 place;
      void main() {
        ${beyondSection}
        gl_FragColor = vec4(colour, opacity);
      }`,
  });
}

/** Segments of any width in pixels: one instance from `a` to `b` each. */
export function strokeMaterial(colour, width) {
  return new THREE.ShaderMaterial({
    uniforms: {
      section,
      colour: { value: new THREE.Color(...colour.map((c) => c / 255)) },
      width: { value: width },
      size: { value: new THREE.Vector2(1, 1) },
    },
    vertexShader: `
      attribute vec3 a, b;
      uniform vec2 size;
      uniform float width;
      varying vec3 place;
      vec4 project(vec3 point) {
        vec4 view = modelViewMatrix * vec4(point, 1.0);
        ${lift(0.002)}
        return projectionMatrix * view;
      }
      void main() {
        vec4 from = project(a), to = project(b);
        vec4 here = position.x < 0.5 ? from : to;
        vec2 along = (to.xy / to.w - from.xy / from.w) * size;
        float reach = length(along);
        along = reach > 1e-6 ? along / reach : vec2(1.0, 0.0);
        vec2 aside = vec2(-along.y, along.x) * position.y + along * (position.x - 0.5) * 0.6;
        here.xy += aside * width / size * here.w;
        place = (modelMatrix * vec4(position.x < 0.5 ? a : b, 1.0)).xyz;
        gl_Position = here;
      }`,
    fragmentShader: `
      uniform vec4 section;
      uniform vec3 colour;
      varying vec3 place;
      void main() {
        ${beyondSection}
        gl_FragColor = vec4(colour, 1.0);
      }`,
  });
}

/** Round marks of a size in pixels; `ring` leaves them open. */
export function markMaterial(size, ring) {
  return new THREE.ShaderMaterial({
    transparent: true,
    uniforms: { section, pixels: { value: size }, ratio: { value: 1 } },
    vertexShader: `
      attribute vec3 tint;
      uniform float pixels, ratio;
      varying vec3 place, colour;
      void main() {
        place = (modelMatrix * vec4(position, 1.0)).xyz;
        vec4 view = viewMatrix * vec4(place, 1.0);
        ${lift(0.003)}
        colour = tint;
        gl_PointSize = pixels * ratio;
        gl_Position = projectionMatrix * view;
      }`,
    fragmentShader: `
      uniform vec4 section;
      varying vec3 place, colour;
      void main() {
        ${beyondSection}
        float r = 2.0 * length(gl_PointCoord - 0.5);
        if (r > 1.0 ${ring ? "|| r < 0.5" : ""}) discard;
        gl_FragColor = vec4(r > 0.72 ${ring ? "&& false" : ""} ? vec3(1.0) : colour, 1.0);
      }`,
  });
}
