// Checks the YAML documents of standard input against the schemas of their kinds. Exit code 1 and one
// line a fault if any does not fit.
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
    return [];
  } catch (error) {
    return String(error.stdout).trim().split("\n").map((line) => {
      const index = Number(/(\d+)\.ts/.exec(line)?.[1]);
      return `${documents[index]?.kind ?? ""}: ${line}`;
    });
  } finally {
    rmSync(folder, { recursive: true });
  }
}

const documents = loadAll(readFileSync(0, "utf8")).filter(Boolean);
const faults = [
  ...documents.flatMap((document) => schemaFaults(document).map((fault) => `${document.kind}: ${fault}`)),
  ...typeFaults(documents),
];
for (const fault of faults) console.log(fault);
console.log(`${documents.length} documents, ${faults.length} faults`);
process.exit(faults.length > 0 || documents.length === 0 ? 1 : 0);
