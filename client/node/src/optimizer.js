import { TraverseError } from "./errors.js";
import { RemainingJob } from "./remaining_job.js";
import { withRetries } from "./retries.js";
import { connect, metadataWith, send, services } from "./wire.js";

export class TravelOptimizer {
  #stub;
  #token;

  constructor(addresses, options = {}) {
    this.#stub = connect(services.RouteOptimizerService, addresses, options);
    this.#token = options.token;
  }

  close() { this.#stub.close(); }

  async *optimize(layers, { deadlineSeconds = 30, strategy, options } = {}) {
    const deadline = Date.now() + deadlineSeconds * 1000;
    const whole = Array.isArray(layers);
    const job = new RemainingJob(options, strategy, whole ? layers : []);
    const source = whole ? undefined : new Source(layers);
    const begin = () => {
      const metadata = metadataWith(this.#token);
      if (whole) return { call: this.#stub.OptimizeBatch(job.beginAttempt(), metadata, { deadline }) };
      const call = this.#stub.Optimize(metadata, { deadline });
      source.feed(call, job);
      return { call, fault: source };
    };
    for await (const answer of withRetries(deadline, begin)) {
      if (answer.result === "layer") yield job.answered(answer.layer);
    }
  }

  strategies({ timeoutSeconds = 10 } = {}) {
    const deadline = Date.now() + timeoutSeconds * 1000;
    return new Promise((resolve, reject) => this.#stub.ListStrategies({}, metadataWith(this.#token), { deadline },
      (error, answer) => {
        if (error) return reject(new TraverseError(error.code, error.details, error));
        const { strategies, ...server } = answer;
        resolve(Object.assign(strategies, server));
      }));
  }
}

// A caller's layers, from one attempt to the next: a layer that is being fetched when one ends is not lost.
class Source {
  error; // what the caller's iterable threw
  #layers;
  #fetching;

  constructor(layers) {
    this.#layers = (layers[Symbol.asyncIterator] ?? layers[Symbol.iterator]).call(layers);
  }

  // Sends to `call` what lacks an answer, then further layers as it takes them, until nobody reads its answers.
  async feed(call, job) {
    const { options, layers } = job.beginAttempt();
    await send(call, { options, layers });
    while (!call.destroyed) {
      this.#fetching ??= (async () => this.#layers.next())(); // async: a synchronous iterator throws at once
      let next;
      try {
        next = await this.#fetching;
      } catch (error) {
        this.error = error;
        call.cancel();
        return;
      }
      if (call.destroyed) return; // the next attempt, if any, takes it
      if (next.done) {
        call.end();
        return;
      }
      this.#fetching = undefined;
      job.sent(next.value);
      await send(call, { layers: [next.value] });
    }
  }
}
