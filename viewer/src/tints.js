// The colours of surfaces: what each way of colouring shows, and its legend.
import { plainColour, scaleColour, sideColours } from "./colours.js";

/** Ways to colour the input. Each gives a colour per vertex. */
export const inputColourings = {
  plain: { label: "Plain" },
  k_min: { label: "Minimum curvature", needs: "field" },
  k_max: { label: "Maximum curvature", needs: "field" },
  confidence: { label: "Confidence", needs: "field" },
};

/** Ways to colour the result. Each gives a colour per face. */
export const resultColourings = {
  sides: { label: "Number of sides" },
  distance: { label: "Distance to the input" },
  plain: { label: "Plain" },
};

/** Bytes of [r, g, b] per vertex of the input. */
export function inputTints(surface, colouring) {
  const tints = new Uint8Array(surface.points.length);
  const colour = vertexColour(surface, colouring);
  for (let v = 0; v < tints.length / 3; ++v) tints.set(colour(v), 3 * v);
  return tints;
}

function vertexColour(surface, colouring) {
  if (colouring === "confidence") return (v) => scaleColour("confidence", surface.confidence[v]);
  if (colouring === "plain" || !surface.curvature()) return () => plainColour;
  const values = colouring === "k_min" ? surface.curvature().kMin : surface.curvature().kMax;
  const end = curvatureEnd(surface);
  return (v) => scaleColour("diverging", curvatureShare(values[v], end));
}

/** End of the scale for both curvatures, times the diagonal. */
export const curvatureEnd = (surface) => Math.max(surface.about.usual_k_max, 1e-9);

// Small curvatures need colours too: the scale goes by asinh, 6 times steeper in the middle.
const steepness = 6;
const curvatureShare = (value, end) =>
  0.5 + (0.5 * Math.asinh((steepness * value) / end)) / Math.asinh(steepness);

/** Bytes of [r, g, b] per face of the result. \param end  of the scale for distances, a share */
export function faceTints(run, colouring, end) {
  const result = run.result();
  const tints = new Uint8Array(3 * result.sides.length);
  for (let f = 0; f < result.sides.length; ++f) {
    tints.set(faceColour(run, result, colouring, f, end), 3 * f);
  }
  return tints;
}

function faceColour(run, result, colouring, face, end) {
  if (colouring === "sides") return sideColours[result.sides[face]] ?? sideColours.more;
  if (colouring === "plain") return plainColour;
  return scaleColour("distance", faceDistance(run, face) / end);
}

/** Largest distance of a face to the input, as a share of the diagonal. */
export const faceDistance = (run, face) =>
  (run.result().distanceShare(face) * run.about.result.largest_distance) / run.surface.about.diagonal;

/** End of the scale for distances, the same for all runs: 98 % of the faces of each are within. */
export function distanceEnd(runs) {
  const ends = runs.map((run) => {
    const { bounds, shares } = run.about.histograms.distance;
    let sum = 0;
    const bin = shares.findIndex((share) => (sum += share) >= 0.98);
    return bin < 0 ? 0 : bounds[bin + 1];
  });
  return Math.max(...ends, 1e-9);
}
