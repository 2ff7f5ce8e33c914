// The gateway's page as somebody uses it. Arguments: the browser, the address, a sliced file, the file that the command
// makes of it, a folder for screenshots.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { chromium } from "playwright-core";

const [executablePath, address, part, expected, shots] = process.argv.slice(2);
const browser = await chromium.launch({
  executablePath,
  args: ["--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking",
         "--disable-component-update", "--disable-sync"],
});

async function open(options) {
  const page = await browser.newPage(options);
  const faults = [], asked = [];
  page.on("pageerror", (error) => faults.push(String(error)));
  page.on("console", (message) => message.type() === "error" && faults.push(message.text()));
  page.on("request", (request) => asked.push(request.url()));
  await page.goto(address);
  return { page, faults, asked };
}

async function tryDesktop() {
  const { page, faults, asked } = await open({ viewport: { width: 1100, height: 900 }, colorScheme: "light" });
  assert.equal(await page.locator("#go").isDisabled(), true);
  await page.setInputFiles("#file", part);
  assert.match(await page.locator("#chosen").textContent(), /part\.gcode, \d+ kB/);
  // By keyboard alone from here on.
  await page.locator("input[value=safe]").focus();
  await page.keyboard.press("ArrowDown");
  assert.equal(await page.locator("input[value=balanced]").isChecked(), true);
  await page.locator("#go").focus();
  await page.keyboard.press("Enter");
  await page.locator("#result").waitFor({ state: "visible", timeout: 120000 });
  assert.match(await page.locator("#saved").textContent(), /Travel -\d/);
  assert.equal(await page.evaluate(() => document.activeElement.id), "saved");
  assert.equal(await page.locator("#figures tr").count(), 4);
  assert.equal(await page.locator("#stop").isVisible(), false);
  const [download] = await Promise.all([page.waitForEvent("download"), page.locator("#take").click()]);
  assert.equal(download.suggestedFilename(), "part.gcode");
  assert.deepEqual(readFileSync(await download.path()), readFileSync(expected));
  await page.screenshot({ path: `${shots}/desktop.png`, fullPage: true });
  await page.locator("#show").click();
  const report = page.frameLocator("#report");
  await report.locator("canvas").first().waitFor({ timeout: 30000 });
  await page.screenshot({ path: `${shots}/report.png` });
  assert.deepEqual(faults, []);
  for (const url of asked) assert.ok(url.startsWith(address) || /^(blob|data):/.test(url), url);
  await page.close();
}

async function tryPhone() {
  const { page, faults } = await open({ viewport: { width: 360, height: 740 }, colorScheme: "dark", hasTouch: true });
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 360, `wider than the phone: ${wide}`);
  await page.setInputFiles("#file", { name: "x.gcode", mimeType: "text/plain", buffer: Buffer.from("nothing of a slicer\n") });
  await page.locator("#go").tap();
  await page.locator("#problem:not(:empty)").waitFor({ timeout: 60000 });
  assert.match(await page.locator("#problem").textContent(), /x\.gcode/);
  await page.screenshot({ path: `${shots}/phone.png`, fullPage: true });
  assert.equal(await page.locator("#go").isEnabled(), true);
  assert.deepEqual(faults, []);
  await page.close();
}

async function tryDrop() {
  const { page } = await open({ viewport: { width: 800, height: 600 } });
  await page.evaluate(() => {
    const data = new DataTransfer();
    data.items.add(new File(["G1 X1"], "a.gcode"));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  });
  assert.match(await page.locator("#chosen").textContent(), /a\.gcode/);
  await page.evaluate(() => {
    const data = new DataTransfer();
    for (const name of ["a.gcode", "b.gcode"]) data.items.add(new File(["G1 X1"], name));
    document.dispatchEvent(new DragEvent("drop", { dataTransfer: data, bubbles: true, cancelable: true }));
  });
  assert.match(await page.locator("#problem").textContent(), /One file/);
  await page.close();
}

try {
  await tryDesktop();
  await tryPhone();
  await tryDrop();
} finally {
  await browser.close();
}
