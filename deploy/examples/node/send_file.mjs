#!/usr/bin/env node
// Sends a sliced file to traverse-gateway, tells how far it has come, and writes what comes back.
//
//   node send_file.mjs part.gcode shorter.gcode http://127.0.0.1:8080 balanced
//
// Node 18 or later; no packages. The token, where the gateway asks for one, is in TRAVERSE_TOKEN.
import { readFile, writeFile } from "node:fs/promises";
import { basename } from "node:path";

const [input, output, gateway = "http://127.0.0.1:8080", policy = "safe"] = process.argv.slice(2);
const token = process.env.TRAVERSE_TOKEN;

// The events of a stream, one after another.
async function* events(stream) {
  let text = "";
  for await (const piece of stream.pipeThrough(new TextDecoderStream())) {
    text += piece;
    for (let end; (end = text.indexOf("\n\n")) >= 0; text = text.slice(end + 2)) {
      const [event, data] = text.slice(0, end).split("\n");
      yield { name: event.slice("event: ".length), data: data.slice("data: ".length) };
    }
  }
}

async function main() {
  const query = new URLSearchParams({ policy, name: basename(input) });
  const headers = { Accept: "text/event-stream", ...(token && { Authorization: `Bearer ${token}` }) };
  const answer = await fetch(`${gateway}/v1/gcode?${query}`, { method: "POST", body: await readFile(input), headers });
  if (!answer.ok) throw new Error((await answer.json()).detail);
  const pieces = [];
  for await (const { name, data } of events(answer.body)) {
    if (name === "progress") {
      const { stage, layers_done, layers } = JSON.parse(data);
      console.error(stage === "STAGE_SEARCHING" ? `${layers_done} of ${layers} layers` : stage);
    }
    if (name === "file") pieces.push(Buffer.from(data, "base64"));
    if (name === "problem") throw new Error(JSON.parse(data).detail);
    if (name === "summary") {
      await writeFile(output, Buffer.concat(pieces));
      console.log(JSON.parse(data).text);
      return;
    }
  }
  throw new Error("the gateway broke off before the file was whole");
}

main().catch((error) => {
  console.error(`${input}: ${error.message}`);
  process.exitCode = 1;
});
