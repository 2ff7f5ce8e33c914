// Puts the page together in one file: npm ci && npm run build
//
// The result is committed, so that the C++ build needs no Node; a test builds it again and compares. esbuild
// is pinned by the lock file and its output depends on nothing else.
import { build } from "esbuild";
import { mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const target = process.argv[2] ?? join(here, "bundle", "page.html");

const common = { bundle: true, minify: true, write: false, absWorkingDir: here, legalComments: "none" };
const script = await build({ ...common, entryPoints: ["src/main.js"], format: "iife", target: "es2022" });
const style = await build({ ...common, entryPoints: ["src/page.css"] });

// What ends a script or style element must not be inside it.
function inside(element, text) {
  if (text.toLowerCase().includes(`</${element}`)) throw new Error(`the ${element} would end itself`);
  return text.trimEnd();
}

const page = readFileSync(join(here, "src/page.html"), "utf8")
  .replace("@STYLE@", () => inside("style", style.outputFiles[0].text))
  .replace("@SCRIPT@", () => inside("script", script.outputFiles[0].text));
mkdirSync(dirname(target), { recursive: true });
writeFileSync(target, page);
