// A sliced file through gateways: node send_file.mjs part.gcode shorter.gcode HOST:PORT...
import { writeFileSync } from "node:fs";
import { GcodeGateway } from "traverse-client";
const [, , part, shorter, ...addresses] = process.argv;
const gateway = new GcodeGateway(addresses);
const { data, summary } = await gateway.rewrite(part, { onProgress: (now) => process.stderr.write(`${now.stage}\r`) });
writeFileSync(shorter, data);
console.log(summary.text);
gateway.close();
