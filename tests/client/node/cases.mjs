// What the Node client promises, against scripted servers and the real programs; run by package_test.py in a folder where the
// package is installed. TRAVERSE_SERVER and TRAVERSE_GATEWAY name the programs.
import assert from "node:assert/strict";
import { execFile, spawn } from "node:child_process";
import { cp, readFile, writeFile } from "node:fs/promises";
import { connect as connectTo, createServer } from "node:net";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import { promisify } from "node:util";
import grpc from "@grpc/grpc-js";
import loader from "@grpc/proto-loader";
import protobuf from "protobufjs";
import { GcodeGateway, TravelOptimizer, TraverseError, island, layer } from "traverse-client";

const SQUARES = [0, 40, 20].flatMap((x) => [0, 30].map((y) => [[x, y], [x + 4, y], [x + 4, y + 4], [x, y + 4]]));
const layers = (count, first = 1) => Array.from({ length: count }, (_, i) => layer([island({ contours: SQUARES })],
  { id: first + i, zMm: 0.2 * (first + i) }));

const api = grpc.loadPackageDefinition(loader.loadSync(["route_optimizer_service", "gcode_service"].map((name) => `traverse/v1/${name}.proto`),
  { keepCase: true, longs: Number, oneofs: true, includeDirs: ["node_modules/traverse-client/proto"] })).traverse.v1;
const { root: rpc } = protobuf.parse(`syntax = "proto3";
  message Any { string type_url = 1; bytes value = 2; } message Status { repeated Any details = 3; }
  message Duration { int64 seconds = 1; int32 nanos = 2; } message RetryInfo { Duration retry_delay = 1; }`, { keepCase: true });

function refusal(code, seconds) {
  const metadata = new grpc.Metadata();
  if (seconds !== undefined) {
    const value = rpc.lookupType("RetryInfo").encode({ retry_delay: { seconds: Math.floor(seconds), nanos: (seconds % 1) * 1e9 } }).finish();
    const details = [{ type_url: "type.googleapis.com/google.rpc.RetryInfo", value }];
    metadata.set("grpc-status-details-bin", Buffer.from(rpc.lookupType("Status").encode({ details }).finish()));
  }
  return { code, details: "scripted", metadata };
}

// The address of a server with these methods.
async function serve(t, { service }, methods) {
  const server = new grpc.Server();
  server.addService(service, methods);
  const port = await promisify(server.bindAsync.bind(server))("127.0.0.1:0", grpc.ServerCredentials.createInsecure());
  t.after(() => server.forceShutdown());
  return `127.0.0.1:${port}`;
}

// Answers each attempt as its turn says: [layers to answer, status code or undefined, delay in s].
async function scripted(t, ...turns) {
  const asked = [], tokens = [];
  const begin = (call) => {
    const [count, code, delay] = turns.shift();
    const ids = [];
    asked.push(ids);
    tokens.push(call.metadata.get("authorization")[0]);
    return {
      answer(one) {
        if (this.refused) return;
        if (code !== undefined && ids.length === count) {
          this.refused = true;
          call.emit("error", refusal(code, delay));
          return;
        }
        call.write({ layer: { index: ids.length, id: one.id, end: { x_mm: one.id, y_mm: 0 } } });
        ids.push(one.id);
      },
      end() {
        call.write({ summary: {} });
        call.end();
      } };
  };
  const address = await serve(t, api.RouteOptimizerService, {
    OptimizeBatch(call) {
      const turn = begin(call);
      for (const one of call.request.layers) turn.answer(one);
      if (!turn.refused) turn.end();
    },
    Optimize(call) {
      const turn = begin(call);
      call.on("data", (message) => message.layers?.forEach((one) => turn.answer(one)));
      call.on("end", () => turn.refused || turn.end());
    },
    ListStrategies: (_, done) => done(null, {}) });
  return { asked, tokens, address };
}

async function optimizer(t, addresses, options) {
  const made = new TravelOptimizer(addresses, options);
  t.after(() => made.close());
  return made;
}

async function collect(answers) {
  const got = [];
  for await (const answer of answers) got.push(answer);
  return got;
}

const FORMS = { array: (given) => given, iterator: (given) => given.values() };

for (const [form, as] of Object.entries(FORMS)) {
  test(`layers that were answered are not asked again (${form})`, async (t) => {
    const { UNAVAILABLE } = grpc.status;
    const server = await scripted(t, [2, UNAVAILABLE, 0.01], [1, UNAVAILABLE, 0.01], [9]);
    const client = await optimizer(t, [server.address]);

    const results = await collect(client.optimize(as(layers(5)), { deadlineSeconds: 20 }));

    assert.deepEqual(results.map(({ index, id }) => [index, id]), [0, 1, 2, 3, 4].map((i) => [i, i + 1]));
    assert.equal(server.asked.length, 3);
    assert.equal(server.asked[2].at(-1), 5);
  });

  test(`a fault of the job is not tried again (${form})`, async (t) => {
    const server = await scripted(t, [0, grpc.status.INVALID_ARGUMENT]);
    const client = await optimizer(t, [server.address]);

    await assert.rejects(collect(client.optimize(as(layers(2)))), (error) => error instanceof TraverseError
      && error.code === "INVALID_ARGUMENT");
    assert.equal(server.asked.length, 1);
  });
}

test("what the iterable throws comes out", async (t) => {
  const server = await scripted(t, [9], [9]);
  const client = await optimizer(t, [server.address]);
  function* broken() {
    yield* layers(2);
    throw new RangeError("no third layer");
  }
  async function* brokenLater() { yield* broken(); }

  await assert.rejects(collect(client.optimize(broken())), /no third layer/);
  await assert.rejects(collect(client.optimize(brokenLater())), /no third layer/);
});

test("layers are read only as long as somebody waits for routes", async (t) => {
  const server = await scripted(t, [1e6], [0, grpc.status.INVALID_ARGUMENT]);
  const client = await optimizer(t, [server.address]);
  const [one] = layers(1);
  let taken = 0;
  function* many() { for (taken = 0; taken < 100_000; ++taken) yield one; }
  const isLeftAlone = async () => {
    const before = taken;
    await sleep(20);
    assert.equal(taken, before);
    assert.ok(taken < 100_000);
  };

  for await (const _ of client.optimize(many())) break;
  await isLeftAlone();

  await assert.rejects(collect(client.optimize(many())), { code: "INVALID_ARGUMENT" });
  await isLeftAlone();
});

test("a token is asked for each attempt", async (t) => {
  const server = await scripted(t, [0, grpc.status.UNAVAILABLE, 0.01], [9]);
  const tokens = ["old", "new"];
  const client = await optimizer(t, [server.address], { token: () => tokens.shift() });

  await collect(client.optimize(layers(1)));

  assert.deepEqual(server.tokens, ["Bearer old", "Bearer new"]);
});

test("a server that asks to wait beyond the deadline ends the job", async (t) => {
  const server = await scripted(t, [0, grpc.status.RESOURCE_EXHAUSTED, 100]);
  const client = await optimizer(t, [server.address]);

  await assert.rejects(collect(client.optimize(layers(1), { deadlineSeconds: 5 })), { code: "RESOURCE_EXHAUSTED" });
});

test("one string is no list of addresses", () => assert.throws(() => new TravelOptimizer("127.0.0.1:50051"), TypeError));

// A real program on free ports, which it says once it is up; `address` speaks gRPC.
async function program(t, variable, ...flags) {
  const process_ = spawn(process.env[variable], ["--listen=127.0.0.1:0", "--metrics_listen=127.0.0.1:0", ...flags],
    { stdio: ["ignore", "pipe", "ignore"] });
  t.after(() => process_.kill("SIGKILL"));
  let said = "";
  await new Promise((resolve, reject) => {
    process_.once("exit", () => reject(new Error(`${variable} has ended: ${said}`)));
    process_.stdout.on("data", (text) => { if (/^metrics .*\n/m.test(said += text)) resolve(); });
  });
  const [port, operators] = said.match(/\d+$/gm).slice(-2);
  return {
    address: `127.0.0.1:${port}`,
    metrics: async () => (await fetch(`http://127.0.0.1:${operators}/metrics`)).text(),
    kill: () => process_.kill("SIGKILL"),
  };
}

test("routes come from a real server, for arrays and iterators", async (t) => {
  const server = await program(t, "TRAVERSE_SERVER");
  const client = await optimizer(t, [server.address]);
  for (const as of Object.values(FORMS)) {
    const results = await collect(client.optimize(as(layers(20)), { strategy: "ni2opt" }));

    assert.deepEqual(results.map(({ id }) => id), layers(20).map(({ id }) => id));
    assert.ok(results.every(({ visits }) => visits.length === SQUARES.length));
  }
  const strategies = await client.strategies();
  assert.ok(strategies.some(({ name }) => name === "auto"));
  assert.equal(strategies.default_strategy, "auto");
  assert.ok(strategies.capabilities.includes("partial_answers"));
  assert.match(strategies.server_version, /^\d+\.\d+\.\d+$/);
});

test("a known route is where the search begins", async (t) => {
  const server = await program(t, "TRAVERSE_SERVER");
  const client = await optimizer(t, [server.address]);
  assert.ok((await client.strategies()).capabilities.includes("initial_route"));
  const islands = [island({ contours: SQUARES, rasters: [[[1, 1], [3, 3]], [[41, 1], [43, 3]]] })];
  const plan = { plan: { paths: [{ contour: { points: [0, 0, 4, 0] } }, { open_path: { points: [9, 9, 8, 8] } }],
    nodes: [{ any_order: { children: [1, 2] } }, { path: 0 }, { path: 1 }] } };
  const found = await collect(client.optimize([layer(islands), plan]));

  const known = [layer(islands, { initialRoute: found[0].visits }), { ...plan, initial_route: found[1].visits }];
  const again = await collect(client.optimize(known, { strategy: "none" }));

  assert.deepEqual(again.map(({ visits }) => visits), found.map(({ visits }) => visits));
  const wrong = layer(islands, { initialRoute: [{ island: 0, contour: 9, vertex: 0 }] });
  await assert.rejects(collect(client.optimize([wrong])), (error) => error.code === "INVALID_ARGUMENT"
    && error.details.startsWith("layers[0].initial_route[0].contour: 9, but there are 6"));
});

test("killing one of three servers loses no layer", async (t) => {
  const servers = await Promise.all([1, 2, 3].map(() => program(t, "TRAVERSE_SERVER")));
  const client = await optimizer(t, servers.map(({ address }) => address));
  const jobs = Array.from({ length: 8 }, async (_, number) => {
    const sent = layers(40, 1000 * number);
    const got = await collect(client.optimize(sent.values(), { deadlineSeconds: 60 }));
    assert.deepEqual(got.map(({ id }) => id), sent.map(({ id }) => id));
  });
  await Promise.race(jobs);

  servers[0].kill();

  await Promise.all(jobs);
});

test("a file comes back with progress", async (t) => {
  const gateway = await program(t, "TRAVERSE_GATEWAY", "--listen_http=127.0.0.1:0");
  const client = new GcodeGateway([gateway.address]);
  t.after(() => client.close());
  const seen = [];

  const made = await client.rewrite(process.env.TRAVERSE_SHORT, { options: { report: true }, onProgress: (one) => seen.push(one) });

  assert.equal(made.summary.verified, true);
  assert.equal(made.data.length, made.summary.bytes);
  assert.match(made.report, /<html/);
  assert.ok(seen.length > 0);
  await assert.rejects(client.rewrite(new Uint8Array()), TraverseError);
});

test("who does not wait for a file is not kept by a gateway that hangs", async (t) => {
  let ms;
  const address = await serve(t, api.GcodeService, {
    CreateJob: (call, done) => call.on("data", () => {}).on("end", () => done(null, { job: { id: "one" } })),
    CancelJob(call, done) {
      ms = call.getDeadline() - Date.now();
      done(null, {});
    } });
  const client = new GcodeGateway([address]);
  t.after(() => client.close());
  const onProgress = () => { throw new Error("enough"); };

  await assert.rejects(client.rewrite(Buffer.from("G1"), { onProgress }), /enough/);
  assert.ok(ms < 2000);
});

// A wire to `address` that can be cut; new connections then go through again.
async function wireTo(t, address) {
  const [host, port] = address.split(":");
  const ends = new Set();
  const server = createServer((near) => {
    const far = connectTo(Number(port), host);
    near.pipe(far).pipe(near);
    for (const end of [near, far]) {
      ends.add(end);
      end.on("error", () => {}).on("close", () => { near.destroy(); far.destroy(); ends.delete(end); });
    }
  });
  await new Promise((resolve) => server.listen(0, "127.0.0.1", resolve));
  const cut = () => ends.forEach((end) => end.destroy());
  t.after(() => { server.close(); cut(); });
  return { address: `127.0.0.1:${server.address().port}`, cut };
}

test("a cut wire costs no work", async (t) => {
  const gateway = await program(t, "TRAVERSE_GATEWAY", "--listen_http=127.0.0.1:0");
  const wire = await wireTo(t, gateway.address);
  const client = new GcodeGateway([wire.address]);
  t.after(() => client.close());
  const cuts = [];

  const made = await client.rewrite(process.env.TRAVERSE_SAMPLE, { onProgress: ({ stage }) => {
    if (cuts.length === 3 || cuts.includes(stage)) return;
    cuts.push(stage);
    wire.cut();
  } });

  assert.ok(cuts.length >= 2);
  assert.equal(made.data.length, made.summary.bytes);
  const told = await gateway.metrics();
  const worked = [...told.matchAll(/^traverse_gateway_files_total\{.*\} (.+)$/gm)].reduce((sum, [, count]) => sum + Number(count), 0);
  assert.equal(worked, 1);
  assert.match(told, /^traverse_gateway_jobs 0$/m);
});

test("another gateway takes the file of one that was killed", async (t) => {
  const gateways = await Promise.all(["one", "two"].map((name) => program(t, "TRAVERSE_GATEWAY", "--listen_http=127.0.0.1:0",
    `--gateway_name=${name}`)));
  const client = new GcodeGateway(gateways.map(({ address }) => address));
  t.after(() => client.close());
  const killOwner = async () => {
    for (const gateway of gateways) {
      if (/^traverse_gateway_jobs 1$/m.test(await gateway.metrics())) return gateway.kill() ?? 1;
    }
    return 0;
  };
  let killed;

  const made = await client.rewrite(process.env.TRAVERSE_SAMPLE, { onProgress: ({ stage }) => {
    if (stage === "STAGE_SEARCHING") killed ??= killOwner();
  } });

  assert.ok(await killed);
  assert.equal(made.data.length, made.summary.bytes);
});

test("the examples of its guide run", async (t) => {
  const server = await program(t, "TRAVERSE_SERVER");
  const gateway = await program(t, "TRAVERSE_GATEWAY", "--listen_http=127.0.0.1:0");
  await cp(process.env.TRAVERSE_SHORT, "part.gcode");
  const blocks = [...(await readFile(process.env.TRAVERSE_GUIDE, "utf8")).matchAll(/```js\n(.*?)```/gs)].map(([, code]) => code);
  for (const [number, block] of blocks.entries()) {
    await writeFile(`guide${number}.mjs`, block.replace("127.0.0.1:50051", server.address).replace("127.0.0.1:50061", gateway.address));
    const { stdout } = await promisify(execFile)(process.execPath, [`guide${number}.mjs`], { timeout: 120_000 });
    assert.notEqual(stdout.trim(), "");
  }
  assert.equal(blocks.length, 2);
});

test("the examples of deploy run", async (t) => {
  const server = await program(t, "TRAVERSE_SERVER");
  const gateway = await program(t, "TRAVERSE_GATEWAY", "--listen_http=127.0.0.1:0");
  const run = async (...words) => (await promisify(execFile)(process.execPath, words, { timeout: 120_000 })).stdout;
  await writeFile("job.json", JSON.stringify({ options: { strategy: { name: "greedy" } }, layers: layers(3) }));

  assert.equal((await run("examples/submit_job.mjs", "job.json", server.address)).match(/layer \d: travel .* mm -> .* mm/g).length, 3);
  await run("examples/send_file.mjs", process.env.TRAVERSE_SHORT, "shorter.gcode", gateway.address);
  assert.match((await readFile("shorter.gcode", "utf8")).slice(0, 1000), /; optimised by Traverse/);
});
