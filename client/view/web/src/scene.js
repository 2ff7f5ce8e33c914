// The data of the page, as client/view/report_page.h and layer_code.h describe it.

import { unzlibSync } from "fflate";

export function readScene() {
  const scene = JSON.parse(document.getElementById("scene").textContent);
  scene.last = scene.layers.id.length - 1;
  return scene;
}

// Layers come behind the script: the page is there before they are.
async function codedLayer(i) {
  for (;;) {
    const done = document.readyState !== "loading";
    const element = document.getElementById(`layer-${i}`);
    // What stands behind it shows that it is there to its end; the parser fills it piece by piece.
    if (element && (done || element.nextSibling)) return element.textContent;
    if (done) throw new Error(`layer ${i} is missing: is the file cut short?`);
    await new Promise((resume) => setTimeout(resume, 15));
  }
}

function inflate(base64) {
  const text = atob(base64);
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return unzlibSync(bytes);
}

// Whole numbers in groups of seven bits, the lowest first; signed ones fold their sign into the lowest bit.
class Numbers {
  constructor(bytes) {
    this.bytes = bytes;
    this.at = 0;
  }
  next() {
    let value = 0;
    for (let scale = 1; ; scale *= 128) {
      const byte = this.bytes[this.at++];
      value += (byte & 127) * scale;
      if (byte < 128) return value;
    }
  }
  nextSigned() {
    const value = this.next();
    return value % 2 === 0 ? value / 2 : -(value + 1) / 2;
  }
}

function readPaths(numbers) {
  const paths = new Array(numbers.next());
  let x = 0;
  let y = 0;
  for (let i = 0; i < paths.length; ++i) {
    const kind = numbers.next();
    const points = new Float64Array(2 * numbers.next());
    let dx = 0;
    let dy = 0;
    for (let j = 0; j < points.length; j += 2) {
      // From the third point on the difference is to where the path would come going on as it came.
      if (j <= 2) dx = dy = 0;
      points[j] = x += dx += numbers.nextSigned();
      points[j + 1] = y += dy += numbers.nextSigned();
    }
    paths[i] = { feature: Math.floor(kind / 2), closed: kind % 2 === 1, points };
  }
  return paths;
}

// What travel does; the pictures of the command line have the same colors (palette.h).
export const FORMS = ["travel", "retracted", "open", "hidden"];

// Visits with the whole way there: [exit of the one before, corners, entry], what it does (an index into FORMS), and
// where the path is begun.
function readRoute(numbers, paths) {
  let x = numbers.nextSigned();
  let y = numbers.nextSigned();
  const route = { start: [x, y], visits: new Array(paths.length) };
  let next = 0;
  for (let i = 0; i < paths.length; ++i) {
    const index = next + numbers.nextSigned();
    const token = numbers.next();
    const entry = Math.floor(token / 8);
    const form = Math.floor(token / 2) % 4;
    const way = [x, y];
    if (token % 2 === 1) {
      for (let corners = numbers.next(); corners > 0; --corners) {
        way.push((x += numbers.nextSigned()), (y += numbers.nextSigned()));
      }
    }
    const { closed, points } = paths[index];
    const end = points.length - 2;
    const first = closed ? 2 * entry : entry === 0 ? 0 : end;
    const last = closed ? first : end - first;
    way.push(points[first], points[first + 1]);
    route.visits[i] = { path: index, entry, form, way };
    [x, y] = [points[last], points[last + 1]];
    next = index + 1;
  }
  route.end = [x, y];
  return route;
}

// Layer `i` with its paths and routes, all places in steps of scene.grid mm.
export async function readLayer(scene, i) {
  const numbers = new Numbers(inflate(await codedLayer(i)));
  const paths = readPaths(numbers);
  return { paths, routes: scene.routes.map(() => readRoute(numbers, paths)) };
}
