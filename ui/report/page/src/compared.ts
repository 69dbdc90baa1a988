// Two sessions of one exam, side by side: the second tooth is seen as the first one is, by the same clock or at the same step.
import { Alignment, adjacent_data } from "./alignment.ts";
import { type Clock, time_text } from "./clock.ts";
import type { Beside, ReportData } from "./data.ts";
import { dropdown, make } from "./dom.ts";
import { Recording } from "./motion.ts";
import { event_stops, lane, loss_stops, type Stop } from "./stops.ts";
import { ToothField } from "./tooth_field.ts";
import { ToothView, type ViewOptions } from "./view.ts";
import { tr } from "./words.ts";

export class AdjacentView {
  readonly view: ToothView;
  /** The time axis of the other one, with its events and what cost points, below the scrubber. */
  readonly axis: HTMLElement;
  readonly choice: HTMLElement | null;
  private readonly caption: HTMLElement;
  private readonly recording: Recording;
  private readonly alignment: Alignment;
  private readonly stops: Stop[];
  private lanes: HTMLElement[] = [];

  /** Stands beside `frame`, the first view's. Throws when WebGL is not to be had. */
  constructor(
    frame: HTMLElement,
    first: ToothView,
    data: ReportData,
    private readonly beside: Beside,
    options: ViewOptions,
    private readonly clock: Clock,
  ) {
    const other = adjacent_data(data, beside);
    const canvas = make("canvas", {
      tabindex: "0",
      role: "application",
      "aria-label": tr("The tooth beside it in 3D: {}. Arrow keys turn both.", beside.name),
    });
    this.caption = make("figcaption", { class: "small" });
    const box = make("div", { class: "view" }, canvas);
    const own_caption = make("figcaption", { class: "small" }, tr("This session"));
    const pair = make("div", { class: "side-by-side" });
    frame.before(pair);
    pair.append(make("figure", {}, own_caption, frame), make("figure", {}, this.caption, box));
    this.view = new ToothView(canvas, new ToothField(other), other, options);
    first.join(this.view);
    this.recording = new Recording(beside.motion);
    this.alignment = new Alignment(
      { steps_s: data.steps_s ?? [], duration_s: data.duration_s ?? 0 },
      beside,
    );
    this.choice = this.alignment.has_steps
      ? dropdown(
          tr("Beside each other"),
          [
            ["clock", tr("at the same time")],
            ["step", tr("at the same step")],
          ],
          "clock",
          (v) => {
            this.alignment.by_step = v === "step";
            this.show(this.clock.t_s);
            this.fill();
          },
        )
      : null;
    this.stops = [...event_stops(beside.events), ...loss_stops(beside.moments)];
    this.axis = make("div", { class: "other-axis" });
    this.fill();
    clock.on_time((t_s) => this.show(t_s));
    this.show(clock.t_s);
  }

  private show(t_s: number): void {
    const at = this.alignment.time(t_s);
    this.view.mark(null); // a mark belongs to its moment
    this.view.show(at, this.recording.at(at));
    this.caption.textContent = tr(
      "{0} at {1} of {2}",
      this.beside.name,
      time_text(at),
      time_text(this.beside.duration_s),
    );
  }

  private fill(): void {
    for (const l of this.lanes) l.remove();
    const here = (s: Stop): Stop => ({
      ...s,
      t_s: this.alignment.back(s.t_s),
      to_s: this.alignment.back(s.to_s),
      text: `(${time_text(s.t_s)}) ${s.text}`,
    });
    const go = (s: Stop): void => {
      this.clock.pause();
      this.clock.set(s.t_s);
      this.view.mark(s.site_mm);
    };
    const inside = this.stops.map(here).filter((s) => s.t_s <= this.clock.duration_s);
    this.lanes = [
      lane(
        "ticks",
        inside.filter((s) => !s.lost),
        this.clock.duration_s,
        go,
      ),
      lane(
        "ticks losses",
        inside.filter((s) => s.lost),
        this.clock.duration_s,
        go,
      ),
    ];
    this.axis.append(...this.lanes);
  }
}
