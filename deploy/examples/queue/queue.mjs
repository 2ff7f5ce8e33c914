// The queue: a stream of NATS JetStream on disk, from which an order goes when a worker says that it is done.
import { AckPolicy, RetentionPolicy, StorageType, connect, nanos } from "nats";

const ACK_WAIT_MS = 20_000; // who says nothing for so long is taken for dead, and the order goes to another one
const DUPLICATES_MS = 24 * 3600_000; // an order that is sent twice within a day is one

export async function openQueue(servers) {
  const connection = await connect({ servers, maxReconnectAttempts: -1, waitOnFirstConnect: true });
  const manager = await connection.jetstreamManager();
  await manager.streams.add({ name: "PRINTS", subjects: ["prints"], storage: StorageType.File,
    retention: RetentionPolicy.Workqueue, duplicate_window: nanos(DUPLICATES_MS) });
  await manager.consumers.add("PRINTS", { durable_name: "gateways", ack_policy: AckPolicy.Explicit, ack_wait: nanos(ACK_WAIT_MS) });
  const stream = connection.jetstream();
  const consumer = await stream.consumers.get("PRINTS", "gateways");
  return { connection, stream, orders: endless(consumer) };
}

// The orders, one at a time, however often the queue goes away.
async function* endless(consumer) {
  for (;;) {
    const order = await consumer.next({ expires: 5000 }).catch(() => new Promise((later) => setTimeout(later, 500, null)));
    if (order) yield order;
  }
}
