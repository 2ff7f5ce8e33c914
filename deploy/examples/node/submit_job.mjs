#!/usr/bin/env node
// Sends a job to Traverse and shows its progress.
//
//   npm ci
//   traverse convert part.damat -o job.pb          (or .gcode)
//   node submit_job.mjs job.pb --server=10.0.0.1:50051,10.0.0.2:50051 --deadline=30 --routes=routes.jsonl
//
// Exit codes: 0 done; 1 the job is at fault; 2 usage; 3 no server did it in time.
import { closeSync, openSync, readFileSync, writeSync } from "node:fs";
import { parseArgs } from "node:util";
import grpc from "@grpc/grpc-js";
import { decodeJob, JobFailed, RETRIED, TraverseClient } from "./traverse_client.mjs";

const USAGE = "usage: submit_job.mjs JOB.pb [--server=HOST:PORT,...] [--deadline=SECONDS] [--strategy=NAME] [--ca=FILE] [--routes=FILE]";
const OURS = [...RETRIED, grpc.status.DEADLINE_EXCEEDED];

function readArguments() {
  try {
    const { values, positionals } = parseArgs({
      allowPositionals: true,
      options: {
        server: { type: "string", default: "127.0.0.1:50051" },
        deadline: { type: "string", default: "30" },
        strategy: { type: "string" },
        ca: { type: "string" },
        routes: { type: "string" },
      },
    });
    const deadline = Number(values.deadline);
    if (positionals.length !== 1 || !(deadline > 0)) throw new Error("one job, and a deadline in seconds");
    return { ...values, deadline, file: positionals[0] };
  } catch (error) {
    console.error(`${error.message}\n${USAGE}`);
    process.exit(2);
  }
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
  const credentials = options.ca ? grpc.credentials.createSsl(readFileSync(options.ca)) : undefined;
  const client = new TraverseClient(options.server.split(","), credentials);
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
