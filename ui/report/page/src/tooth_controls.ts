// The controls of the 3D view: views, colouring, the target's outline, the cut-away plane, the key to the colours, and the value under the pointer.
import { time_text } from "./clock.ts";
import type { ReportData, Vec3 } from "./data.ts";
import { distance_text, key_element, tissue_key } from "./deviation.ts";
import { button, checkbox, dropdown, make, radios } from "./dom.ts";
import { Compass } from "./compass.ts";
import { k_views } from "./orbit.ts";
import type { Reading } from "./probe.ts";
import type { ToothField } from "./tooth_field.ts";
import type { ToothView } from "./view.ts";
import { fixed, noop, tr } from "./words.ts";

const k_cuts: {
  [name: string]: { text: string; normal: Vec3; azimuth_deg: number; elevation_deg: number };
} = {
  buccal: { text: noop("from buccal"), normal: [0, 1, 0], azimuth_deg: 75, elevation_deg: 22 },
  lingual: { text: noop("from lingual"), normal: [0, -1, 0], azimuth_deg: -75, elevation_deg: 22 },
  mesial: { text: noop("from mesial"), normal: [1, 0, 0], azimuth_deg: 15, elevation_deg: 22 },
  distal: { text: noop("from distal"), normal: [-1, 0, 0], azimuth_deg: 165, elevation_deg: 22 },
  occlusal: { text: noop("from occlusal"), normal: [0, 0, 1], azimuth_deg: -90, elevation_deg: 75 },
};

const k_view_names: { [name: string]: string } = {
  oblique: noop("Oblique"),
  occlusal: noop("Occlusal"),
  buccal: noop("Buccal"),
  lingual: noop("Lingual"),
  mesial: noop("Mesial"),
  distal: noop("Distal"),
};

export interface ControlsOptions {
  edges: readonly number[];
  whole: number;
  with_instrument: boolean;
  /** Puts the clock to the time when the place read was cut. */
  go_to?: (t_s: number) => void;
}

export class ToothControls {
  readonly frame: HTMLElement;
  readonly panel: HTMLElement;
  /** Frame and panel beside each other where there is room. */
  readonly element: HTMLElement;
  private readonly hint: HTMLElement;
  private readonly readout: HTMLOutputElement;
  private view!: ToothView;
  private last: Reading | null = null;

  constructor(
    readonly canvas: HTMLCanvasElement,
    private readonly field: ToothField,
    private readonly data: ReportData,
    private readonly options: ControlsOptions,
  ) {
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "application");
    canvas.setAttribute(
      "aria-label",
      tr(
        "The tooth in 3D. Arrow keys turn it, plus and minus zoom, Home shows it all, Enter reads the value in the middle.",
      ),
    );
    this.readout = make("output", { class: "readout", "aria-live": "polite" });
    this.hint = make(
      "p",
      { class: "hint", "aria-hidden": "true" },
      tr("Drag to turn, two fingers or shift to move; click, then the wheel zooms."),
    );
    this.frame = make(
      "div",
      { class: "view" },
      canvas,
      make("div", { class: "cross", "aria-hidden": "true" }),
      this.hint,
      this.readout,
    );
    this.panel = make("div", { class: "panel" });
    this.element = make("div", { class: "stage" }, this.frame, this.panel);
  }

  /** Builds the controls for a view that works. */
  connect(view: ToothView): void {
    this.view = view;
    const { panel, canvas, data, options } = this;
    const views = make("div", { class: "views", role: "group", "aria-label": tr("Views") });
    for (const name of Object.keys(k_views))
      views.append(
        button(tr(k_view_names[name] ?? name), {}, () => {
          if (name === "oblique") view.orbit.reset();
          else view.orbit.look(k_views[name]);
        }),
      );
    this.frame.append(
      make(
        "div",
        { class: "zoom" },
        button("+", { "aria-label": tr("Zoom in") }, () => view.orbit.zoom(1.25)),
        button("−", { "aria-label": tr("Zoom out") }, () => view.orbit.zoom(0.8)),
        button("□", { "aria-label": tr("Whole tooth"), title: tr("Whole tooth") }, () =>
          view.orbit.show_whole(),
        ),
      ),
    );

    const heat = data.kind === "class";
    const key = heat
      ? key_element(options.edges, 100, tr("% of the class"), 0, tr("Deviation from the target"), {
          over: tr("overcut here"),
          under: tr("left standing here"),
        })
      : key_element(
          options.edges,
          options.whole,
          "mm",
          options.whole * options.edges[0] < 0.1 ? 2 : 1,
          tr("Distance of the cut surface from the target"),
          { over: tr("overcut"), under: tr("left standing") },
        );
    if (!heat) {
      const untouched = make(
        "p",
        { class: "untouched" },
        make("span", { class: "swatch untouched" }),
        tr("target left standing, surface untouched"),
      );
      key.append(untouched);
    }
    // the deviation is drawn over paler tissues: what stands beside the tooth is told in either colouring
    const there = [...new Set(this.field.tissue)]
      .sort((a, b) => a - b)
      .map((id) => data.tissues[id])
      .filter((t) => t && t.name !== "air");
    const tissues = tissue_key(there),
      beside = tissue_key(there.filter((t) => t.beside));
    tissues.hidden = true;
    const colouring = radios(
      tr("Colour by"),
      "colouring",
      [
        ["deviation", heat ? tr("the class") : tr("deviation")],
        ["tissue", tr("tissue")],
      ],
      "deviation",
      (v) => {
        view.set_colouring(v === "deviation");
        key.hidden = v !== "deviation";
        tissues.hidden = v === "deviation";
        beside.hidden = v !== "deviation";
      },
    );
    const show = make(
      "fieldset",
      { class: "choices" },
      make("legend", {}, tr("Show")),
      checkbox(tr("target outline"), false, (on) => view.set_target(on)),
    );
    if (options.with_instrument)
      show.append(checkbox(tr("instrument"), true, (on) => view.set_instrument(on)));
    panel.append(views, colouring, show, this.cut_away());
    if (heat) {
      const depths = dropdown(
        tr("Deviation of more than"),
        [0.1, 0.2, 0.3, 0.5, 1].map((d) => [String(d), `${fixed(d, 1)} mm`] as [string, string]),
        "0.1",
        (v) => view.set_heat_depth(Number(v)),
      );
      view.set_heat_depth(0.1);
      panel.append(depths);
    }
    panel.append(key, tissues, beside);

    const compass = new Compass();
    this.frame.append(compass.element);
    view.on_draw = () => compass.follow(view.orbit.camera);
    view.redraw();
    canvas.addEventListener("pointerdown", () => this.hint.remove(), { once: true });
    const rest = (): void => canvas.parentElement!.classList.remove("keyboard");
    canvas.addEventListener("pointermove", (e) => {
      if (!view.orbit.dragging && e.pointerType === "mouse") this.read(e.offsetX, e.offsetY);
    });
    canvas.addEventListener("pointerup", (e) => {
      if (e.pointerType !== "mouse") this.read(e.offsetX, e.offsetY);
    });
    canvas.addEventListener("pointerleave", () => this.say(null));
    canvas.addEventListener("pointerdown", rest);
    canvas.addEventListener("blur", rest);
    canvas.addEventListener("dblclick", () => this.jump());
    canvas.addEventListener("keydown", (e) => {
      canvas.parentElement!.classList.add("keyboard");
      if (e.key !== "Enter") return;
      e.preventDefault();
      if (e.shiftKey) this.jump();
      else this.read(canvas.clientWidth / 2, canvas.clientHeight / 2);
    });
  }

  private cut_away(): HTMLElement {
    const { view, field } = this;
    const [low, high] = [0, 1].map((end) =>
      field.origin_mm.map((o, a) => o + end * (field.size[a] - 1) * field.cell_mm),
    ) as [Vec3, Vec3];
    const middle = field.moving ?? field.box;
    const place = middle.low.map(
      (v, a) => field.origin_mm[a] + (v + (middle.size[a] - 1) / 2) * field.cell_mm,
    );
    let chosen = "";
    const slider = make("input", {
      type: "range",
      step: "0.05",
      "aria-label": tr("Place of the cut"),
    });
    const value = make("output", { class: "small" });
    slider.disabled = true;
    const apply = (): void => {
      const cut = k_cuts[chosen];
      const axis = cut.normal.findIndex((v) => v !== 0);
      const at = Number(slider.value);
      value.textContent = `${"xyz"[axis]} = ${fixed(at, 2)} mm`;
      slider.setAttribute("aria-valuetext", value.textContent);
      view.set_clip({ normal: cut.normal, offset_mm: at * cut.normal[axis] });
    };
    const choose = (name: string): void => {
      chosen = name;
      slider.disabled = name === "";
      value.textContent = "";
      if (name === "") return view.set_clip(null);
      const cut = k_cuts[name];
      const axis = cut.normal.findIndex((v) => v !== 0);
      slider.min = low[axis].toFixed(2);
      slider.max = high[axis].toFixed(2);
      slider.value = place[axis].toFixed(2);
      view.orbit.look(cut);
      apply();
    };
    slider.addEventListener("input", apply);
    const list = dropdown(
      "",
      [
        ["", tr("nothing")],
        ...Object.entries(k_cuts).map(([name, { text }]) => [name, tr(text)] as [string, string]),
      ],
      "",
      choose,
    );
    list.querySelector("select")!.setAttribute("aria-label", tr("Cut away"));
    return make(
      "fieldset",
      { class: "choices cut" },
      make("legend", {}, tr("Cut away")),
      list,
      slider,
      value,
    );
  }

  private read(x: number, y: number): void {
    this.say(this.view.read(x, y));
  }

  private jump(): void {
    if (this.last?.cut_at_s != null) this.options.go_to?.(this.last.cut_at_s);
  }

  private say(reading: Reading | null): void {
    this.last = reading;
    if (!reading) {
      this.readout.textContent = "";
      return;
    }
    const parts = [];
    const tissue = this.data.tissues[reading.tissue]?.words ?? "";
    if (this.data.kind !== "class" && reading.distance_mm !== null) {
      if (reading.cut) parts.push(distance_text(reading.distance_mm, this.options.whole));
      else if (
        reading.distance_mm < -this.options.edges[0] * this.options.whole &&
        !reading.section
      )
        parts.push(
          tr("target, {} mm to its walls or floor, untouched", fixed(-reading.distance_mm, 2)),
        );
      else {
        const mm = fixed(Math.abs(reading.distance_mm), 2);
        parts.push(
          reading.distance_mm < 0
            ? tr("{} mm inside the target", mm)
            : tr("{} mm outside the target", mm),
        );
        if (!reading.section) parts.push(tr("untouched"));
      }
    } else if (this.data.kind === "class") {
      const heat = this.view.heat_at(reading.place_mm);
      if (heat !== null)
        parts.push(
          `${heat > 0 ? "+" : heat < 0 ? "−" : ""}${Math.abs(heat).toFixed(0)} % of the class ${heat > 0 ? tr("overcut") : heat < 0 ? "left it standing" : "deviated"}`,
        );
    }
    parts.push(tissue);
    if (reading.cut_at_s !== null)
      parts.push(
        tr("cut at {} (double-click or Shift+Enter goes there)", time_text(reading.cut_at_s)),
      );
    parts.push(tr("x {}, y {}, z {} mm", ...reading.place_mm.map((v) => fixed(v, 2))));
    this.readout.textContent = parts.join(" · ");
  }
}
