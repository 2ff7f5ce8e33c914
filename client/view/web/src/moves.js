// What is made of a route: its moves, those that vanished, and the way of the head from start to end.

function hasLength(way) {
  for (let i = 2; i < way.length; i += 2) {
    if (way[i] !== way[0] || way[i + 1] !== way[1]) return true;
  }
  return false;
}

// All of them, or those of one form.
export function movesOf(route, form) {
  return route.visits.filter((visit) => form === undefined || visit.form === form).map((visit) => visit.way)
    .filter(hasLength);
}

// The forms that moves of a layer have.
export function formsOf(layer) {
  return [...new Set(layer.routes.flatMap((route) => route.visits.map((visit) => visit.form)))].sort();
}

// The ends of a move, the same for both directions.
function endsOf(way) {
  const a = `${way[0]},${way[1]}`;
  const b = `${way[way.length - 2]},${way[way.length - 1]}`;
  return a < b ? `${a} ${b}` : `${b} ${a}`;
}

export function vanished(before, after) {
  const kept = new Map();
  for (const way of movesOf(after)) kept.set(endsOf(way), (kept.get(endsOf(way)) ?? 0) + 1);
  return movesOf(before).filter((way) => {
    const left = kept.get(endsOf(way)) ?? 0;
    kept.set(endsOf(way), left - 1);
    return left <= 0;
  });
}

// The points of a path in the order of the visit, from its entry to its exit.
function pathOf(path, entry) {
  const { closed, points } = path;
  const n = points.length / 2;
  const out = [];
  const steps = closed ? n + 1 : n;
  for (let k = 0; k < steps; ++k) {
    const j = closed ? (entry + k) % n : entry === 0 ? k : n - 1 - k;
    out.push(points[2 * j], points[2 * j + 1]);
  }
  return out;
}

// The whole way of the head: pieces { points, feature (-1 - form: travel), from, to }, lengths along it.
export function wayOf(layer, route) {
  const pieces = [];
  let length = 0;
  const add = (points, feature) => {
    const from = length;
    for (let i = 2; i < points.length; i += 2) {
      length += Math.hypot(points[i] - points[i - 2], points[i + 1] - points[i - 1]);
    }
    pieces.push({ points, feature, from, to: length });
  };
  for (const visit of route.visits) {
    add(visit.way, -1 - visit.form);
    add(pathOf(layer.paths[visit.path], visit.entry), layer.paths[visit.path].feature);
  }
  return { pieces, length };
}

// The part of `points` up to `length` along it.
export function beginning(points, length) {
  const out = [points[0], points[1]];
  for (let i = 2; i < points.length && length > 0; i += 2) {
    const dx = points[i] - points[i - 2];
    const dy = points[i + 1] - points[i - 1];
    const step = Math.hypot(dx, dy);
    const share = step > length ? length / step : 1;
    out.push(points[i - 2] + dx * share, points[i - 1] + dy * share);
    length -= step;
  }
  return out;
}
