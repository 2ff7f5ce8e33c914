// Takes orders from a queue, files from a folder through a gateway into another folder. Start as many as you like.
//
//   node worker.mjs QUEUE_HOST:PORT INBOX OUTBOX GATEWAY_HOST:PORT...
//
// An order {"file": "a.gcode", "options": {"policy": "POLICY_BALANCED"}} makes OUTBOX/a.gcode of INBOX/a.gcode, or
// OUTBOX/a.gcode.error, which says why not. Names are the identity: one order for each.
import { access, rename, writeFile } from "node:fs/promises";
import { basename, join } from "node:path";
import { GcodeGateway, TraverseError } from "traverse-client";
import { openQueue } from "./queue.mjs";

const WORKING_MS = 5000; // must be well below the queue's ack_wait
const RETRY_MS = 2000;
const FINAL = ["INVALID_ARGUMENT", "FAILED_PRECONDITION", "OUT_OF_RANGE", "UNIMPLEMENTED"]; // the file is at fault

const [, , server, inbox, outbox, ...addresses] = process.argv;
const gateway = new GcodeGateway(addresses);
const { orders } = await openQueue(server);

const exists = (path) => access(path).then(() => true, () => false);

// Whole or not at all: who looks sees no half of a file, and who is killed leaves none.
async function put(name, content) {
  const path = join(outbox, name);
  await writeFile(`${path}.${process.pid}.part`, content);
  await rename(`${path}.${process.pid}.part`, path);
}

async function work(order) {
  const { file, options } = JSON.parse(order);
  const name = basename(file);
  // The queue asks again for what it was not told to be done: when it or a worker was killed, or an answer was lost.
  if (await exists(join(outbox, name)) || await exists(join(outbox, `${name}.error`))) return;
  try {
    // The same key twice at the same time is one job of the gateway.
    const { data } = await gateway.rewrite(join(inbox, name), { options, idempotencyKey: encodeURIComponent(name) });
    await put(name, data);
  } catch (error) {
    if (!(error instanceof TraverseError && FINAL.includes(error.code)) && error.code !== "ENOENT") throw error;
    await put(`${name}.error`, `${error.message}\n`);
  }
}

for await (const order of orders) {
  const heartbeat = setInterval(() => order.working(), WORKING_MS);
  try {
    await work(order.string());
    order.ack();
  } catch (error) {
    console.error(`${order.string()}: ${error.message}`);
    if (error instanceof SyntaxError || error instanceof TypeError) order.term("no order"); // never will be one
    else order.nak(RETRY_MS);
  } finally {
    clearInterval(heartbeat);
  }
}
