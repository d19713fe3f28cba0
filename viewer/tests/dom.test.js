import assert from "node:assert/strict";
import { test } from "node:test";
import { coordinate, figure } from "../src/dom.js";

test("places of a model far from the origin can be told apart", () => {
  const size = 1.5;
  const step = 1e-4 * size;
  for (const far of [0, 0.3, 3000, -1234567.125]) {
    const texts = [0, 1, 2].map((i) => coordinate(far + i * step, size));
    assert.equal(new Set(texts).size, 3, texts.join("; "));
    texts.forEach((text, i) => assert.ok(Math.abs(Number(text.replace("\u2212", "-").replace("\u2009", "")) - (far + i * step)) < step, text));
  }
});

test("figures have as many digits as are wanted", () => {
  assert.equal(figure(1234567, 3), "1.23\u2009e6");
  assert.equal(figure(0.5678), "0.568");
  assert.equal(figure(-12.345), "\u221212.3");
  assert.equal(figure(0.00001234), "1.23\u2009e\u22125");
});
