import assert from "node:assert/strict";
import { test } from "node:test";
import { colouringsOf, shownColouring } from "../src/tints.js";

test("what is drawn is what the list of colourings names", () => {
  const run = { surface: { about: {} }, about: { result: { labels: {} }, histograms: {} } };
  for (const wanted of ["sides", "distance", "alignment", "colours", "labels", "plain"]) {
    const names = colouringsOf(run, "result").map(([name]) => name);
    assert.equal(shownColouring(run, "result", wanted), names.includes(wanted) ? wanted : "sides");
  }
  assert.equal(shownColouring(run, "input", "k_max"), "plain");
});
