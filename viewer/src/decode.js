// Reads what `strake report` wrote: the inverse of strake/report/{blocks,quantise}.cpp.
import { MeshoptDecoder } from "meshoptimizer/decoder";
import { inflated } from "./inflate.js";

/** The report's description and a function that decodes its blocks. */
export async function readReport(document) {
  const report = JSON.parse(document.getElementById("report").textContent);
  if (report.format !== 2) throw new Error(`This report has format ${report.format}, not 2.`);
  const bytes = await inflated(document.getElementById("blocks"));
  await MeshoptDecoder.ready;
  return { report, decode: (block) => decodeBlock(block, bytes) };
}

/** ArrayBuffer with `count` rows of `stride` bytes. */
function decodeBlock(block, bytes) {
  const target = new Uint8Array(block.count * block.stride);
  if (block.count === 0) return target.buffer;
  const source = bytes.subarray(block.at, block.at + block.bytes);
  if (block.codec === "triangles") {
    MeshoptDecoder.decodeIndexBuffer(target, block.count, block.stride, source);
  } else {
    MeshoptDecoder.decodeVertexBuffer(target, block.count, block.stride, source);
  }
  return target.buffer;
}

/**
 * Points of a grid in the scene's coordinates, where the input's bounding box is centred and its
 * diagonal is 1. `extras` is the fourth number of each point.
 */
export function gridPoints(rows, grid, frame) {
  const count = rows.length / 4;
  const points = new Float32Array(3 * count);
  const extras = new Uint16Array(count);
  const factor = grid.step / frame.diagonal;
  const offset = [0, 1, 2].map((k) => (grid.low[k] - frame.centre[k]) / frame.diagonal);
  for (let i = 0; i < count; ++i) {
    for (let k = 0; k < 3; ++k) points[3 * i + k] = rows[4 * i + k] * factor + offset[k];
    extras[i] = rows[4 * i + 3];
  }
  return { points, extras };
}

/** Inverse of quantise_signed. */
export const signedValue = (steps) => Math.sinh(steps / 1024);

/** Inverse of quantise_direction: a unit vector from two signed bytes. */
export function directionFrom(a, b) {
  let x = a / 127;
  let y = b / 127;
  const z = 1 - Math.abs(x) - Math.abs(y);
  if (z < 0) {
    const folded = x;
    x = (1 - Math.abs(y)) * (folded < 0 ? -1 : 1);
    y = (1 - Math.abs(folded)) * (y < 0 ? -1 : 1);
  }
  const length = Math.hypot(x, y, z);
  return [x / length, y / length, z / length];
}
