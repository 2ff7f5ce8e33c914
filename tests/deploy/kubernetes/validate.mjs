// validate.mjs FILE...: checks the YAML documents of the files against the schemas of their kinds. One
// line a fault and one a file, "FILE: 3 documents, 0 faults". Exit code 1 if any document does not fit.
//
// Two checks, for each sees what the other misses: the JSON schema (values, required fields) and the
// TypeScript types under --strict (unknown fields).
import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { loadAll } from "js-yaml";

const require = createRequire(import.meta.url);

// Packages by the group of the objects that they describe; Kubernetes' own groups are in one.
const PACKAGES = { "monitoring.coreos.com": "@kubernetes-models/prometheus-operator", "cert-manager.io": "@kubernetes-models/cert-manager" };

function moduleOf(document) {
  const [group] = document.apiVersion.split("/");
  return `${PACKAGES[group] ?? "kubernetes-models"}/${document.apiVersion}/${document.kind}`;
}

function schemaFaults(document) {
  try {
    new (require(moduleOf(document))[document.kind])(document).validate();
    return [];
  } catch (error) {
    return [error.message];
  }
}

// The faults of each document that has any, by its index.
function typeFaults(documents) {
  const folder = mkdtempSync(join(import.meta.dirname ?? process.cwd(), "types-"));
  try {
    const files = documents.map((document, index) => {
      const file = join(folder, `${index}.ts`);
      writeFileSync(file, `import type { I${document.kind} as Kind } from "${moduleOf(document)}";\n`
        + `export const value: Kind = ${JSON.stringify(document, null, 1)};\n`);
      return file;
    });
    execFileSync(process.execPath, [require.resolve("typescript/bin/tsc"), "--noEmit", "--strict", "--skipLibCheck",
      "--module", "nodenext", "--moduleResolution", "nodenext", "--target", "es2022", ...files], { cwd: folder });
    return new Map();
  } catch (error) {
    const faults = new Map();
    for (const line of String(error.stdout).trim().split("\n")) {
      const index = Number(/(\d+)\.ts/.exec(line)?.[1] ?? NaN);
      // A line that names no document of ours, as of a compiler that does not start, is everybody's fault.
      for (const own of documents[index] ? [index] : documents.keys()) faults.set(own, [...(faults.get(own) ?? []), line]);
    }
    return faults;
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const documents = process.argv.slice(2).flatMap((file) =>
  loadAll(readFileSync(file, "utf8")).filter(Boolean).map((document) => ({ file, document })));
// The compiler runs once for all files: reading the types takes most of its time.
const typed = typeFaults(documents.map(({ document }) => document));
const faults = documents.map(({ document }, index) => [...schemaFaults(document), ...(typed.get(index) ?? [])]);
let fits = true;
for (const file of process.argv.slice(2)) {
  const own = [...documents.keys()].filter((index) => documents[index].file === file);
  const count = own.reduce((sum, index) => sum + faults[index].length, 0);
  for (const index of own) for (const fault of faults[index]) console.log(`${documents[index].document.kind}: ${fault}`);
  console.log(`${file}: ${own.length} documents, ${count} faults`);
  fits &&= own.length > 0 && count === 0;
}
process.exit(fits && documents.length > 0 ? 0 : 1);
