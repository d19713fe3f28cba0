import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";

test("the style takes no more than browsers of 2023 have", () => {
  const style = readFileSync(new URL("../src/style.css", import.meta.url), "utf8").replace(/\/\*.*?\*\//gs, "");
  for (const late of ["light-dark(", "@starting-style", "@scope", "field-sizing", "anchor("]) {
    assert.ok(!style.includes(late), late);
  }
});
