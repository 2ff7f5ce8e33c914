// What a user does with the page, done. REPORTS has the pages, CHROMIUM is the browser; the page's sources are in src/.
import assert from "node:assert/strict";
import { mkdirSync, readFileSync, statSync } from "node:fs";
import { createServer } from "node:http";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const { REPORTS, CHROMIUM, TRAVERSE_SCREENSHOTS: SHOTS } = process.env;
const FLAGS = ["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run",
  "--disable-background-networking", "--disable-component-update", "--disable-sync"];
const DESK = { viewport: { width: 1200, height: 900 } };
const PHONE = { viewport: { width: 390, height: 800 }, deviceScaleFactor: 2, hasTouch: true, isMobile: true };

let browser, desk;
before(async () => {
  browser = await chromium.launch({ executablePath: CHROMIUM, args: FLAGS });
  desk = await (await browser.newContext({ colorScheme: "light", ...DESK })).newPage();
});
after(async () => { await browser.close(); });

// Opens a page and hands it to `body`; whatever it complains of or asks a network for fails the test.
async function on(name, options, body) {
  // Reports keep nothing from one visit to the next, and a process for each costs more than what is done in it.
  const page = options === DESK ? desk : await (await browser.newContext({ colorScheme: "light", ...options })).newPage();
  page.setDefaultTimeout(90000); // of a busy machine
  const complaints = [];
  const url = pathToFileURL(join(REPORTS, name)).href;
  page.on("console", (message) => complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(error.stack));
  page.on("dialog", (dialog) => complaints.push(`dialog: ${dialog.message()}`));
  page.on("request", (request) => { if (request.url() !== url && !request.url().startsWith("data:")) complaints.push(request.url()); });
  try {
    await page.goto(url);
    await page.waitForSelector("html[data-layer]", { state: "attached" });
    await settled(page);
    await body(page);
    assert.deepEqual(complaints, []);
  } finally {
    page.removeAllListeners();
    if (page !== desk) await page.context().close();
  }
}

const settled = (page) => page.evaluate(() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))));
const text = (page, selector) => page.locator(selector).innerText();
const pixels = (page, id) => page.evaluate((id) => document.getElementById(id).toDataURL(), id);
const layerOnView = (page) => page.evaluate(() => Number(document.documentElement.dataset.layer));

async function goesTo(page, layer, act) {
  await act();
  await page.waitForSelector(`html[data-layer="${layer}"]`);
  await settled(page);
}

async function shoot(page, name) {
  if (!SHOTS) return;
  mkdirSync(SHOTS, { recursive: true });
  await page.screenshot({ path: join(SHOTS, name), fullPage: true });
}

// How many pixels of a canvas have about this color.
const count = (page, id, color) => page.evaluate(([id, color]) => {
  const canvas = document.getElementById(id);
  // A copy to read from: the page's own canvas is for drawing.
  const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext("2d", { willReadFrequently: true });
  copy.drawImage(canvas, 0, 0);
  const { data } = copy.getImageData(0, 0, canvas.width, canvas.height);
  let found = 0;
  for (let i = 0; i < data.length; i += 4) {
    if ([0, 1, 2].every((k) => Math.abs(data[i + k] - color[k]) < 12)) ++found;
  }
  return found;
}, [id, color]);
const START = [0x15, 0x80, 0x3d];
const END = [0xbe, 0x12, 0x3c];
const TRAVEL = [0x11, 0x18, 0x27];
const OUTER = [0xe8, 0x59, 0x0c];

test("opens with its headline, both pictures, and the layer with the most saved", () =>
  on("gcode.html", DESK, async (page) => {
    assert.equal(await page.title(), "clusters13.gcode · Traverse");
    const cards = await page.locator("#headline .card").allInnerTexts();
    assert.equal(cards.length, 4);
    assert.match(cards[0], /^Travel\n−\d+\.\d %\n[\d.]+ mm → [\d.]+ mm$/);
    assert.match(cards[1], /^Print time\n/);
    assert.match(cards[3], /^Visible walls crossed\n.* %\n\d+ → \d+$/);
    const [, change, given, found] =
      /^Retractions\n(.+) %\n(\d+) → (\d+)\nwhere nobody would see: \d+ → \d+$/.exec(cards[2]);
    const percent = (Math.abs(found - given) / given * 100).toFixed(1);
    assert.equal(change, +found === +given ? "±0" : (+found < +given ? "−" : "+") + percent);
    assert.match(await text(page, "#before-name"), /^Before: \d+\.\d mm, \d+ retractions, \d+ walls? crossed$/);
    assert.match(await text(page, "#after-name"), /^After, ni2opt: \d+\.\d mm \(−\d+\.\d %\), \d+ retractions, \d+ walls? crossed$/);
    for (const id of ["before", "after"]) {
      for (const color of [START, END, TRAVEL]) assert.ok(await count(page, id, color) > 30, `${id} ${color}`);
    }
    assert.notEqual(await pixels(page, "before"), await pixels(page, "after"));
    assert.match(await text(page, "#legend"), /travel.*removed.*start.*end.*outer wall/s);
    await shoot(page, "gcode.png");
  }));

test("slider and buttons go through the layers", () =>
  on("compare.html", DESK, async (page) => {
    await page.locator("#layer").focus();
    await goesTo(page, 0, () => page.keyboard.press("Home"));
    const first = await pixels(page, "after");
    assert.match(await text(page, "#layer-name"), /^Layer 1 of 5/);
    await goesTo(page, 1, () => page.keyboard.press("ArrowRight"));
    assert.notEqual(await pixels(page, "after"), first);
    await goesTo(page, 2, () => page.locator("#next").click());
    await goesTo(page, 1, () => page.locator("#previous").click());
    await goesTo(page, 4, () => page.locator("#layer").fill("5"));
    await page.locator("#next").click(); // nothing is above
    assert.equal(await layerOnView(page), 4);
    assert.match(await text(page, "#layer-name"), /^Layer 5 of 5/);
  }));

test("all of it works by keyboard", () =>
  on("compare.html", DESK, async (page) => {
    await page.evaluate(() => document.activeElement.blur());
    await goesTo(page, 0, () => page.keyboard.press("Home"));
    await goesTo(page, 1, () => page.keyboard.press("ArrowRight"));
    await goesTo(page, 0, () => page.keyboard.press("ArrowLeft"));
    await goesTo(page, 4, () => page.keyboard.press("End"));
    const home = await pixels(page, "before");
    await page.keyboard.press("+");
    await settled(page);
    assert.notEqual(await pixels(page, "before"), home);
    await page.keyboard.press("0");
    await settled(page);
    assert.equal(await pixels(page, "before"), home);
    await page.keyboard.press("t");
    assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark");
    await page.keyboard.press(" ");
    await page.waitForSelector('html[data-playing="running"]');
    // Every control is reached by Tab, and shows that it has the focus.
    const reached = new Set();
    for (let i = 0; i < 14; ++i) {
      await page.keyboard.press("Tab");
      const [id, outline] = await page.evaluate(() =>
        [document.activeElement.id, getComputedStyle(document.activeElement).outlineStyle]);
      if (id) assert.notEqual(outline, "none", id);
      reached.add(id);
    }
    for (const id of ["theme", "layer", "previous", "next", "play", "speed", "strategy", "show-paths", "show-gone"]) {
      assert.ok(reached.has(id), id);
    }
  }));

test("what is deposited and what vanished can be left out", () =>
  on("compare.html", DESK, async (page) => {
    const [before, after] = [await pixels(page, "before"), await pixels(page, "after")];
    await page.locator("#show-gone").uncheck();
    await settled(page);
    assert.equal(await pixels(page, "before"), before);
    assert.notEqual(await pixels(page, "after"), after);
    const walls = await count(page, "after", OUTER);
    await page.locator("#show-paths").uncheck();
    await settled(page);
    assert.ok(walls > 100 && (await count(page, "after", OUTER)) < walls / 10);
    assert.ok((await count(page, "after", TRAVEL)) > 100);
  }));

test("the head runs along the route, pauses, and ends where it began to be watched", () =>
  on("compare.html", DESK, async (page) => {
    const rest = await pixels(page, "after");
    await page.locator("#play").click();
    await page.waitForTimeout(400);
    const early = await pixels(page, "after");
    assert.match(await text(page, "#speed-name"), /^head at \d+ mm\/s$/);
    await page.waitForTimeout(1500);
    await page.locator("#play").click();
    await settled(page);
    const paused = await pixels(page, "after");
    assert.ok(early !== rest && paused !== early);
    await shoot(page, "playing.png");
    await page.waitForTimeout(300);
    assert.equal(await pixels(page, "after"), paused);
    await page.locator("#speed").selectOption("4");
    await page.locator("#play").click();
    await page.waitForSelector("html:not([data-playing])", { timeout: 60000 });
    await settled(page);
    assert.equal(await pixels(page, "after"), rest);
  }));

test("dark where the system is dark, until the user turns it", () =>
  on("gcode.html", { ...DESK, colorScheme: "dark" }, async (page) => {
    const ground = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.equal(await ground(), "rgb(15, 20, 27)");
    assert.ok((await count(page, "before", [0x0f, 0x14, 0x1b])) > 10000);
    await shoot(page, "dark.png");
    await page.locator("#theme").click();
    await settled(page);
    assert.equal(await ground(), "rgb(255, 255, 255)");
    assert.ok((await count(page, "before", [255, 255, 255])) > 10000);
  }));

test("fits a phone", () =>
  on("compare.html", PHONE, async (page) => {
    const { wide, window } = await page.evaluate(() => ({ wide: document.documentElement.scrollWidth, window: innerWidth }));
    assert.ok(wide <= window, `${wide} of ${window}`);
    const boxes = await Promise.all(["#before", "#after"].map((id) => page.locator(id).boundingBox()));
    assert.ok(boxes[1].y > boxes[0].y + boxes[0].height && boxes[0].width > 340);
    assert.deepEqual(boxes[0].height, boxes[1].height);
    for (const id of ["#play", "#previous", "#next", "#theme", "#strategy"]) {
      assert.ok((await page.locator(id).boundingBox()).height >= 34, id);
    }
    await page.locator("#next").tap();
    await shoot(page, "phone.png");
  }));

test("another strategy is shown by the list and by its row", () =>
  on("compare.html", DESK, async (page) => {
    assert.match(await text(page, "#after-name"), /^After, ni2opt/);
    const travel = await text(page, "#headline .card:first-child");
    await page.locator("#strategy").selectOption({ label: "greedy" });
    await settled(page);
    assert.match(await text(page, "#after-name"), /^After, greedy/);
    assert.notEqual(await text(page, "#headline .card:first-child"), travel);
    await page.locator("#strategies tr", { hasText: "ni2opt" }).click();
    assert.match(await text(page, "#after-name"), /^After, ni2opt/);
    assert.equal(await text(page, "#headline .card:first-child"), travel);
    await shoot(page, "compare.png");
  }));

test("the chart leads to a layer, wheel and dragging move the view", () =>
  on("compare.html", DESK, async (page) => {
    const chart = await page.locator("#chart .u-over").boundingBox();
    await goesTo(page, 4, () => page.mouse.click(chart.x + chart.width - 2, chart.y + 20));
    const canvas = await page.locator("#before").boundingBox();
    const [x, y] = [canvas.x + canvas.width / 2, canvas.y + canvas.height / 2];
    const home = await pixels(page, "after");
    await page.mouse.move(x, y);
    await page.mouse.wheel(0, -400);
    await settled(page);
    const zoomed = await pixels(page, "after");
    await page.mouse.down();
    await page.mouse.move(x + 60, y + 20);
    await page.mouse.up();
    await settled(page);
    const moved = await pixels(page, "after");
    assert.ok(zoomed !== home && moved !== zoomed);
    await page.mouse.dblclick(x, y);
    await settled(page);
    assert.equal(await pixels(page, "after"), home);
  }));

test("names of files are text", () =>
  on("hostile.html", DESK, async (page) => {
    const name = "<img src=x onerror=document.title='broken'>.damat";
    assert.equal(await text(page, "h1"), name);
    assert.equal(await page.title(), `${name} · Traverse`);
    assert.equal(await page.locator("img").count(), 0);
  }));

test("from a web server it asks for nothing but itself", async () => {
  const asked = [];
  const server = createServer((request, response) => {
    asked.push(request.url);
    response.setHeader("content-type", "text/html");
    response.end(readFileSync(join(REPORTS, "compare.html")));
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const context = await browser.newContext(DESK);
  try {
    const page = await context.newPage();
    page.setDefaultTimeout(90000); // of a busy machine
    await page.goto(`http://127.0.0.1:${server.address().port}/report`);
    await page.waitForSelector("html[data-layer]", { state: "attached" });
    await page.waitForTimeout(300);
    assert.deepEqual(asked, ["/report"]);
  } finally {
    await context.close();
    server.close();
  }
});

test("a layer that has come by half is waited for", async () => {
  const page_text = readFileSync(join(REPORTS, "compare.html"), "utf8");
  const first = page_text.indexOf('<script id="layer-');
  const middle = (page_text.indexOf(">", first) + page_text.indexOf("</script>", first)) >> 1;
  const server = createServer((request, response) => {
    response.setHeader("content-type", "text/html; charset=utf-8");
    // The parser shows the text of an element in pieces of 64 kB; blanks are nothing to the page.
    response.write(page_text.slice(0, middle) + " ".repeat(300000));
    setTimeout(() => response.end(page_text.slice(middle)), 700);
  });
  await new Promise((listening) => server.listen(0, "127.0.0.1", listening));
  const context = await browser.newContext(DESK);
  try {
    const page = await context.newPage();
    page.setDefaultTimeout(90000); // of a busy machine
    const errors = [];
    page.on("pageerror", (error) => errors.push(error.stack));
    await page.goto(`http://127.0.0.1:${server.address().port}/`);
    await page.waitForSelector("html[data-layer]", { state: "attached" });
    assert.deepEqual(errors, []);
  } finally {
    await context.close();
    server.close();
  }
});

// The page's own reader, without a browser: the moves are as long as the figures say.
test("each layer's moves add up to its figures", async () => {
  const { readScene, readLayer } = await import("./src/scene.js");
  const { movesOf } = await import("./src/moves.js");
  for (const name of ["compare.html", "gcode.html"]) {
    const html = readFileSync(join(REPORTS, name), "utf8");
    const contents = new Map(Array.from(html.matchAll(/<script id="([^"]+)"[^>]*>([^<]*)</g), (m) => [m[1], m[2]]));
    globalThis.document = {
      readyState: "complete",
      getElementById: (id) => ({ textContent: contents.get(id) }),
    };
    const scene = readScene();
    for (let i = 0; i <= scene.last; ++i) {
      const layer = await readLayer(scene, i);
      layer.routes.forEach((route, r) => {
        let steps = 0;
        for (const way of movesOf(route)) {
          for (let k = 2; k < way.length; k += 2) steps += Math.hypot(way[k] - way[k - 2], way[k + 1] - way[k - 1]);
        }
        const travel = scene.routes[r].layers.travel[i];
        assert.ok(Math.abs(steps * scene.grid - travel) <= 0.01 * travel + 0.5, `${name}, layer ${i}, route ${r}: ${steps * scene.grid} of ${travel}`);
      });
    }
  }
});

// Seconds until a page is on view, the least of three, as others use the machine too.
async function secondsToView(name, then) {
  const seconds = [];
  for (let i = 0; i < 3; ++i) {
    const context = await browser.newContext(DESK);
    const page = await context.newPage();
    page.setDefaultTimeout(90000); // of a busy machine
    const began = performance.now();
    await page.goto(pathToFileURL(join(REPORTS, name)).href);
    await page.waitForSelector("html[data-layer]", { state: "attached" });
    seconds.push((performance.now() - began) / 1000);
    if (i === 2 && then) await then(page);
    await context.close();
  }
  return Math.min(...seconds);
}

test("200 layers of 1,000 paths are on view soon and take less than 30 bytes a path", async () => {
  const bytes = statSync(join(REPORTS, "large.html")).size;
  const few = await secondsToView("compare.html");
  const many = await secondsToView("large.html", async (page) => {
    await page.waitForLoadState();
    await goesTo(page, 199, () => page.keyboard.press("End"));
    assert.match(await text(page, "#subtitle"), /^200 layers, 200,000 paths$/);
    await shoot(page, "large.png");
  });
  console.log(`${bytes} bytes; on view after ${few.toFixed(2)} s with 5 layers, ${many.toFixed(2)} with 200`);
  assert.ok(bytes < 30 * 200_000);
  assert.ok(many < 8 * few);
});
