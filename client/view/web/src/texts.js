// The words around the pictures: headline, table, legend. Text goes in as text, never as markup.

import * as format from "./format.js";
import { formsOf } from "./moves.js";
import { inkOf } from "./panel.js";
import { FORMS } from "./scene.js";

export function element(name, text, className) {
  const made = document.createElement(name);
  if (text !== undefined) made.textContent = text;
  if (className) made.className = className;
  return made;
}

const capital = (text) => text[0].toUpperCase() + text.slice(1);

function card(name, value, from, tone) {
  const made = element("div", undefined, "card");
  made.append(element("div", name, "name"), element("div", value, `value ${tone}`), element("div", from, "from"));
  return made;
}

function changeCard(name, before, after, words) {
  const saved = format.gain(before, after);
  const tone = saved >= 0.05 ? "good" : saved <= -0.05 ? "bad" : "";
  return card(name, format.change(before, after), `${words(before)} → ${words(after)}`, tone);
}

export function headline(scene, shown) {
  const before = scene.routes[0];
  const after = scene.routes[shown];
  const cards = [
    changeCard("Travel", before.travel, after.travel, format.length),
    changeCard(capital(scene.seconds), before.seconds, after.seconds, format.duration),
  ];
  if (before.retractions !== null && after.retractions !== null) {
    const made = changeCard("Retractions", before.retractions, after.retractions, String);
    if (before.hidden !== null && after.hidden !== null) {
      made.append(element("div", `where nobody would see: ${before.hidden} → ${after.hidden}`, "from"));
    }
    cards.push(made);
  }
  if (before.crossings !== null && after.crossings !== null) {
    cards.push(changeCard("Visible walls crossed", before.crossings, after.crossings, String));
  }
  if (after.gap !== null) {
    const proven = after.gap < 0.0005;
    cards.push(card("Gap to the optimum", proven ? "0 %" : `≤ ${format.percent(after.gap)}`,
      proven ? "proven optimal" : "to a proven lower bound", proven ? "good" : ""));
  }
  document.getElementById("headline").replaceChildren(...cards);
}

export function caption(name, route, layer, before) {
  const travel = route.layers.travel[layer];
  let text = `${name}: ${format.length(travel)}`;
  if (before) text += ` (${format.change(before.layers.travel[layer], travel)})`;
  if (route.layers.retractions) text += `, ${format.retractions(route.layers.retractions[layer])}`;
  if (route.layers.crossings) text += `, ${format.crossings(route.layers.crossings[layer])}`;
  return text;
}

// One row a route; a click on one shows it.
export function strategyTable(scene, shown, onPick) {
  const retractions = scene.routes.every((route) => route.retractions !== null);
  const crossings = scene.routes.every((route) => route.crossings !== null);
  const gaps = scene.routes.some((route) => route.gap !== null);
  const head = ["route", "travel", "saved", scene.seconds];
  if (retractions) head.push("retractions");
  if (crossings) head.push("walls crossed");
  if (gaps) head.push("gap");
  head.push("computed in");
  const header = element("tr");
  for (const name of head) header.append(element("th", name));
  const rows = scene.routes.map((route, i) => {
    const row = element("tr", undefined, i === shown ? "shown" : "");
    const saved = format.gain(scene.routes[0].travel, route.travel);
    const gain = element("td", `${saved.toFixed(1)} %`, "gain");
    const bar = element("span");
    bar.style.width = `${Math.max(0, saved)}%`;
    const room = element("span", undefined, "bar-room");
    room.append(bar);
    gain.append(room);
    row.append(element("td", route.label), element("td", format.length(route.travel)), gain,
      element("td", format.duration(route.seconds)));
    if (retractions) row.append(element("td", String(route.retractions)));
    if (crossings) row.append(element("td", String(route.crossings)));
    if (gaps) row.append(element("td", route.gap === null ? "" : format.percent(route.gap)));
    row.append(element("td", i === 0 ? "" : `${route.compute.toFixed(2)} s`));
    if (i > 0) {
      row.dataset.route = i;
      row.addEventListener("click", () => onPick(i));
    }
    return row;
  });
  document.getElementById("strategies").replaceChildren(header, ...rows);
}

export function legend(scene, layer, theme) {
  const ink = inkOf(theme);
  const item = (name, color, shape) => {
    const made = element("li");
    const mark = element("i", undefined, shape);
    mark.style[shape === "disc" || shape === "square" ? "background" : "borderColor"] = color;
    made.append(mark, name);
    return made;
  };
  const used = [...new Set(layer.paths.map((path) => path.feature))].sort((a, b) => a - b);
  document.getElementById("legend").replaceChildren(
    ...formsOf(layer).map((form) => item(FORMS[form] === "travel" ? "travel" : `${FORMS[form]} travel`, ink[FORMS[form]])),
    item("removed", ink.travel, "faded"), item("start", ink.start, "disc"),
    item("end", ink.end, "square"),
    ...used.map((feature) => item(scene.features[feature].name, scene.features[feature][theme])));
}
