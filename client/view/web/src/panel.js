// One canvas with a layer and a way through it. Both panels share the view: scale and center.

import { beginning, movesOf } from "./moves.js";
import { FORMS } from "./scene.js";

const TRAVEL = {
  light: { travel: "#111827", retracted: "#111827", open: "#dc2626", hidden: "#16a34a" },
  dark: { travel: "#f3f4f6", retracted: "#f3f4f6", open: "#f87171", hidden: "#4ade80" },
};
const INK = {
  light: { ...TRAVEL.light, start: "#15803d", end: "#be123c", ground: "#ffffff", head: "#1d4ed8" },
  dark: { ...TRAVEL.dark, start: "#4ade80", end: "#fb7185", ground: "#0f141b", head: "#7ab0ff" },
};
const FADED = { light: 0.17, dark: 0.32 };
const UNDONE = 0.22;
export const inkOf = (theme) => INK[theme];

function trace(path, points, closed) {
  path.moveTo(points[0], -points[1]);
  for (let i = 2; i < points.length; i += 2) path.lineTo(points[i], -points[i + 1]);
  if (points.length === 2) path.lineTo(points[0], -points[1]); // a dot
  if (closed) path.closePath();
}

// The box of a layer with all its routes, so that every one of them has the same scale.
export function boxOf(layer) {
  const box = [Infinity, Infinity, -Infinity, -Infinity];
  const add = (points) => {
    for (let i = 0; i < points.length; i += 2) {
      box[0] = Math.min(box[0], points[i]);
      box[1] = Math.min(box[1], points[i + 1]);
      box[2] = Math.max(box[2], points[i]);
      box[3] = Math.max(box[3], points[i + 1]);
    }
  };
  for (const path of layer.paths) add(path.points);
  for (const route of layer.routes) {
    add(route.start);
    for (const visit of route.visits) add(visit.way);
  }
  return box[0] <= box[2] ? box : [0, 0, 1, 1];
}

export class Panel {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.layer = null;
  }

  // What there is to draw. `gone` are moves to show faded.
  set(layer, route, gone) {
    this.route = route;
    this.gone = new Path2D();
    for (const way of gone) trace(this.gone, way, false);
    this.moves = FORMS.map((_, form) => {
      const moves = new Path2D();
      for (const way of movesOf(route, form)) trace(moves, way, false);
      return moves;
    });
    if (this.layer === layer) return;
    this.layer = layer;
    this.features = new Map();
    for (const path of layer.paths) {
      if (!this.features.has(path.feature)) this.features.set(path.feature, new Path2D());
      trace(this.features.get(path.feature), path.points, path.closed);
    }
  }

  // The canvas has as many pixels as it takes on the screen.
  resize(height) {
    this.canvas.style.height = `${height}px`;
    const ratio = window.devicePixelRatio || 1;
    const width = this.canvas.clientWidth;
    if (this.canvas.width !== Math.round(width * ratio)) this.canvas.width = Math.round(width * ratio);
    if (this.canvas.height !== Math.round(height * ratio)) this.canvas.height = Math.round(height * ratio);
  }

  // `view`: { scale (pixels a step), x, y (the place in the middle) }. `look`: { theme, colors, paths, gone }.
  // `done`: null, or { way, length } of the head that has come so far.
  draw(view, look, done) {
    const ratio = window.devicePixelRatio || 1;
    const { context, canvas } = this;
    const ink = INK[look.theme];
    const scale = view.scale * ratio;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.fillStyle = ink.ground;
    context.fillRect(0, 0, canvas.width, canvas.height);
    context.setTransform(scale, 0, 0, scale, canvas.width / 2 - view.x * scale, canvas.height / 2 + view.y * scale);
    context.lineCap = context.lineJoin = "round";

    const stroke = (path, color, width, opacity) => {
      context.globalAlpha = opacity;
      context.strokeStyle = color;
      context.lineWidth = width / view.scale;
      context.stroke(path);
    };
    if (look.paths) {
      for (const [feature, path] of this.features) stroke(path, look.colors[feature], 1, done ? UNDONE : 1);
    }
    if (!done) {
      if (look.gone) stroke(this.gone, ink.travel, 1.8, FADED[look.theme]);
      this.moves.forEach((moves, form) => stroke(moves, ink[FORMS[form]], 1.8, 1));
      this.mark(view, this.route.end, ink.end, ink.ground, true);
    } else {
      this.drawDone(view, look, ink, done, stroke);
    }
    this.mark(view, this.route.start, ink.start, ink.ground, false);
    if (done) this.mark(view, done.at, ink.head, ink.ground, false);
    context.globalAlpha = 1;
  }

  drawDone(view, look, ink, done, stroke) {
    const paths = new Map();
    done.at = this.route.start;
    for (const piece of done.way.pieces) {
      if (piece.from > done.length) break;
      const points = piece.to <= done.length ? piece.points : beginning(piece.points, done.length - piece.from);
      if (!paths.has(piece.feature)) paths.set(piece.feature, new Path2D());
      trace(paths.get(piece.feature), points, false);
      done.at = points.slice(-2);
    }
    for (const [feature, path] of paths) {
      if (feature >= 0 && look.paths) stroke(path, look.colors[feature], 1.2, 1);
    }
    for (const [feature, path] of paths) {
      if (feature < 0) stroke(path, ink[FORMS[-1 - feature]], 1.8, 1);
    }
  }

  // A disc, or a square, five pixels from its middle to its rim.
  mark(view, at, color, rim, square) {
    const { context } = this;
    const half = 5 / view.scale;
    context.globalAlpha = 1;
    context.beginPath();
    if (square) context.rect(at[0] - half, -at[1] - half, 2 * half, 2 * half);
    else context.arc(at[0], -at[1], half, 0, 2 * Math.PI);
    context.fillStyle = color;
    context.fill();
    context.strokeStyle = rim;
    context.lineWidth = 1 / view.scale;
    context.stroke();
  }
}
