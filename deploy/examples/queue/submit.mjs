// Orders files: node submit.mjs QUEUE_HOST:PORT FILE...     Again after an error: what was ordered already is not ordered twice.
import { openQueue } from "./queue.mjs";

const [, , server, ...files] = process.argv;
const { connection, stream } = await openQueue(server);
for (const file of files) await stream.publish("prints", JSON.stringify({ file }), { msgID: file });
await connection.close();
