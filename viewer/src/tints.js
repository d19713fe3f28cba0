// The colours of surfaces: what each way of colouring shows, and its legend.
import { plainColour, runColours, scaleColour, sideColours, unjudgedColour } from "./colours.js";

/** Ways to colour the input. Each gives a colour per vertex. */
export const inputColourings = {
  plain: { label: "Plain" },
  k_min: { label: "Minimum curvature", needs: "curvature" },
  k_max: { label: "Maximum curvature", needs: "curvature" },
  confidence: { label: "Confidence", needs: "curvature" },
  colours: { label: "Its own colours", needs: "colours" },
};

/** Ways to colour the result. Each gives a colour per face. */
export const resultColourings = {
  sides: { label: "Number of sides" },
  distance: { label: "Distance to the input" },
  alignment: { label: "Angle to the curvature", needs: "alignment" },
  colours: { label: "Its own colours", needs: "colours" },
  labels: { label: "Its labels", needs: "labels" },
  plain: { label: "Plain" },
};

/** Names and labels of the ways to colour that a run has what it takes for. */
export function colouringsOf(run, base) {
  const has = base === "input" ? run.surface.about : { ...run.about.result, alignment: run.about.histograms.alignment };
  const all = base === "input" ? inputColourings : resultColourings;
  return Object.entries(all).filter(([, { needs }]) => !needs || has[needs]).map(([name, { label }]) => [name, label]);
}

/** The way to colour that is shown: the wanted one, or the first where the run has not what that takes. */
export function shownColouring(run, base, wanted) {
  const names = colouringsOf(run, base).map(([name]) => name);
  return names.includes(wanted) ? wanted : names[0];
}

/** Bytes of [r, g, b] per vertex of the input. */
export function inputTints(surface, colouring) {
  const tints = new Uint8Array(surface.points.length);
  const colour = vertexColour(surface, colouring);
  for (let v = 0; v < tints.length / 3; ++v) tints.set(colour(v), 3 * v);
  return tints;
}

function vertexColour(surface, colouring) {
  if (colouring === "confidence") return (v) => scaleColour("confidence", surface.confidence[v]);
  if (colouring === "colours") return (v) => surface.colours().subarray(4 * v, 4 * v + 3);
  if (colouring === "plain") return () => plainColour;
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
  if (colouring === "alignment") return angleColour(result.angle(face));
  if (colouring === "colours") return meanColour(result, face);
  if (colouring === "labels") return labelColour(result.labels()[face]);
  if (colouring !== "distance") return plainColour;
  return scaleColour("distance", faceDistance(run, face) / end);
}

const angleColour = (degrees) => (degrees === undefined ? unjudgedColour : scaleColour("alignment", degrees / 45));

function meanColour({ colours, corners, offsets }, face) {
  const mean = [0, 0, 0];
  const count = offsets[face + 1] - offsets[face];
  for (let c = offsets[face]; c < offsets[face + 1]; ++c) {
    for (let k = 0; k < 3; ++k) mean[k] += colours()[4 * corners[c] + k] / count;
  }
  return mean;
}

/** A colour per label; those of runs are as easy to tell apart. */
export const labelColour = (label) => runColours[label % runColours.length].match(/\w\w/g).map((byte) => parseInt(byte, 16));

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
