// Force, depth, handpiece speed and tip speed against time, one below the other over one time axis: drag to zoom, click to move the scrubber, arrow
// keys to walk through the exam.
import uPlot from "uplot";
import { type Clock, time_text } from "./clock.ts";
import type { ExamEvent } from "./data.ts";
import { button, make } from "./dom.ts";
import type { Recording } from "./motion.ts";
import { event_colour } from "./stops.ts";
import { tr, with_sign } from "./words.ts";

interface Quantity {
  name: string;
  unit: string;
  digits: number;
  colour: string;
  values: Float64Array;
}

const k_height_px = 130;
const k_labels_px = 16;
const k_axis_px = 30;

export class Charts {
  private readonly plots: uPlot[] = [];
  private readonly values: HTMLElement[] = [];
  private readonly lines: HTMLElement[] = [];
  private readonly quantities: Quantity[];
  private shown: [number, number];

  constructor(
    private readonly section: HTMLElement,
    private readonly recording: Recording,
    private readonly events: ExamEvent[],
    private readonly clock: Clock,
  ) {
    this.quantities = [
      { name: tr("Force"), unit: "N", digits: 2, colour: "#0b5394", values: recording.force_n },
      { name: tr("Depth"), unit: "mm", digits: 2, colour: "#7a4b00", values: recording.depth_mm },
      { name: tr("Handpiece"), unit: "rpm", digits: 0, colour: "#5b2a86", values: recording.rpm },
      {
        name: tr("Tip speed"),
        unit: "mm/s",
        digits: 1,
        colour: "#00695c",
        values: recording.tip_mm_s,
      },
    ];
    this.shown = [0, Math.max(clock.duration_s, recording.dt_s)];
    section.append(
      make(
        "div",
        { class: "buttons" },
        button(tr("Whole exam"), {}, () => this.zoom_to(0, clock.duration_s)),
        button(tr("Zoom in"), { "aria-label": tr("Zoom in on the time") }, () => this.zoom(0.5)),
        button(tr("Zoom out"), { "aria-label": tr("Zoom out of the time") }, () => this.zoom(2)),
      ),
    );
    this.quantities.forEach((quantity, i) => this.add(quantity, i));
    clock.on_time(() => this.follow());
    new ResizeObserver(() => {
      this.plots.forEach((plot) => plot.setSize({ width: this.width(), height: plot.height }));
      this.place_lines();
    }).observe(section);
    this.follow();
  }

  private width(): number {
    return Math.max(this.section.clientWidth, 240);
  }

  private add(quantity: Quantity, index: number): void {
    const last = index === this.quantities.length - 1;
    const first = index === 0;
    let [low, high, sum] = [Infinity, -Infinity, 0];
    for (const v of quantity.values) {
      if (v < low) low = v;
      if (v > high) high = v;
      sum += v;
    }
    const say = (v: number): string => number_text(v, quantity.digits);
    const range =
      quantity.values.length > 0
        ? tr(
            "{0} to {1} {2}, mean {3} {2}",
            say(low),
            say(high),
            quantity.unit,
            say(sum / quantity.values.length),
          )
        : tr("nothing recorded");
    const now = make("span", { class: "now" });
    this.values.push(now);
    const place = make("div", {
      class: "plot",
      tabindex: "0",
      role: "img",
      "aria-label": tr(
        "{} over time: {}. Arrow keys move the time, plus and minus zoom, 0 shows the whole exam.",
        quantity.name,
        range,
      ),
    });
    const caption = make(
      "figcaption",
      {},
      make("b", {}, `${quantity.name}, ${quantity.unit}`),
      make("span", { class: "range" }, range),
      now,
    );
    this.section.append(make("figure", { class: "chart" }, caption, place));
    const time_axis: uPlot.Axis = {
      size: k_axis_px,
      font: "12px system-ui, sans-serif",
      stroke: "#444",
      grid: { stroke: "#e6e6e6", width: 1 },
      ticks: { stroke: "#bbb", size: 4 },
      values: (_u, splits) => splits.map((s) => clock_text(s)),
      incrs: [0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600],
    };
    const options: uPlot.Options = {
      width: this.width(),
      height: k_height_px + (last ? k_axis_px : 0) + (first ? k_labels_px : 0),
      padding: [first ? k_labels_px : 6, 18, last ? 0 : 6, 0],
      legend: { show: false },
      scales: {
        x: { time: false },
        y: {
          range: (_u, min, max) =>
            min === null || max === null
              ? [0, 1]
              : [Math.min(min, 0), max > min ? max * 1.06 : min + 1],
        },
      },
      cursor: {
        y: false,
        drag: { x: true, y: false, setScale: false },
        points: { size: 7 },
        sync: { key: "exam", setSeries: false },
      },
      axes: [
        last
          ? time_axis
          : {
              ...time_axis,
              size: 0,
              values: (_u, splits) => splits.map(() => ""),
              ticks: { show: false },
            },
        {
          size: 62,
          font: "12px system-ui, sans-serif",
          stroke: "#444",
          grid: { stroke: "#eee", width: 1 },
          ticks: { show: false },
        },
      ],
      series: [
        {},
        {
          label: quantity.name,
          stroke: quantity.colour,
          width: 1.3,
          fill: `${quantity.colour}18`,
          points: { show: false },
        },
      ],
      hooks: {
        draw: [(u) => this.draw_marks(u, first)],
        setSelect: [
          (u) => {
            if (u.select.width < 4) return;
            const [from, to] = [
              u.posToVal(u.select.left, "x"),
              u.posToVal(u.select.left + u.select.width, "x"),
            ];
            u.setSelect({ left: 0, top: 0, width: 0, height: 0 }, false);
            this.zoom_to(from, to);
          },
        ],
      },
    };
    const plot = new uPlot(
      options,
      [this.recording.t_s, quantity.values] as unknown as uPlot.AlignedData,
      place,
    );
    const line = make("div", { class: "present", "aria-hidden": "true" });
    plot.over.append(line);
    this.lines.push(line);
    let pressed_x = 0;
    plot.over.addEventListener("mousedown", (e) => {
      pressed_x = e.clientX;
    });
    plot.over.addEventListener("click", (e) => {
      if (Math.abs(e.clientX - pressed_x) > 3) return;
      this.clock.pause();
      this.clock.set(plot.posToVal(e.clientX - plot.over.getBoundingClientRect().left, "x"));
    });
    plot.over.addEventListener("dblclick", () => this.zoom_to(0, this.clock.duration_s));
    place.addEventListener("keydown", (e) => this.key(e));
    this.plots.push(plot);
  }

  /** Events as dashed lines with their names on the uppermost chart. */
  private draw_marks(u: uPlot, with_names: boolean): void {
    const ctx = u.ctx;
    const ratio = devicePixelRatio;
    const { left, top, width, height } = u.bbox;
    ctx.save();
    ctx.font = `${11 * ratio}px system-ui, sans-serif`;
    ctx.textBaseline = "alphabetic";
    let free_from = -Infinity;
    for (const event of this.events) {
      if (event.t_s < this.shown[0] || event.t_s > this.shown[1]) continue;
      const x = Math.round(u.valToPos(event.t_s, "x", true)) + 0.5;
      ctx.strokeStyle = ctx.fillStyle = event_colour(event.kind);
      ctx.lineWidth = ratio;
      ctx.setLineDash([3 * ratio, 3 * ratio]);
      ctx.beginPath();
      ctx.moveTo(x, top);
      ctx.lineTo(x, top + height);
      ctx.stroke();
      if (!with_names) continue;
      const wide = ctx.measureText(tr(event.kind)).width;
      const from = Math.min(Math.max(x - wide / 2, left), left + width - wide);
      if (from < free_from) continue;
      ctx.fillText(tr(event.kind), from, top - 4 * ratio);
      free_from = from + wide + 6 * ratio;
    }
    ctx.restore();
  }

  private follow(): void {
    const t = this.clock.t_s;
    const [from, to] = this.shown;
    if (t < from || t > to) {
      const span = to - from;
      const low = Math.min(Math.max(t - span / 2, 0), Math.max(this.clock.duration_s - span, 0));
      this.zoom_to(low, low + span);
    }
    const i = this.recording.index(t);
    this.quantities.forEach((q, k) => {
      this.values[k].textContent =
        `${time_text(t)}: ${number_text(q.values[i], q.digits)} ${q.unit}`;
    });
    this.place_lines();
  }

  /** The present time as a line over each chart; the charts themselves need not be drawn again for it. */
  private place_lines(): void {
    this.plots.forEach((plot, i) => {
      const x = plot.valToPos(this.clock.t_s, "x");
      this.lines[i].hidden = !(x >= 0 && x <= plot.over.clientWidth);
      this.lines[i].style.transform = `translateX(${x}px)`;
    });
  }

  private zoom(by: number): void {
    const span = Math.max((this.shown[1] - this.shown[0]) * by, 5 * this.recording.dt_s);
    this.zoom_to(this.clock.t_s - span / 2, this.clock.t_s + span / 2);
  }

  private zoom_to(from: number, to: number): void {
    const whole = Math.max(this.clock.duration_s, this.recording.dt_s);
    const span = Math.min(to - from, whole);
    const low = Math.min(Math.max(from, 0), whole - span);
    this.shown = [low, low + span];
    for (const plot of this.plots) plot.setScale("x", { min: this.shown[0], max: this.shown[1] });
    this.place_lines();
  }

  private key(e: KeyboardEvent): void {
    if (e.ctrlKey || e.altKey || e.metaKey) return;
    const step = (this.shown[1] - this.shown[0]) / (e.shiftKey ? 20 : 200);
    if (e.key === "ArrowRight" || e.key === "ArrowLeft") {
      this.clock.pause();
      this.clock.set(this.clock.t_s + (e.key === "ArrowRight" ? step : -step));
    } else if (e.key === "+" || e.key === "=") this.zoom(0.5);
    else if (e.key === "-" || e.key === "_") this.zoom(2);
    else if (e.key === "0") this.zoom_to(0, this.clock.duration_s);
    else return;
    e.preventDefault();
  }
}

/** `200,000`, `−0.35` */
export function number_text(v: number, digits: number): string {
  return with_sign(
    v.toLocaleString("en-GB", { minimumFractionDigits: digits, maximumFractionDigits: digits }),
  ).replace("-", "−");
}

/** `1:05` on the time axis, with tenths where they matter. */
function clock_text(t_s: number): string {
  return Number.isInteger(Math.round(t_s * 1000) / 1000)
    ? time_text(t_s).replace(/[.,]0$/, "")
    : time_text(t_s);
}
