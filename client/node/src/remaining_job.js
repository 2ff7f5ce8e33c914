// What is left of a job, whatever attempt is under way.
export class RemainingJob {
  #options;
  #unanswered;
  #answered = 0; // in all attempts
  #before = 0; // in those before the one under way
  #last;

  constructor(options, strategy, layers = []) {
    // In build order what came is a prefix of the job.
    this.#options = { ...options, ...(strategy && { strategy: { ...options?.strategy, name: strategy } }),
      result_order: "RESULT_ORDER_BUILD" };
    this.#unanswered = [...layers];
  }

  sent(layer) { this.#unanswered.push(layer); }

  answered(result) {
    this.#unanswered.shift();
    ++this.#answered;
    this.#last = { ...result, index: result.index + this.#before };
    return this.#last;
  }

  // The options and layers of the next attempt, which begins where the last answered layer ended.
  beginAttempt() {
    const count = this.#answered - this.#before;
    this.#before = this.#answered;
    if (count > 0) this.#options = continued(this.#options, this.#last, count);
    return { options: this.#options, layers: [...this.#unanswered] };
  }
}

function continued(options, last, count) {
  const { cleaning } = options;
  if (!cleaning) return { ...options, start: last.end };
  const since = ((cleaning.layers_since_cleaning ?? 0) + count) % cleaning.every_layers;
  return { ...options, start: since === 0 ? cleaning.point : last.end,
    cleaning: { ...cleaning, layers_since_cleaning: since } };
}
