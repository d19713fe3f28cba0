import assert from "node:assert/strict";
import { test } from "node:test";
import { figuresPage } from "../src/figures.js";

/** As much of a document as pages are made of. */
class Node {
  constructor(tag) {
    Object.assign(this, { tag, children: [] });
  }
  setAttribute() {}
  addEventListener() {}
  append(...children) {
    this.children.push(...children);
  }
  count(tag) {
    return (this.tag === tag) + this.children.reduce((sum, child) => sum + (child.count?.(tag) ?? 0), 0);
  }
}
globalThis.document = { createElement: (tag) => new Node(tag), createElementNS: (_, tag) => new Node(tag) };

const run = (alignment) => ({
  about: { name: "run", stages: [], histograms: { angles: { bounds: [0, 45, 90], shares: [0.25, 0.75] }, alignment: { bounds: [0, 45], shares: alignment } } },
});

test("histograms without a value are left out", () => {
  assert.equal(figuresPage([run([1])]).count("figure"), 2);
  assert.equal(figuresPage([run([0])]).count("figure"), 1); // of a flat surface
  assert.equal(figuresPage([run([0]), run([1])]).count("figure"), 2);
});
