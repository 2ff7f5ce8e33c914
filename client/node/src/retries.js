// When a call is worth another try, and after how long.
import { setTimeout as sleep } from "node:timers/promises";
import grpc from "@grpc/grpc-js";
import protobuf from "protobufjs";
import { TraverseError } from "./errors.js";

// The first says "ask another server", the second "not now". A proxy resets a stream (CANCELLED) when the server behind it
// closes its connection; this client cancels no call that it waits for.
export const RETRIED = [grpc.status.UNAVAILABLE, grpc.status.RESOURCE_EXHAUSTED, grpc.status.CANCELLED];

// The parts of google.rpc.Status and google.rpc.RetryInfo that count.
const { root } = protobuf.parse(`syntax = "proto3";
  message Any { string type_url = 1; bytes value = 2; }
  message Status { repeated Any details = 3; }
  message Duration { int64 seconds = 1; int32 nanos = 2; }
  message RetryInfo { Duration retry_delay = 1; }`, { keepCase: true });

function statedDelayMs(error) {
  for (const bytes of error.metadata?.get("grpc-status-details-bin") ?? []) {
    for (const detail of root.lookupType("Status").decode(bytes).details) {
      if (!detail.type_url.endsWith("/google.rpc.RetryInfo")) continue;
      const { retry_delay: delay } = root.lookupType("RetryInfo").decode(detail.value);
      return Number(delay?.seconds ?? 0) * 1000 + (delay?.nanos ?? 0) / 1e6;
    }
  }
  return undefined;
}

// What the server asks for, else 100 ms doubled with each attempt up to 5000, and some chance.
export function delayMs(error, attempt) {
  const stated = statedDelayMs(error);
  if (stated !== undefined) return stated * (1 + 0.2 * Math.random());
  return Math.min(5000, 100 * 2 ** Math.min(attempt, 10)) * (0.8 + 0.4 * Math.random());
}

// Yields what attempt(call => ...) yields; begins again after faults that may pass, until `deadline` (ms since 1970). The
// attempt counter starts anew whenever an answer came.
export async function* withRetries(deadline, begin) {
  for (let attempt = 0; ; ++attempt) {
    const { call, fault } = begin();
    try {
      for await (const answer of call) {
        attempt = 0;
        yield answer;
      }
      return;
    } catch (error) {
      if (fault?.error !== undefined) throw fault.error;
      if (typeof error.code !== "number") throw error;
      const delay = delayMs(error, attempt);
      if (!RETRIED.includes(error.code) || Date.now() + delay >= deadline) {
        throw new TraverseError(error.code, error.details, error);
      }
      await sleep(delay);
    } finally {
      call.cancel(); // nothing if it has ended
    }
  }
}
