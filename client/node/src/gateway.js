import { readFile } from "node:fs/promises";
import { basename } from "node:path";
import grpc from "@grpc/grpc-js";
import { TraverseError } from "./errors.js";
import { withRetries } from "./retries.js";
import { connect, metadataWith, send, services } from "./wire.js";

const PIECE_BYTES = 1 << 20;

export class GcodeGateway {
  #stub;
  #token;

  constructor(addresses, options = {}) {
    this.#stub = connect(services.GcodeService, addresses, options);
    this.#token = options.token;
  }

  close() { this.#stub.close(); }

  async rewrite(file, { deadlineSeconds = 600, options = {}, onProgress } = {}) {
    const named = typeof file === "string";
    const data = named ? await readFile(file) : Buffer.from(file);
    const stated = named && !options.name ? { ...options, name: basename(file) } : options;
    const deadline = Date.now() + deadlineSeconds * 1000;
    let made;
    const begin = () => {
      made = { data: [], report: [], summary: undefined };
      const call = this.#stub.Rewrite(metadataWith(this.#token), { deadline });
      upload(call, stated, data);
      return { call };
    };
    for await (const answer of withRetries(deadline, begin)) {
      if (answer.part === "progress") onProgress?.(answer.progress);
      else if (answer.part === "summary") made.summary = answer.summary;
      else made[answer.part].push(answer[answer.part]);
    }
    if (!made.summary) throw new TraverseError(grpc.status.DATA_LOSS, "the answer ended before the file was whole");
    return { data: Buffer.concat(made.data), report: Buffer.concat(made.report).toString("utf8"), summary: made.summary };
  }
}

async function upload(call, options, data) {
  await send(call, { options });
  for (let begin = 0; begin === 0 || begin < data.length; begin += PIECE_BYTES) {
    await send(call, { data: data.subarray(begin, begin + PIECE_BYTES) });
  }
  call.end();
}
