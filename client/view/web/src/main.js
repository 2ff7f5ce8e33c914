// The page: what is on view, and what the user does to it.

import { Chart } from "./chart.js";
import { listen } from "./gestures.js";
import * as format from "./format.js";
import { vanished, wayOf } from "./moves.js";
import { boxOf, Panel } from "./panel.js";
import { readLayer, readScene } from "./scene.js";
import { caption, element, headline, legend, strategyTable } from "./texts.js";

const PLAY_SECONDS = 12; // for the longer of the two ways, at speed 1
const get = (id) => document.getElementById(id);

const scene = readScene();
const panels = [new Panel(get("before")), new Panel(get("after"))];
const state = { index: -1, layer: null, shown: scene.shown, theme: "light", view: null, play: null };
const chart = new Chart(get("chart"), scene, (i) => showLayer(i));

// --- drawing ---

let pending = false;
function redraw() {
  if (pending) return;
  pending = true;
  requestAnimationFrame(() => {
    pending = false;
    if (!state.layer) return;
    const look = {
      theme: state.theme,
      colors: scene.features.map((feature) => feature[state.theme]),
      paths: get("show-paths").checked,
      gone: get("show-gone").checked,
    };
    panels.forEach((panel, i) => panel.draw(state.view, look, state.play && state.play.heads[i]));
  });
}

// Both panels get the height that the layer needs at their width, and one scale.
function fit(keepView) {
  if (!state.layer) return;
  const [x0, y0, x1, y1] = boxOf(state.layer);
  const margin = 14;
  const width = Math.max(panels[0].canvas.clientWidth - 2 * margin, 50);
  const share = (y1 - y0) / Math.max(x1 - x0, 1);
  const height = Math.min(Math.max(width * share, 0.35 * width), Math.max(0.66 * window.innerHeight, 240));
  for (const panel of panels) panel.resize(height + 2 * margin);
  if (!keepView || !state.view) {
    const scale = Math.min(width / Math.max(x1 - x0, 1), height / Math.max(y1 - y0, 1));
    state.view = { scale, home: scale, x: (x0 + x1) / 2, y: (y0 + y1) / 2 };
  }
  redraw();
}

function zoomAt([px, py], factor) {
  const { view } = state;
  const scale = Math.min(Math.max(view.scale * factor, view.home / 4), view.home * 400);
  view.x += px / view.scale - px / scale;
  view.y -= py / view.scale - py / scale;
  view.scale = scale;
  redraw();
}

function moveBy(dx, dy) {
  state.view.x -= dx / state.view.scale;
  state.view.y += dy / state.view.scale;
  redraw();
}

// --- what is on view ---

function showRoute() {
  const [before, after] = [state.layer.routes[0], state.layer.routes[state.shown]];
  panels[0].set(state.layer, before, []);
  panels[1].set(state.layer, after, vanished(before, after));
  const captions = [
    caption("Before", scene.routes[0], state.index),
    caption(`After, ${scene.routes[state.shown].label}`, scene.routes[state.shown], state.index, scene.routes[0]),
  ];
  ["before", "after"].forEach((name, i) => {
    get(`${name}-name`).textContent = captions[i];
    get(name).setAttribute("aria-label", `Layer ${scene.first + state.index + 1}. ${captions[i]}`);
  });
  legend(scene, state.layer, state.theme);
}

async function showLayer(index) {
  index = Math.min(Math.max(index, 0), scene.last);
  if (index === state.index) return;
  state.index = index;
  get("layer").value = scene.first + index + 1;
  const z = scene.layers.z[index];
  get("layer-name").textContent =
    `Layer ${scene.first + index + 1} of ${scene.first + scene.last + 1}` + (z ? `, z ${z.toFixed(2)} mm` : "");
  chart.show(index);
  const layer = await readLayer(scene, index);
  if (state.index !== index) return; // the user was quicker
  stop();
  state.layer = layer;
  showRoute();
  fit(false);
  document.documentElement.dataset.layer = index;
}

function pickRoute(shown) {
  state.shown = chart.shown = Number(shown);
  get("strategy").value = state.shown;
  headline(scene, state.shown);
  strategyTable(scene, state.shown, pickRoute);
  chart.build(state.theme);
  if (!state.layer) return;
  stop();
  showRoute();
  redraw();
}

function setTheme(theme) {
  state.theme = theme;
  document.documentElement.dataset.theme = theme;
  chart.build(theme);
  if (state.layer) legend(scene, state.layer, theme);
  redraw();
}

// --- playing ---

function stop() {
  state.play = null;
  get("play").textContent = "▶ Play";
  get("speed-name").textContent = "";
  delete document.documentElement.dataset.playing;
  redraw();
}

function pause(paused) {
  state.play.paused = paused;
  get("play").textContent = paused ? "▶ Play" : "❚❚ Pause";
  document.documentElement.dataset.playing = paused ? "paused" : "running";
  if (!paused) requestAnimationFrame(step);
}

function step(now) {
  const { play } = state;
  if (!play || play.paused) return;
  const speed = (play.longest / PLAY_SECONDS) * Number(get("speed").value);
  if (play.last !== null) {
    for (const head of play.heads) head.length = Math.min(head.length + (speed * (now - play.last)) / 1000, head.way.length);
  }
  play.last = now;
  get("speed-name").textContent = `head at ${Math.round(speed * scene.grid)} mm/s`;
  redraw();
  if (play.heads.every((head) => head.length >= head.way.length)) stop();
  else requestAnimationFrame(step);
}

function togglePlay() {
  if (!state.layer) return;
  if (state.play) {
    state.play.last = null;
    pause(!state.play.paused);
    return;
  }
  const heads = [state.layer.routes[0], state.layer.routes[state.shown]].map((route) => ({
    way: wayOf(state.layer, route), length: 0, at: route.start,
  }));
  state.play = { heads, longest: Math.max(...heads.map((head) => head.way.length)), last: null, paused: false };
  pause(false);
}

// --- wiring ---

function onKey(event) {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const inField = event.target.matches("select, input[type=range]");
  const onControl = event.target.matches("button, select, input");
  const middle = [0, 0];
  const actions = {
    ArrowLeft: () => !inField && showLayer(state.index - 1),
    ArrowRight: () => !inField && showLayer(state.index + 1),
    Home: () => !inField && showLayer(0),
    End: () => !inField && showLayer(scene.last),
    " ": () => !onControl && (togglePlay(), true),
    "+": () => zoomAt(middle, 1.3),
    "=": () => zoomAt(middle, 1.3),
    "-": () => zoomAt(middle, 1 / 1.3),
    0: () => fit(false),
    t: () => setTheme(state.theme === "dark" ? "light" : "dark"),
  };
  const action = actions[event.key];
  if (action && action() !== false) event.preventDefault();
}

function wire() {
  get("layer").addEventListener("input", (event) => showLayer(Number(event.target.value) - scene.first - 1));
  get("previous").addEventListener("click", () => showLayer(state.index - 1));
  get("next").addEventListener("click", () => showLayer(state.index + 1));
  get("play").addEventListener("click", togglePlay);
  get("theme").addEventListener("click", () => setTheme(state.theme === "dark" ? "light" : "dark"));
  get("strategy").addEventListener("change", (event) => pickRoute(event.target.value));
  for (const id of ["show-paths", "show-gone"]) get(id).addEventListener("change", redraw);
  for (const panel of panels) listen(panel.canvas, zoomAt, moveBy, () => fit(false));
  document.addEventListener("keydown", onKey);
  window.addEventListener("resize", () => { fit(false); chart.resize(); });
  const dark = window.matchMedia("(prefers-color-scheme: dark)");
  dark.addEventListener("change", () => setTheme(dark.matches ? "dark" : "light"));
  return dark.matches ? "dark" : "light";
}

function open() {
  document.title = `${scene.title} · Traverse`;
  get("title").textContent = scene.title;
  const layers = scene.last + 1;
  get("subtitle").textContent =
    `${layers} ${layers === 1 ? "layer" : "layers"}, ${scene.paths.toLocaleString("en")} paths`;
  get("footer").textContent = `${scene.made}. ${scene.moves}`;
  const slider = get("layer");
  slider.min = scene.first + 1;
  slider.max = scene.first + scene.last + 1;
  scene.routes.forEach((route, i) => {
    if (i === 0) return;
    const option = element("option", route.label);
    option.value = i;
    get("strategy").append(option);
  });
  get("strategy").value = state.shown;
  get("strategy-label").hidden = scene.routes.length < 3;
  get("table-name").textContent = scene.routes.length < 3 ? "Figures" : "Strategies";
  headline(scene, state.shown);
  strategyTable(scene, state.shown, pickRoute);
  setTheme(wire());
  showLayer(scene.open);
}

open();
