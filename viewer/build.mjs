// Bundles the viewer into one page without any reference to other files: dist/viewer.html.
// `strake report` puts its data in place of the two marks %STRAKE_...% of page.html.
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { deflateSync } from "node:zlib";
import { build } from "esbuild";

async function script(entry) {
  const bundle = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    format: "iife",
    target: "es2022",
    charset: "ascii",
    legalComments: "none",
    write: false,
  });
  return bundle.outputFiles[0].text;
}

const style = await build({ entryPoints: ["src/style.css"], minify: true, write: false });
const licence = async (name) => (await readFile(`node_modules/${name}`, "utf8")).trim();
const licences = `three.js\n${await licence("three/LICENSE")}\n\nmeshoptimizer\n${await licence("meshoptimizer/LICENSE.md")}`;

const parts = {
  STYLE: style.outputFiles[0].text,
  CODE: deflateSync(await script("src/main.js"), { level: 9 }).toString("base64"),
  LOADER: await script("src/load.js"),
  LICENCES: licences,
};
let page = await readFile("src/page.html", "utf8");
for (const [name, text] of Object.entries(parts)) page = page.replace(`%${name}%`, () => text);
await mkdir("dist", { recursive: true });
await writeFile("dist/viewer.html", page);
console.log(`dist/viewer.html: ${Math.round(page.length / 1024)} KB`);
