// Colours of surfaces, lines and runs, as [red, green, blue] in 0 to 255.

const hex = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16));

export const familyNames = ["minimum", "maximum", "boundary", "feature"];
export const familyColours = ["#2b6fe0", "#d9363e", "#0f9d76", "#8a4fd0"].map(hex);

export const endNames = [
  "closed",
  "too near to another line",
  "at the boundary",
  "at a feature line",
  "too many steps",
  "stuck",
  "at a node",
];
export const endColours = ["#7a828e", "#e0a100", "#0f9d76", "#8a4fd0", "#ff3b7f", "#ff3b7f", "#16a3b8"].map(hex);

export const sideColours = { 3: hex("#f0a03c"), 4: hex("#c9ced6"), 5: hex("#58b368"), more: hex("#c65bb5") };
export const plainColour = hex("#c9ced6");
export const unjudgedColour = hex("#8f97a3");
export const guideColour = hex("#ff7a00");
export const cutColour = hex("#4a3a1e");
export const runColours = ["#3b7ddd", "#e07a1f", "#2a9d63", "#b0479f", "#8d6e3f", "#5f6b7a", "#c43d4b", "#1f9bb0"];

const scales = {
  // Concave teal, flat grey, convex ochre: blue and red lines stand out on both.
  diverging: ["#0d6f69", "#45a89d", "#a5d3cb", "#d9dbde", "#ead29b", "#cfa145", "#8a5f10"].map(hex),
  // What can be relied upon looks like plain surface; the rest stands out.
  confidence: ["#c2187a", "#e0559b", "#eb9dc0", "#d8ccd6", "#c9ced6"].map(hex),
  // As confidence: what is as it should be looks plain.
  alignment: ["#d3d8df", "#f2c9a0", "#e58a4f", "#c23b3b", "#7a1038"].map(hex),
  distance: ["#e6ebf0", "#b6d9c9", "#6cbfae", "#2d8fa6", "#30578f", "#3b2566"].map(hex),
};

/** Colour of a share in 0 to 1 on a scale. */
export function scaleColour(name, share) {
  const stops = scales[name];
  const place = Math.min(Math.max(share, 0), 1) * (stops.length - 1);
  const i = Math.min(Math.floor(place), stops.length - 2);
  return stops[i].map((low, k) => low + (place - i) * (stops[i + 1][k] - low));
}

export const cssColour = ([r, g, b]) => `rgb(${Math.round(r)} ${Math.round(g)} ${Math.round(b)})`;

export const scaleGradient = (name) => `linear-gradient(to right, ${scales[name].map(cssColour).join(", ")})`;
