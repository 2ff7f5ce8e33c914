// A client of Traverse for a scheduler to copy: one job, layer by layer, through refusals and restarts.
//
//   const client = new TraverseClient(["10.0.0.1:50051", "10.0.0.2:50051"]);
//   for await (const result of client.optimize(job, 30)) console.log(result.index, result.travel.total_mm);
//
// What it takes care of:
// - Several servers: each attempt goes to the next one.
// - A server that goes away (UNAVAILABLE) or is full (RESOURCE_EXHAUSTED): tried again, after the delay
//   that the server asks for or a growing one of its own, until the deadline.
// - Nothing is computed twice: an attempt asks only for the layers that are still missing.
// - The deadline: the server answers before it, with the best routes it has. So DEADLINE_EXCEEDED means
//   that no server was reached in time.
import { fileURLToPath } from "node:url";
import { setTimeout as sleep } from "node:timers/promises";
import grpc from "@grpc/grpc-js";
import loader from "@grpc/proto-loader";
import protobuf from "protobufjs";

// Where the .proto files are: TRAVERSE_PROTO (the Debian package has them in /usr/share/traverse/proto),
// else where the source has them. A scheduler ships its own copy.
const PROTO_FOLDERS = ["../../../proto", "../../../server/proto"].map(
  (folder) => process.env.TRAVERSE_PROTO ?? fileURLToPath(new URL(folder, import.meta.url)));
const FILES = ["traverse/v1/route_optimizer_service.proto", "google/rpc/status.proto", "google/rpc/error_details.proto"];

const definition = loader.loadSync(FILES[0], { keepCase: true, longs: Number, enums: String, defaults: true, oneofs: true,
  includeDirs: PROTO_FOLDERS });
const { RouteOptimizerService } = grpc.loadPackageDefinition(definition).traverse.v1;

const types = new protobuf.Root();
types.resolvePath = (_, target) => target.startsWith("google/protobuf/") ? target
  : PROTO_FOLDERS.map((folder) => `${folder}/${target}`).find((path) => protobuf.util.fs.existsSync(path)) ?? target;
types.loadSync(FILES, { keepCase: true });

// Worth another try: the first says "ask another server", the second "not now". The third is not ours, for this client
// cancels no call that it waits for: a proxy resets a stream so when the server behind it closes its connection.
export const RETRIED = [grpc.status.UNAVAILABLE, grpc.status.RESOURCE_EXHAUSTED, grpc.status.CANCELLED];

const SERVICE_CONFIG = JSON.stringify({ loadBalancingConfig: [{ round_robin: {} }] });

// The job in the bytes of a .pb file, as `traverse convert` writes them.
export function decodeJob(bytes) {
  const type = types.lookupType("traverse.v1.OptimizeBatchRequest");
  return type.toObject(type.decode(bytes), { longs: Number, enums: String, arrays: true });
}

// The job cannot be done: `code` is a grpc.status, the text says what is wrong and where.
export class JobFailed extends Error {
  constructor(error) {
    super(`${grpc.status[error.code]}: ${error.details}`);
    this.code = error.code;
  }
}

export class TraverseClient {
  #stub;

  // One address may be a name with many servers behind it: dns:///traverse-headless:50051.
  // `serverName`: what the servers' certificates say, if it is not the address; with several addresses it never is.
  constructor(addresses, credentials = grpc.credentials.createInsecure(), serverName = undefined) {
    const target = addresses.length === 1 ? addresses[0] : `ipv4:${addresses.join(",")}`;
    this.#stub = new RouteOptimizerService(target, credentials, {
      "grpc.service_config": SERVICE_CONFIG, "grpc.keepalive_time_ms": 60_000, "grpc.max_reconnect_backoff_ms": 2_000,
      ...(serverName && { "grpc.ssl_target_name_override": serverName }) });
  }

  close() { this.#stub.close(); }

  // Yields the routes in build order, each as soon as it is there; throws JobFailed. A result's `index`
  // is the layer's position in `job`, in whichever attempt it was solved. Break off the loop and the
  // server stops working.
  async *optimize(job, deadlineSeconds) {
    const deadline = Date.now() + deadlineSeconds * 1000;
    // In build order what came is a prefix of the job.
    let request = { options: { ...job.options, result_order: "RESULT_ORDER_BUILD" }, layers: job.layers };
    let done = 0;
    for (let attempt = 0; ; ++attempt) {
      let last = null;
      let delay = 0;
      // wait for ready: until a server can be reached, but not beyond the deadline.
      const metadata = new grpc.Metadata({ waitForReady: true });
      const call = this.#stub.OptimizeBatch(request, metadata, { deadline });
      try {
        for await (const answer of call) {
          if (answer.result !== "layer") continue;
          last = { ...answer.layer, index: answer.layer.index + done };
          attempt = 0;
          yield last;
        }
        return;
      } catch (error) {
        delay = retryDelay(error, attempt);
        if (!RETRIED.includes(error.code) || Date.now() + delay >= deadline) throw new JobFailed(error);
      } finally {
        call.cancel(); // nothing if it has ended
      }
      if (last) {
        request = rest(request, last, last.index + 1 - done);
        done = last.index + 1;
      }
      await sleep(delay);
    }
  }
}

// The request for what is left after the first `count` layers of `request`, of which `last` is the last.
function rest(request, last, count) {
  const options = { ...request.options, start: last.end };
  if (options.cleaning) {
    const since = ((options.cleaning.layers_since_cleaning ?? 0) + count) % options.cleaning.every_layers;
    options.cleaning = { ...options.cleaning, layers_since_cleaning: since };
    if (since === 0) options.start = options.cleaning.point;
  }
  return { options, layers: request.layers.slice(count) };
}

// Milliseconds to wait: what the server asks for, else 100 doubled with each attempt up to 5000, and some chance.
function retryDelay(error, attempt) {
  for (const bytes of error.metadata?.get("grpc-status-details-bin") ?? []) {
    const status = types.lookupType("google.rpc.Status").decode(bytes);
    for (const detail of status.details.filter(({ type_url: url }) => url.endsWith("/google.rpc.RetryInfo"))) {
      const { retry_delay: delay } = types.lookupType("google.rpc.RetryInfo").decode(detail.value);
      return (Number(delay.seconds) * 1000 + delay.nanos / 1e6) * (1 + 0.2 * Math.random());
    }
  }
  return Math.min(5000, 100 * 2 ** attempt) * (0.8 + 0.4 * Math.random());
}
