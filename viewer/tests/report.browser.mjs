// Opens real reports in a real browser, from their files: report.browser.mjs BIN SHOTS
// BIN has the programs, SHOTS takes screenshots. Exit code 77, with CI set 1: the browser or the viewer is not there.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, statSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const [bin, shots] = process.argv.slice(2).map((path) => resolve(path));
const executablePath = ["/usr/bin/chromium", "/usr/bin/chromium-browser", "/usr/bin/google-chrome"].find(existsSync);

function skip(reason) {
  console.log(`browser: cannot run: ${reason}; scripts/setup --browser and scripts/build_viewer make it ready`);
  process.exit(process.env.CI ? 1 : 77);
}

if (!executablePath) skip("there is no chromium");
const { chromium } = await import("playwright-core").catch(() => skip("there is no playwright-core"));
if (!existsSync(new URL("../dist/viewer.html", import.meta.url))) skip("the viewer is not built");

const folder = mkdtempSync(join(tmpdir(), "strake-browser-"));
const strake = (...words) => execFileSync(join(bin, "strake"), words, { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
const models = process.env.STRAKE_MODELS || fileURLToPath(new URL("../../../shared/models", import.meta.url));

/** Runs to show: always two of our own making, and a real model where it is. */
function makeReports() {
  const reports = [];
  strake("sample", "part", "-o", "part.ply", "--faces", "9000");
  for (const tolerance of ["0.1%", "0.3%"]) {
    strake("remesh", "part.ply", "-q", "-o", `part-${tolerance}.obj`, "--keep", `<b>part ${tolerance}`, "--tolerance", tolerance);
  }
  strake("report", "<b>part 0.1%", "<b>part 0.3%", "-o", "part.html");
  reports.push({ name: "part", result: "part-0.1%.obj", runs: ["<b>part 0.1%", "<b>part 0.3%"], isClosed: true });
  writeFileSync(join(folder, "sheet.obj"), colouredSheet(40));
  writeFileSync(join(folder, "guides.obj"), guideOnSheet());
  strake("remesh", "sheet.obj", "-q", "-o", "sheet-quads.obj", "--keep", "sheet", "--vertices", "300", "--guides", "guides.obj");
  strake("report", "sheet", "-o", "sheet.html");
  reports.push({ name: "sheet", result: "sheet-quads.obj", runs: ["sheet"], hasAttributes: true });
  const file = join(models, "scan/igea.ply");
  if (existsSync(file)) {
    strake("remesh", file, "-q", "-o", "igea.obj", "--keep", "igea");
    strake("report", "igea", "-o", "igea.html");
    reports.push({ name: "igea", result: "igea.obj", runs: ["igea"], isClosed: true, isLarge: true });
  } else {
    assert.ok(!process.env.CI, `there is no ${file}; set STRAKE_MODELS to the folder of the test models`);
    console.log(`browser: there is no ${file}; left out`);
  }
  return reports;
}

/** A wavy sheet of n x n squares as OBJ, red to the right, green to the back, of two materials. */
function colouredSheet(n) {
  const lines = [];
  for (let i = 0; i <= n * (n + 2); ++i) {
    const [x, y] = [(i % (n + 1)) / n, Math.floor(i / (n + 1)) / n];
    lines.push(`v ${x} ${y} ${sheetHeight(x)} ${x} ${y} 0.5`);
  }
  for (const half of [0, 1]) {
    lines.push(`usemtl ${half ? "right" : "left"}`);
    for (let i = 0; i < n * n; ++i) {
      const v = (i % n) + (n + 1) * Math.floor(i / n) + 1;
      if ((i % n < n / 2) === !half) lines.push(`f ${v} ${v + 1} ${v + n + 2} ${v + n + 1}`);
    }
  }
  return `${lines.join("\n")}\n`;
}

const sheetHeight = (x) => 0.1 * Math.sin(6 * x);

function guideOnSheet() {
  const points = Array.from({ length: 30 }, (_, i) => [0.1 + 0.025 * i, 0.2 + 0.01 * i]);
  return `${points.map(([x, y]) => `v ${x} ${y} ${sheetHeight(x)}`).join("\n")}\nl ${points.map((_, i) => i + 1).join(" ")}\n`;
}

// Without a graphics processor the time goes into pixels: few where nobody looks at them.
const small = { width: 800, height: 480 };
const desktop = { width: 1200, height: 760 };

/** A page on a report that fails on any error, and on any request but for the report itself. */
async function open(browser, report, hash, options = {}) {
  const context = await browser.newContext({ viewport: small, ...options });
  const page = await context.newPage();
  page.on("console", (message) => assert.ok(!["error", "warning"].includes(message.type()) || /swiftshader|GPU stall/i.test(message.text()), message.text()));
  page.on("pageerror", (error) => assert.fail(error.stack));
  page.on("request", (request) => assert.match(request.url(), /^(file|data|blob):/));
  await page.goto(`file://${encodeURI(join(folder, `${report.name}.html`)).replaceAll("#", "%23")}${hash}`);
  await page.waitForFunction(() => document.documentElement.dataset.ready, null, { timeout: 60000 });
  report.ready = Math.min(report.ready ?? Infinity, await page.evaluate(() => Number(document.documentElement.dataset.ready)));
  return page;
}

/** Goes to another view of the report that is open. */
async function show(page, hash) {
  await page.evaluate((text) => (location.hash = text), hash);
  await page.waitForFunction(() => location.hash === window.strakeReport.link);
}

/** The drawing as a text that is equal for equal pixels. */
async function drawing(page) {
  const picture = await page.evaluate(() => {
    window.strakeReport.stage.drawNow();
    return window.strakeReport.stage.canvas.toDataURL();
  });
  return createHash("sha256").update(picture).digest("hex");
}

/** How many pixels of the drawing have a colour. */
const pixelsOf = (page, colour) => page.evaluate(([r, g, b]) => {
  const { stage } = window.strakeReport;
  stage.drawNow();
  const canvas = Object.assign(document.createElement("canvas"), { width: stage.canvas.width, height: stage.canvas.height });
  const context = canvas.getContext("2d");
  context.drawImage(stage.canvas, 0, 0);
  const { data } = context.getImageData(0, 0, canvas.width, canvas.height);
  let count = 0;
  for (let i = 0; i < data.length; i += 4) count += Math.abs(data[i] - r) + Math.abs(data[i + 1] - g) + Math.abs(data[i + 2] - b) < 6;
  return count;
}, colour);

const cutFilling = [217, 199, 166];

/** Cuts of closed surfaces are filled, of the input and of the result as much; those of open ones are lines. */
async function checkSection(browser, report) {
  const filled = [];
  const page = await open(browser, report, "");
  for (const pane of ["0,input,plain,sides,", "0,result,plain,plain,"]) {
    await show(page, `#a=${pane}&section=y,0.5`);
    filled.push(await pixelsOf(page, cutFilling));
    await page.locator("button[data-key='Section none']").click();
    assert.equal(await pixelsOf(page, cutFilling), 0);
  }
  await page.context().close();
  if (!report.isClosed) return assert.deepEqual(filled, [0, 0]);
  assert.ok(filled[0] > 500 && Math.abs(filled[0] / filled[1] - 1) < 0.1, `cuts of ${filled} pixels`);
}

/** Where the camera is. */
const camera = (page) => page.evaluate(() => window.strakeReport.stage.camera.position.toArray());

/** Two panes show all of the model, too, and one does again. */
async function checkFit(page) {
  const distances = [];
  for (const key of ["", "s", "s"]) {
    if (key) await page.keyboard.press(key);
    distances.push(Math.hypot(...(await camera(page))));
  }
  assert.ok(distances[1] > 1.02 * distances[0] && distances[2] === distances[0], `distances ${distances}`);
}

/** The panel stays as it is while it is used: sliders follow the pointer, what has focus keeps it, lists stay scrolled. */
async function checkPanel(browser, report) {
  const page = await open(browser, report, "#section=x,0.5", { viewport: { width: 800, height: 900 } });
  const place = () => page.evaluate(() => window.strakeReport.view.section.place);
  const slider = await page.locator("input[type=range]").boundingBox();
  await page.mouse.move(slider.x + slider.width / 2, slider.y + slider.height / 2);
  await page.mouse.down();
  for (const share of [0.6, 0.7, 0.8]) await page.mouse.move(slider.x + share * slider.width, slider.y + slider.height / 2);
  await page.mouse.up();
  assert.ok((await place()) > 0.7, `the slider was left at ${await place()}`);
  await page.locator("input[type=range]").focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  assert.equal(await place(), 0.005, "the slider lost the keys");
  // The keys are for the view that is there.
  await page.keyboard.press("Tab");
  await page.keyboard.press("s");
  await page.getByRole("button", { name: "Right view" }).click();
  await page.keyboard.press("s");
  await page.keyboard.press("1");
  assert.equal(await page.evaluate(() => window.strakeReport.view.panes[0].base), "input", "a key set the view that is not there");
  await page.setViewportSize({ width: 800, height: 300 });
  const toggle = page.locator("input[data-key='layer triangles']");
  await toggle.focus();
  const scrolled = () => page.evaluate(() => document.querySelector(".controls").scrollTop);
  const before = await scrolled();
  await page.keyboard.press(" ");
  assert.ok(before > 0 && (await scrolled()) === before, `the panel went from ${before} to ${await scrolled()}`);
  assert.ok(await toggle.evaluate((box) => box === document.activeElement), "a toggle lost focus");
  await page.context().close();
}

async function checkLayers(page, report) {
  const first = await drawing(page);
  const guides = report.hasAttributes ? ["Guide lines"] : [];
  for (const label of [...guides, "Edges of the result", "Edges of the input", "Minimum curvature", "Maximum curvature", "Where they began", "Principal directions", "Cross field"]) {
    const box = page.locator("label.toggle", { hasText: label }).locator("input");
    await box.click();
    assert.notEqual(await drawing(page), first, `${label} changes nothing`);
    await page.locator("label.toggle", { hasText: label }).locator("input").click();
    assert.equal(await drawing(page), first, `${label} does not go away`);
  }
  const seen = new Set([first]);
  const addView = async (what) => {
    const pixels = await drawing(page);
    assert.ok(!seen.has(pixels), `${what} looks like another view`);
    seen.add(pixels);
  };
  // The sheet is all quads, and its curvature is clear: those colours are the plain one.
  for (const colour of ["distance", "alignment", ...(report.hasAttributes ? ["colours", "labels"] : ["plain"])]) {
    await page.locator("select[aria-label=Colour]").selectOption(colour);
    await addView(colour);
  }
  await page.getByRole("button", { name: "Input", exact: true }).click();
  for (const colour of ["k_min", "k_max", "confidence", report.hasAttributes ? "colours" : "plain"]) {
    await page.locator("select[aria-label=Colour]").selectOption(colour);
    await addView(colour);
  }
  for (const key of ["x", "x", "s", "w"]) {
    await page.keyboard.press(key);
    await addView(`key ${key}`);
  }
}

/** Numbers of vertex 0 are those of the file; a click in the middle answers. */
async function checkPicking(browser, report) {
  const page = await open(browser, report, "#pick=0,vertex,0", { viewport: desktop });
  const vertices = [...readFileSync(join(folder, report.result), "utf8").matchAll(/^v (\S+) (\S+) (\S+)/gm)].map(([, ...xyz]) => xyz);
  const wanted = vertices[0];
  const text = await page.locator(".numbers dd").first().textContent();
  const size = vertices.flat().reduce((most, x) => Math.max(most, Math.abs(x)), 0);
  // Written with 5 digits; the grid's steps are 1/65535 of the longest side.
  text.replaceAll("\u2212", "-").replaceAll("\u2009", "").split(", ").map(Number).forEach((x, k) => assert.ok(Math.abs(x - wanted[k]) < 1e-3 * size, `${text} for ${wanted}`));
  const titles = new Set();
  const box = await page.locator("canvas").boundingBox();
  for (let i = 0; i < 60; ++i) {
    await page.mouse.click(box.x + box.width * (0.3 + 0.4 * ((i * 0.618) % 1)), box.y + box.height * (0.3 + (0.4 * i) / 60));
    if (await page.locator(".numbers").isVisible()) titles.add((await page.locator(".numbers strong").textContent()).split(" ")[0]);
    if (i === 20) await page.keyboard.press("l");
  }
  assert.deepEqual([...titles].sort(), ["Face", "Line", "Vertex"]);
  await page.keyboard.press("Escape");
  assert.ok(!(await page.locator(".numbers").isVisible()));
  await page.context().close();
}

async function checkFigures(page, report) {
  await page.getByRole("tab", { name: "Figures" }).click();
  const evaluated = JSON.parse(readFileSync(join(folder, report.runs[0], "evaluate.json"), "utf8")).result;
  const row = page.locator("tr", { has: page.locator("th", { hasText: /^vertices$/ }) });
  const digits = (await row.locator("td").first().textContent()).replace(/\D/g, "");
  assert.equal(Number(digits), evaluated.topology.candidate.vertices);
  assert.equal(await page.locator("figure svg").count(), 5);
  await page.getByRole("tab", { name: "Origin" }).click();
  assert.match(await page.locator(".page").textContent(), /--feature-angle/);
  assert.match(await page.locator(".page").textContent(), /all stages/);
}

/** A link shows what the page it was taken from shows; numbers in it are rounded. */
async function checkLink(browser, report) {
  const link = async (page) => {
    await page.waitForFunction(() => location.hash === window.strakeReport.link);
    return page.evaluate(() => location.hash);
  };
  const page = await open(browser, report, "#a=0,input,k_max,sides,minimum+ends&section=y,0.4");
  const before = await camera(page);
  await page.keyboard.press("ArrowLeft");
  const turned = await camera(page);
  assert.ok(Math.hypot(...turned.map((x, k) => x - before[k])) > 0.05, "the arrow did not turn");
  const copy = await open(browser, report, await link(page));
  (await camera(copy)).forEach((x, k) => assert.ok(Math.abs(x - turned[k]) < 1e-3));
  const copied = await open(browser, report, await link(copy));
  assert.equal(await drawing(copied), await drawing(copy));
  // One that comes in just before the last change is noted is not lost: both timers are due at the end.
  await copied.evaluate(() => {
    document.querySelector("button[data-key='Section none']").click();
    setTimeout(() => (location.hash = "#section=z,0.3"));
    for (const start = performance.now(); performance.now() < start + 200; );
  });
  await copied.waitForTimeout(500);
  assert.match(await link(copied), /section=z,0\.3/);
  for (const opened of [page, copy, copied]) await opened.context().close();
}

/** Without WebGL figures and origin are there, and the stage says what it takes. */
async function checkWithoutGraphics(report) {
  const plain = await chromium.launch({ executablePath, args: ["--no-sandbox", "--headless=new", "--disable-3d-apis"] });
  try {
    const page = await open(plain, report, "#compare=side,0.5&pick=0,face,0");
    assert.match(await page.locator(".stage").textContent(), /no WebGL 2/);
    await page.locator(".stage .waiting").click();
    for (const key of ["ArrowLeft", "r", "t", "x", "c"]) await page.keyboard.press(key);
    await checkFigures(page, report);
  } finally {
    await plain.close();
  }
}

async function checkLooks(browser, report) {
  const compared = "#compare=side,0.5&a=0,input,k_max,sides,minimum+maximum+ends&b=0,result,plain,distance,edges";
  const wiped = "#compare=wipe,0.5&a=0,input,k_max,sides,&b=0,result,plain,alignment,edges&section=y,0.5";
  const first = report.hasAttributes ? "#a=0,result,sides,colours,edges" : "#";
  const phone = { viewport: { width: 390, height: 844 }, isMobile: true };
  const looks = [
    [{ viewport: desktop }, [["light", first], ["section", wiped], ["figures", "#tab=figures"]]],
    [{ viewport: desktop, colorScheme: "dark" }, [["dark", compared]]],
    [{ ...phone, deviceScaleFactor: 2, hasTouch: true }, [["phone", first]]],
    [{ ...phone, colorScheme: "dark" }, [["phone-figures", "#tab=figures"]]],
  ];
  for (const [options, views] of looks) {
    const page = await open(browser, report, "", options);
    for (const [name, hash] of views) {
      await show(page, hash);
      const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
      assert.ok(wide <= 0, `${name}: the page is ${wide} pixels too wide`);
      assert.deepEqual(await page.locator("h1, th, option").locator("b").count(), 0, "a name became markup");
      await page.waitForFunction(() => window.strakeReport.stage.isFine || window.strakeReport.view.tab !== "surface");
      await page.waitForTimeout(300);
      await page.screenshot({ path: join(shots, `${report.name}-${name}.png`) });
    }
    await page.context().close();
  }
}

mkdirSync(shots, { recursive: true });
let browser;
try {
  const reports = makeReports();
  browser = await chromium.launch({
    executablePath,
    args: ["--no-sandbox", "--headless=new", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  for (const report of reports) {
    const page = await open(browser, report, "");
    await checkFit(page);
    await checkLayers(page, report);
    await checkFigures(page, report);
    await page.context().close();
    await checkPanel(browser, report);
    await checkPicking(browser, report);
    await checkLink(browser, report);
    await checkSection(browser, report);
    await checkWithoutGraphics(report);
    if (!process.env.CI || !report.isLarge) await checkLooks(browser, report); // it takes a third of the time there
    const megabytes = statSync(join(folder, `${report.name}.html`)).size / 1e6;
    console.log(`browser: ${report.name}: ${megabytes.toFixed(1)} MB, ready after ${report.ready} ms`);
    assert.ok(report.ready < 3000, "that is too slow");
  }
  console.log("browser: everything passed");
} finally {
  await browser?.close();
  rmSync(folder, { recursive: true });
}
