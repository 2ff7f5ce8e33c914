// Copies the project's .proto files into the package, and checks that its version is the server's.
import { cpSync, readFileSync, rmSync } from "node:fs";

const root = new URL("../../", import.meta.url);
const { version } = JSON.parse(readFileSync(new URL("package.json", import.meta.url), "utf8"));
const [, server] = readFileSync(new URL("CMakeLists.txt", root), "utf8").match(/project\(traverse VERSION ([\d.]+)/);
if (version !== server) throw new Error(`package.json has version ${version}, the server ${server}`);

rmSync(new URL("proto", import.meta.url), { recursive: true, force: true });
for (const name of ["options", "plan", "route_optimizer_service", "gcode_service"]) {
  cpSync(new URL(`proto/traverse/v1/${name}.proto`, root), new URL(`proto/traverse/v1/${name}.proto`, import.meta.url));
}
