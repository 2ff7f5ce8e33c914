// A file as a job of a gateway, whatever call is under way.
import { randomUUID } from "node:crypto";
import grpc from "@grpc/grpc-js";
import { TraverseError } from "./errors.js";
import { RETRIED, delayMs } from "./retries.js";

const PIECE_BYTES = 1 << 20;
// The gateway has no such job any more, or another gateway answers now.
const LOST = [grpc.status.ABORTED, grpc.status.FAILED_PRECONDITION, grpc.status.NOT_FOUND];
// With other gateways to ask, a job is given up after so many calls to its own one that were lost.
const TRIES_OF_ONE = 4;

export class FileJob {
  gateway = 0; // the number of the one to ask
  #options;
  #file;
  #deadline;
  #onProgress;
  #gateways;
  #attempt = 0;
  #job;
  #data = [];
  #report = [];
  #reportRead;
  #deleted = false;

  constructor(file, options, key, onProgress, deadline, gateways) {
    this.#file = file;
    this.#options = { rewrite: options, idempotency_key: key ?? randomUUID() };
    this.#onProgress = onProgress;
    this.#deadline = deadline;
    this.#gateways = gateways;
    this.#beginAnew();
  }

  #beginAnew() {
    this.#job = undefined;
    this.#data = [];
    this.#report = [];
    this.#reportRead = !this.#options.rewrite.report;
    this.#deleted = false;
  }

  // The method and its request (of CreateJob the requests) of the next call; undefined if the file is here.
  nextCall() {
    const job = this.#job;
    if (!job) return ["CreateJob", this.#upload()];
    if (job.state === "STATE_FAILED") throw new TraverseError(job.fault.code, job.fault.message);
    if (job.state !== "STATE_DONE") return ["WatchJob", { id: job.id, known_revision: job.revision }];
    if (bytes(this.#data) < job.summary.bytes) return ["ReadJob", { id: job.id, offset: bytes(this.#data) }];
    if (!this.#reportRead) return ["ReadJob", { id: job.id, report: true, offset: bytes(this.#report) }];
    return this.#deleted ? undefined : ["CancelJob", { id: job.id }];
  }

  *#upload() {
    const left = this.#deadline - Date.now();
    const ms = Math.max(1, left - Math.min(5000, left / 10)); // to have time for the way back
    const deadline = { seconds: Math.floor(ms / 1000), nanos: Math.floor(ms % 1000) * 1e6 };
    yield { options: { ...this.#options, deadline } };
    for (let begin = 0; begin < this.#file.length; begin += PIECE_BYTES) {
      yield { data: this.#file.subarray(begin, begin + PIECE_BYTES) };
    }
  }

  // Takes one answer. Throws what may pass if the job failed so.
  take(answer, method, request) {
    if (method === "CancelJob") {
      this.#deleted = true;
    } else if (method === "ReadJob") {
      (request.report ? this.#report : this.#data).push(answer.data);
      this.#attempt = 0;
    } else {
      const { job } = answer;
      if (this.#job && job.revision > this.#job.revision) this.#attempt = 0;
      this.#job = job;
      this.#onProgress?.(job.progress);
      if (job.state === "STATE_FAILED" && RETRIED.includes(job.fault.code)) {
        this.#job = undefined; // for the same key the gateway begins anew
        throw Object.assign(new Error(job.fault.message), { code: job.fault.code, details: job.fault.message });
      }
    }
  }

  // All answers came.
  ended(method, request) {
    if (method === "ReadJob" && request.report) this.#reportRead = true;
  }

  // How long to wait before nextCall. Throws where no other call helps.
  delayAfter(error, method) {
    if (typeof error.code !== "number") throw error;
    if (method === "CancelJob") {
      this.#deleted = true; // or will be, when it expires
      return 0;
    }
    if (this.#job && LOST.includes(error.code)) {
      this.#beginAnew();
    } else if (!RETRIED.includes(error.code)) {
      throw new TraverseError(error.code, error.details, error);
    } else if (!this.#job || (this.#attempt >= TRIES_OF_ONE && this.#gateways > 1)) {
      this.#beginAnew();
      this.gateway = (this.gateway + 1) % this.#gateways;
    }
    const delay = delayMs(error, this.#attempt);
    if (Date.now() + delay >= this.#deadline) throw new TraverseError(error.code, error.details, error);
    ++this.#attempt;
    return delay;
  }

  // The id of what to cancel if nobody waits for the file any more.
  get abandoned() { return this.#deleted ? undefined : this.#job?.id; }

  get file() {
    return { data: Buffer.concat(this.#data), report: Buffer.concat(this.#report).toString("utf8"), summary: this.#job.summary };
  }
}

const bytes = (pieces) => pieces.reduce((sum, piece) => sum + piece.length, 0);
