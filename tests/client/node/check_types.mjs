// Compiles types.ts with what it imports, and looks for faults in it and in the client's own types: those of other
// packages, of which there is far more, are theirs.
import ts from "typescript";

const program = ts.createProgram(["types.ts"], {
  noEmit: true, strict: true, module: ts.ModuleKind.NodeNext, target: ts.ScriptTarget.ES2022, lib: ["lib.es2022.d.ts"] });
const ours = program.getSourceFiles().filter(({ fileName }) => /types\.ts$|\/traverse-client\//.test(fileName));
const faults = [program.getOptionsDiagnostics(), program.getGlobalDiagnostics(), program.getSyntacticDiagnostics(),
  ...ours.map((file) => program.getSemanticDiagnostics(file))].flat();
console.log(ts.formatDiagnostics(faults, { getCurrentDirectory: () => ".", getCanonicalFileName: (name) => name, getNewLine: () => "\n" }));
process.exit(ours.length === 2 && faults.length === 0 ? 0 : 1);
