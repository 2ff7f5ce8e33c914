#!/usr/bin/env node
// Sends a job to Traverse and shows its progress.
//
//   npm ci
//   traverse convert part.damat -o job.pb          (or .gcode)
//   node submit_job.mjs job.pb --server=10.0.0.1:50051,10.0.0.2:50051 --deadline=30 --routes=routes.jsonl
//
// Exit codes: 0 done; 1 the job is at fault; 2 usage; 3 no server did it in time, or none lets us in.
import { closeSync, openSync, readFileSync, writeSync } from "node:fs";
import { parseArgs } from "node:util";
import grpc from "@grpc/grpc-js";
import { decodeJob, JobFailed, RETRIED, TraverseClient } from "./traverse_client.mjs";

const USAGE = `usage: submit_job.mjs JOB.pb [--server=HOST:PORT,...] [--deadline=SECONDS] [--strategy=NAME] [--routes=FILE]
  [--ca=FILE: use TLS; servers are of this authority] [--server_name=NAME in their certificate, if not the address]
  [--certificate=FILE --key=FILE: shown to servers that want it] [--token_file=FILE: the bearer token alone]`;
const OURS = [...RETRIED, grpc.status.DEADLINE_EXCEEDED, grpc.status.UNAUTHENTICATED, grpc.status.PERMISSION_DENIED];

function readArguments() {
  try {
    const { values, positionals } = parseArgs({
      allowPositionals: true,
      options: {
        server: { type: "string", default: "127.0.0.1:50051" },
        deadline: { type: "string", default: "30" },
        strategy: { type: "string" },
        ca: { type: "string" },
        server_name: { type: "string" },
        certificate: { type: "string" },
        key: { type: "string" },
        token_file: { type: "string" },
        routes: { type: "string" },
      },
    });
    const deadline = Number(values.deadline);
    if (positionals.length !== 1 || !(deadline > 0)) throw new Error("one job, and a deadline in seconds");
    if (!values.certificate !== !values.key) throw new Error("--certificate and --key go together");
    if (!values.ca && (values.certificate || values.token_file)) throw new Error("certificates and tokens need TLS: give --ca");
    if (values.ca && values.server.includes(",") && !values.server_name) throw new Error("several addresses have one certificate: give --server_name");
    return { ...values, deadline, file: positionals[0] };
  } catch (error) {
    console.error(`${error.message}\n${USAGE}`);
    process.exit(2);
  }
}

// What the flags say; undefined for plaintext.
function credentialsOf({ ca, key, certificate, token_file: tokenFile }) {
  if (!ca) return undefined;
  const read = (path) => (path ? readFileSync(path) : null);
  const encrypted = grpc.credentials.createSsl(read(ca), read(key), read(certificate));
  if (!tokenFile) return encrypted;
  const metadata = new grpc.Metadata();
  metadata.set("authorization", `Bearer ${readFileSync(tokenFile, "utf8").trim()}`);
  const token = grpc.credentials.createFromMetadataGenerator((_, callback) => callback(null, metadata));
  return grpc.credentials.combineChannelCredentials(encrypted, token);
}

function showProgress(done, layers, given, travel) {
  if (!process.stdout.isTTY) return;
  const saved = given > 0 ? 100 * (1 - travel / given) : 0;
  process.stdout.write(`\r${done}/${layers} layers, ${saved.toFixed(1)} % of the travel saved ${done === layers ? "\n" : ""}`);
}

async function main() {
  const options = readArguments();
  let job;
  try {
    job = decodeJob(readFileSync(options.file));
  } catch (error) {
    console.error(`${options.file}: ${error.message}`);
    return 1;
  }
  if (options.strategy) job.options = { ...job.options, strategy: { name: options.strategy } };
  let client;
  try {
    client = new TraverseClient(options.server.split(","), credentialsOf(options), options.server_name);
  } catch (error) {
    console.error(`submit_job.mjs: ${error.message}`);
    return 2;
  }
  const routes = options.routes ? openSync(options.routes, "w") : null;
  let given = 0;
  let travel = 0;
  try {
    for await (const result of client.optimize(job, options.deadline)) {
      given += (result.given?.total_mm ?? 0) + result.cleaning_given_mm;
      travel += (result.travel?.total_mm ?? 0) + result.cleaning_mm;
      showProgress(result.index + 1, job.layers.length, given, travel);
      if (routes !== null) writeSync(routes, JSON.stringify(result) + "\n");
    }
  } catch (error) {
    if (!(error instanceof JobFailed)) throw error;
    console.error(`${options.file}: ${error.message}`);
    return OURS.includes(error.code) ? 3 : 1;
  } finally {
    client.close();
    if (routes !== null) closeSync(routes);
  }
  console.log(`${job.layers.length} layers, travel ${given.toFixed(1)} mm -> ${travel.toFixed(1)} mm`);
  return 0;
}

process.exitCode = await main();
