// The services as the .proto files of the package describe them, and channels to them.
import { fileURLToPath } from "node:url";
import grpc from "@grpc/grpc-js";
import loader from "@grpc/proto-loader";

const definition = loader.loadSync(["traverse/v1/route_optimizer_service.proto", "traverse/v1/gcode_service.proto"], {
  keepCase: true, longs: Number, enums: String, defaults: true, oneofs: true,
  includeDirs: [fileURLToPath(new URL("../proto", import.meta.url))] });
export const services = grpc.loadPackageDefinition(definition).traverse.v1;

function checked(addresses) {
  if (!Array.isArray(addresses)) throw new TypeError("addresses: an array of HOST:PORT");
  if (addresses.length === 0) throw new RangeError("addresses: empty");
  return addresses;
}

// The addresses in an order of chance, so that clients spread.
export const shuffled = (addresses) => checked(addresses)
  .map((address) => [Math.random(), address]).sort(([a], [b]) => a - b).map(([, address]) => address);

// A stub of `Service` over all addresses, in turn.
export function connect(Service, addresses, { credentials = grpc.credentials.createInsecure(), serverName } = {},
  policy = "round_robin") {
  checked(addresses);
  const target = addresses.length === 1 ? addresses[0] : `ipv4:${addresses.join(",")}`;
  return new Service(target, credentials, {
    "grpc.service_config": JSON.stringify({ loadBalancingConfig: [{ [policy]: {} }] }),
    "grpc.keepalive_time_ms": 60_000, "grpc.max_reconnect_backoff_ms": 2_000,
    ...(serverName && { "grpc.ssl_target_name_override": serverName }) });
}

// The metadata of a call. `token` may be a function; it is asked for each call, so that a token may be renewed.
export function metadataWith(token, waitForReady = true) {
  const metadata = new grpc.Metadata({ waitForReady });
  const bearer = typeof token === "function" ? token() : token;
  if (bearer) metadata.set("authorization", `Bearer ${bearer}`);
  return metadata;
}

// Resolves once the message is on its way, or the call has ended: a slow server slows the caller down.
export function send(call, message) {
  return new Promise((resolve) => {
    if (call.destroyed) return resolve();
    call.once("close", resolve);
    call.write(message, () => {
      call.off("close", resolve);
      resolve();
    });
  });
}
