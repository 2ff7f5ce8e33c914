"""Draws a Grafana dashboard from a Prometheus server, without Grafana: one SVG of all panels.

    picture.draw(dashboard, ask_range, "dashboard.svg")

`ask_range(expression)` gives the series of a range query, as Prometheus answers it. Enough to look at: stat
panels as numbers, time series as lines, heat maps as cells, tables as rows.
"""

from html import escape

UNIT_X, UNIT_Y, PAD = 60, 30, 8
COLORS = ["#3274d9", "#e0752d", "#299c46", "#ba43a9", "#d44a3a", "#65c5db", "#967302", "#806eb7", "#5f6b7a"]


def number(value, unit):
    """A value as Grafana would print it, more or less."""
    if unit == "percentunit":
        return f"{100 * value:.1f} %"
    if unit == "bytes":
        return f"{value / 2 ** 20:.1f} MiB"
    suffix = {"s": " s", "h": " h", "reqps": " req/s", "ops": " ops/s"}.get(unit, "")
    return f"{value:.3g}{suffix}"


def values(series):
    return [(float(at), float(value)) for at, value in series["values"] if value not in ("NaN", "+Inf", "-Inf")]


def legend(target, labels):
    text = target.get("legendFormat") or "value"
    for key, value in labels.items():
        text = text.replace("{{" + key + "}}", value)
    return text


def text(x, y, words, size=11, color="#444", anchor="start", weight="normal"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{color}" text-anchor="{anchor}" '
            f'font-weight="{weight}">{escape(words)}</text>')


def draw_stat(box, unit, found):
    x, y, width, height = box
    for _, series in found[:1]:
        points = values(series)
        if points:
            return [text(x + width / 2, y + height / 2 + 12, number(points[-1][1], unit), 26, "#3274d9", "middle", "bold")]
    return [text(x + width / 2, y + height / 2, "none yet", 14, "#999", "middle")]


def draw_lines(box, unit, found, stacked):
    x, y, width, height = box
    plots = [(legend(target, series["metric"]), values(series)) for target, series in found]
    plots = [(name, points) for name, points in plots if points]
    if not plots:
        return [text(x + width / 2, y + height / 2, "no data", 14, "#999", "middle")]
    if stacked:
        below = {}
        for index, (name, points) in enumerate(plots):
            points = [(at, value + below.get(at, 0)) for at, value in points]
            below.update(points)
            plots[index] = (name, points)
    times = [at for _, points in plots for at, _ in points]
    begin, end = min(times), max(max(times), min(times) + 1)
    top = max(max(value for _, points in plots for _, value in points), 1e-9)
    out = [f'<line x1="{x}" y1="{y + height}" x2="{x + width}" y2="{y + height}" stroke="#ccc"/>',
           text(x, y + 9, number(top, unit), 9, "#999"), text(x, y + height - 2, "0", 9, "#999")]
    for index, (name, points) in enumerate(plots):
        color = COLORS[index % len(COLORS)]
        path = " ".join(f"{x + width * (at - begin) / (end - begin):.1f},{y + height * (1 - value / top):.1f}"
                        for at, value in points)
        out.append(f'<polyline points="{path}" fill="none" stroke="{color}" stroke-width="1.6"/>')
        if index < 6:
            out.append(text(x + 4 + width / 3 * (index % 3), y + height + 13 + 12 * (index // 3), "— " + name[:24], 10, color))
    return out


def draw_heat(box, found):
    x, y, width, height = box
    rows = {float(series["metric"]["le"].replace("+Inf", "inf")): dict(values(series)) for _, series in found}
    edges = sorted(rows)
    cells = {}
    for index, edge in enumerate(edges):
        for at, value in rows[edge].items():
            lower = rows[edges[index - 1]].get(at, 0) if index else 0
            cells[at, index] = max(0.0, value - lower)
    used = [index for (_, index), value in cells.items() if value > 0]
    times = sorted({at for at, _ in cells})
    if not used:
        return [text(x + width / 2, y + height / 2, "no data", 14, "#999", "middle")]
    first, last, most = min(used), max(used), max(cells.values())
    step_x, step_y = width / len(times), height / (last - first + 1)
    out = []
    for (at, index), value in cells.items():
        if value > 0:
            out.append(f'<rect x="{x + step_x * times.index(at):.1f}" y="{y + step_y * (last - index):.1f}" '
                       f'width="{step_x:.1f}" height="{step_y - 1:.1f}" fill="#3274d9" opacity="{0.1 + 0.9 * value / most:.2f}"/>')
    for index in range(first, last + 1):
        out.append(text(x - 2, y + step_y * (last - index + 0.6), f"{edges[index]:g} s", 9, "#999", "end"))
    return out


def draw_table(box, found):
    x, y = box[:2]
    out = []
    for row, (target, series) in enumerate(found):
        labels = " ".join(f"{key}={value}" for key, value in sorted(series["metric"].items()) if key != "__name__")
        out.append(text(x, y + 12 + 14 * row, f'{target["refId"]}: {labels}: {values(series)[-1][1]:.4g}', 11))
    return out


def draw(dashboard, ask_range, path):
    bottom = max(panel["gridPos"]["y"] + panel["gridPos"]["h"] for panel in dashboard["panels"])
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {24 * UNIT_X} {bottom * UNIT_Y}" '
           f'font-family="sans-serif"><rect width="100%" height="100%" fill="#f4f5f5"/>']
    for panel in dashboard["panels"]:
        place = panel["gridPos"]
        x, y = place["x"] * UNIT_X, place["y"] * UNIT_Y
        width, height = place["w"] * UNIT_X, place["h"] * UNIT_Y
        if panel["type"] == "row":
            out.append(text(x + PAD, y + 20, panel["title"], 15, "#222", weight="bold"))
            continue
        out.append(f'<rect x="{x + 3}" y="{y + 3}" width="{width - 6}" height="{height - 6}" fill="#fff" stroke="#ddd"/>')
        out.append(text(x + 12, y + 19, panel["title"], 12, "#222", weight="bold"))
        found = [(target, series) for target in panel["targets"] for series in ask_range(target["expr"])]
        unit = panel["fieldConfig"]["defaults"].get("unit", "none")
        inner = (x + 16, y + 30, width - 32, height - 74)
        if panel["type"] == "stat":
            out += draw_stat((x, y, width, height), unit, found)
        elif panel["type"] == "heatmap":
            out += draw_heat((x + 56, y + 30, width - 72, height - 50), found)
        elif panel["type"] == "table":
            out += draw_table((x + 16, y + 26), found)
        else:
            stacked = panel["fieldConfig"]["defaults"].get("custom", {}).get("stacking", {}).get("mode") == "normal"
            out += draw_lines(inner, unit, found, stacked)
    path.write_text("\n".join(out) + "\n</svg>\n")
