// Layers of job.json (`traverse convert part.damat -o job.json`) to servers: node submit_job.mjs job.json HOST:PORT...
import { readFileSync } from "node:fs";
import { TravelOptimizer } from "traverse-client";
const { layers, options } = JSON.parse(readFileSync(process.argv[2], "utf8"));
const optimizer = new TravelOptimizer(process.argv.slice(3));
for await (const { id, given, travel } of optimizer.optimize(layers, { deadlineSeconds: 30, options })) {
  console.log(`layer ${id}: travel ${given.total_mm.toFixed(1)} mm -> ${travel.total_mm.toFixed(1)} mm`);
}
optimizer.close();
