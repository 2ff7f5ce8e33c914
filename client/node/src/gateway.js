import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import { setTimeout as sleep } from "node:timers/promises";
import { FileJob } from "./file_job.js";
import { connect, metadataWith, send, services, shuffled } from "./wire.js";

const CANCEL_MS = 10_000;
const ABANDON_MS = 1000; // to cancel a job whose deadline may be over: its caller waits for it

export class GcodeGateway {
  #stubs;
  #token;

  constructor(addresses, options = {}) {
    // One by one, because the calls of a job belong to one gateway.
    this.#stubs = shuffled(addresses).map((address) => connect(services.GcodeService, [address], options, "pick_first"));
    this.#token = options.token;
  }

  close() { this.#stubs.forEach((stub) => stub.close()); }

  async rewrite(file, { deadlineSeconds = 600, options = {}, onProgress, idempotencyKey } = {}) {
    const named = typeof file === "string";
    const data = named ? await readFile(file) : Buffer.from(file);
    const stated = named && !options.name ? { ...options, name: basename(file) } : options;
    const deadline = Date.now() + deadlineSeconds * 1000;
    const job = new FileJob(data, stated, idempotencyKey, onProgress, deadline, this.#stubs.length);
    try {
      for (let next = job.nextCall(); next; next = job.nextCall()) {
        try {
          await this.#make(job, deadline, ...next);
        } catch (error) {
          await sleep(job.delayAfter(error, next[0]));
        }
      }
      return job.file;
    } catch (error) {
      // If this fails too, it expires.
      const soon = Date.now() + ABANDON_MS;
      if (job.abandoned) await this.#unary(job.gateway, "CancelJob", { id: job.abandoned }, soon).catch(() => {});
      throw error;
    }
  }

  #metadata() { return metadataWith(this.#token, this.#stubs.length === 1); }

  #unary(gateway, method, request, deadline) {
    return new Promise((resolve, reject) => this.#stubs[gateway][method](request, metadataWith(this.#token, false), { deadline },
      (error, answer) => (error ? reject(error) : resolve(answer))));
  }

  async #make(job, deadline, method, request) {
    if (method === "CancelJob") { // the file is here: nobody waits for this
      const soon = Math.min(deadline, Date.now() + CANCEL_MS);
      return job.take(await this.#unary(job.gateway, method, request, soon), method, request);
    }
    if (method === "CreateJob") return job.take(await this.#create(job.gateway, request, deadline), method, request);
    const call = this.#stubs[job.gateway][method](request, this.#metadata(), { deadline });
    try {
      for await (const answer of call) job.take(answer, method, request);
    } finally {
      call.cancel(); // nothing if it has ended
    }
    job.ended(method, request);
  }

  #create(gateway, requests, deadline) {
    return new Promise((resolve, reject) => {
      const call = this.#stubs[gateway].CreateJob(this.#metadata(), { deadline },
        (error, answer) => (error ? reject(error) : resolve(answer)));
      (async () => {
        for (const request of requests) await send(call, request);
        call.end();
      })().catch(reject);
    });
  }
}
