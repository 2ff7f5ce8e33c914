#!/usr/bin/python3
"""Draws the dashboard from a Prometheus server, without Grafana: one SVG of all panels.

    deploy/monitoring/render_dashboard.py --prometheus=http://127.0.0.1:9090 --minutes=15 -o dashboard.svg

For a report, a ticket, or a machine that has no Grafana. Every query of every panel is asked over the range: stat
panels become numbers, time series lines, heat maps cells, tables rows. Needs Python alone.

Exit codes: 0 drawn; 1 Prometheus does not answer, or refuses a query; 2 usage.
"""

import argparse
import json
import math
import pathlib
import sys
import time
import urllib.error
import urllib.parse
import urllib.request
from html import escape

HERE = pathlib.Path(__file__).resolve().parent
# In the source, and as installed.
DASHBOARD = next(path for path in (HERE / "dashboard/traverse.json", HERE / "traverse.json") if path.exists())
UNIT_X, UNIT_Y, PAD = 60, 30, 8
COLORS = ["#3274d9", "#e0752d", "#299c46", "#ba43a9", "#d44a3a", "#65c5db", "#967302", "#806eb7", "#5f6b7a"]
LEGENDS = 6


class Range:
    """The queries of a dashboard over the last `seconds` before `end` (seconds since 1970)."""

    def __init__(self, url, seconds, end=None, rate_interval="1m"):
        self.url, self.seconds, self.end = url.rstrip("/"), seconds, end or time.time()
        self.variables = {"$__rate_interval": rate_interval, "$__range": f"{round(seconds)}s", "$job": ".+", "$instance": ".+"}

    def ask(self, expression):
        """The series of an expression, as Prometheus answers a range query."""
        for name, value in self.variables.items():
            expression = expression.replace(name, value)
        words = urllib.parse.urlencode({"query": expression, "start": self.end - self.seconds, "end": self.end,
                                        "step": max(1, round(self.seconds / 120))})
        with urllib.request.urlopen(f"{self.url}/api/v1/query_range?{words}", timeout=30) as answer:
            return json.load(answer)["data"]["result"]


def number(value, unit):
    """A value as Grafana would print it, more or less."""
    if unit == "percentunit":
        return f"{100 * value:.3g} %"
    if unit == "bytes":
        return f"{value / 2 ** 20:.1f} MiB"
    suffix = {"s": " s", "h": " h", "reqps": " req/s", "ops": " ops/s"}.get(unit, "")
    return f"{value:.3g}{suffix}"


def values(series):
    return [(float(at), float(value)) for at, value in series["values"] if value not in ("NaN", "+Inf", "-Inf")]


def legend(target, labels):
    words = target.get("legendFormat") or "value"
    for key, value in labels.items():
        words = words.replace("{{" + key + "}}", value)
    return words


def text(x, y, words, size=11, color="#444", anchor="start", weight="normal"):
    return (f'<text x="{x:.1f}" y="{y:.1f}" font-size="{size}" fill="{color}" text-anchor="{anchor}" '
            f'font-weight="{weight}">{escape(words)}</text>')


def nothing(box, words="no data"):
    x, y, width, height = box
    return [text(x + width / 2, y + height / 2, words, 14, "#999", "middle")]


def draw_stat(box, unit, found):
    x, y, width, height = box
    for _, series in found[:1]:
        points = values(series)
        if points:
            return [text(x + width / 2, y + height / 2 + 12, number(points[-1][1], unit), 26, "#3274d9", "middle", "bold")]
    return nothing(box, "none yet")


def round_up(value):
    """The next of 1, 2, 2.5, 5 and 10 times a power of ten: a top of an axis that reads well."""
    if value <= 0:
        return 1.0
    power = 10 ** math.floor(math.log10(value))
    return next(step * power for step in (1, 2, 2.5, 5, 10) if step * power >= value * 0.9999)


def stack(plots):
    """Each plot on top of those before it; returns (name, points, the points below)."""
    out, below = [], {}
    for name, points in plots:
        base = [(at, below.get(at, 0.0)) for at, _ in points]
        points = [(at, value + below.get(at, 0.0)) for at, value in points]
        below.update(points)
        out.append((name, points, base))
    return out


def draw_axes(box, unit, top, begin, end):
    x, y, width, height = box
    out = []
    for part in (0, 0.5, 1):
        level = y + height * (1 - part)
        out += [f'<line x1="{x}" y1="{level:.1f}" x2="{x + width}" y2="{level:.1f}" stroke="#e4e4e4"/>',
                text(x - 4, level + 3, number(top * part, unit) if part else "0", 9, "#999", "end")]
    for at, anchor in ((begin, "start"), (end, "end")):
        clock = time.strftime("%H:%M:%S", time.gmtime(at))
        out.append(text(x if at == begin else x + width, y + height + 11, clock, 9, "#999", anchor))
    return out


def draw_lines(box, unit, found, stacked):
    x, y, width, height = box
    plots = [(legend(target, series["metric"]), values(series)) for target, series in found]
    plots = [(name, points) for name, points in plots if points]
    if not plots:
        return nothing(box)
    plots = stack(plots) if stacked else [(name, points, None) for name, points in plots]
    times = [at for _, points, _ in plots for at, _ in points]
    begin, end = min(times), max(max(times), min(times) + 1)
    top = round_up(max(value for _, points, _ in plots for _, value in points))

    def path(points):
        return [f"{x + width * (at - begin) / (end - begin):.1f},{y + height * (1 - value / top):.1f}" for at, value in points]

    out = draw_axes(box, unit, top, begin, end)
    for index, (name, points, base) in enumerate(plots):
        color = COLORS[index % len(COLORS)]
        if base:
            area = " ".join(path(points) + path(base)[::-1])
            out.append(f'<polygon points="{area}" fill="{color}" opacity="0.25"/>')
        out.append(f'<polyline points="{" ".join(path(points))}" fill="none" stroke="{color}" stroke-width="1.6"/>')
        if index < LEGENDS:
            out.append(text(x + width / 3 * (index % 3), y + height + 24 + 12 * (index // 3), "— " + name[:20], 10, color))
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
    if not used:
        return nothing(box)
    columns = {at: column for column, at in enumerate(sorted({at for at, _ in cells}))}
    first, last, most = min(used), max(used), max(cells.values())
    step_x, step_y = width / len(columns), height / (last - first + 1)
    out = []
    for (at, index), value in cells.items():
        if value > 0:
            out.append(f'<rect x="{x + step_x * columns[at]:.1f}" y="{y + step_y * (last - index):.1f}" '
                       f'width="{step_x:.1f}" height="{step_y - 1:.1f}" fill="#3274d9" opacity="{0.1 + 0.9 * value / most:.2f}"/>')
    for index in range(first, last + 1):
        out.append(text(x - 4, y + step_y * (last - index + 0.6), f"{edges[index]:g} s", 9, "#999", "end"))
    return out


def column_names(panel):
    """What the panel calls its queries: its transformations rename "Value #A" and so on."""
    names = {}
    for transformation in panel.get("transformations", []):
        names.update(transformation["options"].get("renameByName", {}))
    return {key.removeprefix("Value #"): name for key, name in names.items()}


def draw_table(box, found, names):
    """A row for each set of labels, with the figure of each query."""
    x, y = box[:2]
    rows = {}
    for target, series in found:
        labels = tuple(sorted((key, value) for key, value in series["metric"].items() if key != "__name__"))
        rows.setdefault(labels, {})[target["refId"]] = values(series)[-1][1]
    out = []
    for row, (labels, cells) in enumerate(sorted(rows.items())):
        words = ", ".join(f"{key} {value}" for key, value in labels)
        figures = ", ".join(f"{names.get(query, query)} {value:.3g}" for query, value in sorted(cells.items()))
        out += [text(x, y + 14 + 15 * row, words, 11), text(x + 620, y + 14 + 15 * row, figures, 11)]
    return out


def draw_panel(panel, ask):
    place = panel["gridPos"]
    x, y = place["x"] * UNIT_X, place["y"] * UNIT_Y
    width, height = place["w"] * UNIT_X, place["h"] * UNIT_Y
    if panel["type"] == "row":
        return [text(x + PAD, y + 20, panel["title"], 15, "#222", weight="bold")]
    out = [f'<rect x="{x + 3}" y="{y + 3}" width="{width - 6}" height="{height - 6}" fill="#fff" stroke="#ddd"/>',
           text(x + 12, y + 19, panel["title"], 12, "#222", weight="bold")]
    found = [(target, series) for target in panel["targets"] for series in ask(target["expr"])]
    options = panel["fieldConfig"]["defaults"]
    unit = options.get("unit", "none")
    if panel["type"] == "stat":
        return out + draw_stat((x, y, width, height), unit, found)
    if panel["type"] == "heatmap":
        return out + draw_heat((x + 62, y + 30, width - 78, height - 46), found)
    if panel["type"] == "table":
        return out + draw_table((x + 16, y + 26, width, height), found, column_names(panel))
    stacked = options.get("custom", {}).get("stacking", {}).get("mode") == "normal"
    return out + draw_lines((x + 66, y + 32, width - 86, height - 82), unit, found, stacked)


def draw(dashboard, ask):
    """The SVG of a dashboard; `ask(expression)` gives the series of a range query."""
    bottom = max(panel["gridPos"]["y"] + panel["gridPos"]["h"] for panel in dashboard["panels"])
    out = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {24 * UNIT_X} {bottom * UNIT_Y}" '
           f'font-family="sans-serif"><rect width="100%" height="100%" fill="#f4f5f5"/>']
    for panel in dashboard["panels"]:
        out += draw_panel(panel, ask)
    return "\n".join(out) + "\n</svg>\n"


def main():
    parser = argparse.ArgumentParser(description="Draws the dashboard from a Prometheus server, without Grafana.")
    parser.add_argument("--prometheus", default="http://127.0.0.1:9090", help="its address")
    parser.add_argument("--minutes", type=float, default=15, help="the range, up to now")
    parser.add_argument("--rate_interval", default="1m", help="at least four times the scrape interval")
    parser.add_argument("--dashboard", type=pathlib.Path, default=DASHBOARD, help="a dashboard's JSON")
    parser.add_argument("-o", "--output", type=pathlib.Path, required=True, help="the SVG file")
    args = parser.parse_args()
    if args.minutes <= 0:
        parser.error("--minutes: not above 0")
    try:
        dashboard = json.loads(args.dashboard.read_text())
        source = Range(args.prometheus, 60 * args.minutes, rate_interval=args.rate_interval)
        args.output.write_text(draw(dashboard, source.ask))
    except (OSError, ValueError) as error:  # HTTP errors among them
        print(f"render_dashboard.py: {args.prometheus}: {error}", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
