import assert from "node:assert/strict";
import { test } from "node:test";
import { firstView, fromHash, layerNames, toHash } from "../src/state.js";

test("a view comes back from its address", () => {
  const view = firstView(3);
  view.tab = "figures";
  view.compare = "wipe";
  view.split = 0.25;
  view.panes[0] = { run: 2, base: "input", colour: { input: "colours", result: "alignment" }, layers: new Set(layerNames) };
  view.panes[1].layers = new Set();
  view.camera = [1, -0.5, 2, 0.125, 0, 0];
  view.section = { axis: "y", place: 0.375, flipped: true };
  view.pick = { run: 1, kind: "line", index: 12 };
  assert.deepEqual(fromHash(toHash(view), firstView(3), 3), view);
});

test("what an address cannot say is left out", () => {
  const nonsense = [
    "", "#", "#tab=secret", "#a=7,moon,red,blue,edgesX", "#camera=1,2", "#camera=a,b,c,d,e,f",
    "#section=w,0.5", "#pick=9,face,1", "#pick=-1,face,1", "#pick=0.5,face,1", "#pick=0,moon,1", "#pick=0,face,x", "#compare=side,7", "#=&&==",
  ];
  for (const hash of nonsense) {
    const view = fromHash(hash, firstView(1), 1);
    assert.equal(view.tab, "surface");
    assert.equal(view.camera, null);
    assert.equal(view.pick, null);
    assert.equal(view.section.axis, "none");
    assert.equal(view.split, 0.5);
    assert.equal(view.panes[0].run, 0);
    assert.equal(view.panes[0].base, "result");
  }
});
