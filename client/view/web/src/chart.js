// Travel per layer: a line for each route, the layer on view marked, a click goes to a layer.

import uPlot from "uplot";

const COLORS = {
  light: ["#6b7280", "#1d4ed8", "#c2410c", "#0f766e", "#7c3aed", "#be123c", "#4d7c0f", "#0369a1"],
  dark: ["#a3adba", "#7ab0ff", "#fb923c", "#2dd4bf", "#c4b5fd", "#fb7185", "#bef264", "#67e8f9"],
};

export class Chart {
  constructor(target, scene, onPick) {
    this.target = target;
    this.scene = scene;
    this.onPick = onPick;
    this.plot = null;
    this.layer = 0;
    this.shown = scene.shown;
  }

  // Draws all anew: the plot's colors are fixed when it is made.
  build(theme) {
    this.plot?.destroy();
    const { scene } = this;
    const layers = Array.from(scene.layers.id, (_, i) => scene.first + i + 1);
    const style = getComputedStyle(document.documentElement);
    const axis = {
      stroke: style.getPropertyValue("--quiet"),
      grid: { stroke: style.getPropertyValue("--line"), width: 1 },
      ticks: { stroke: style.getPropertyValue("--line"), width: 1 },
    };
    const wholes = (_, values) => values.map((value) => (Number.isInteger(value) ? value : ""));
    this.mark = style.getPropertyValue("--accent");
    const options = {
      ...this.size(),
      scales: { x: { time: false, range: this.range() }, y: { range: (_, low, high) => [0, high * 1.05 || 1] } },
      axes: [{ ...axis, values: wholes }, { ...axis, size: 84, values: (_, v) => v.map((mm) => `${mm} mm`) }],
      series: [
        { label: "Layer" },
        ...scene.routes.map((route, i) => ({
          label: route.label,
          stroke: COLORS[theme][i % 8],
          width: i === this.shown ? 2.2 : 1.3,
          points: { show: layers.length <= 60 },
          value: (_, mm) => (mm === null ? "" : `${mm.toFixed(1)} mm`),
        })),
      ],
      cursor: { drag: { x: false, y: false } },
      hooks: { draw: [(plot) => this.drawMark(plot)], ready: [(plot) => plot.setLegend({ idx: this.layer })] },
    };
    this.plot = new uPlot(options, [layers, ...scene.routes.map((route) => route.layers.travel)], this.target);
    this.plot.over.addEventListener("click", () => {
      if (this.plot.cursor.idx !== null) this.onPick(this.plot.cursor.idx);
    });
    this.plot.over.addEventListener("mouseleave", () => this.plot.setLegend({ idx: this.layer }));
  }

  range() {
    const first = this.scene.first + 1;
    const last = first + this.scene.last;
    return first === last ? [first - 1, last + 1] : [first, last];
  }

  size() {
    return { width: this.target.clientWidth, height: window.innerWidth < 720 ? 200 : 240 };
  }

  resize() {
    this.plot?.setSize(this.size());
  }

  show(layer) {
    this.layer = layer;
    this.plot?.redraw(false);
    this.plot?.setLegend({ idx: layer });
  }

  drawMark(plot) {
    const x = Math.round(plot.valToPos(this.scene.first + this.layer + 1, "x", true));
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.strokeStyle = this.mark;
    ctx.lineWidth = 1.5 * (window.devicePixelRatio || 1);
    ctx.setLineDash([5, 4]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    ctx.restore();
  }
}
