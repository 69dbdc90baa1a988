// The scrubber: a range over the exam's time with its events as ticks and the points lost as bars, playing at three speeds, and stepping from event
// to event and from one point lost to the next.
import { type Clock, time_text } from "./clock.ts";
import type { ExamEvent, Moment, Vec3 } from "./data.ts";
import { button, dropdown, make } from "./dom.ts";
import { fixed, tr } from "./words.ts";

const k_step_s = 0.1;

/** Colours and shapes of the kinds of events, the same on the scrubber and in the charts. */
export function event_colour(kind: string): string {
  if (/perforation|violation|limit|critical|fault/.test(kind)) return "#b3123b";
  if (/pause|resume|gap/.test(kind)) return "#6b6b6b";
  if (/aim/.test(kind)) return "#00695c";
  return "#3d4a7a";
}

/** A moment that the scrubber can be put to. */
interface Stop {
  t_s: number;
  to_s: number;
  colour: string;
  text: string;
  site_mm: Vec3 | null;
}

const k_lost_colour = "#c65600";

function of_event(event: ExamEvent): Stop {
  return { t_s: event.t_s, to_s: event.t_s, colour: event_colour(event.kind), text: event.text, site_mm: event.site_mm };
}

function of_moment(moment: Moment): Stop {
  const t_s = moment.t_s ?? 0;
  const what = `${moment.criterion}: ${moment.what}`;
  const text = moment.points_lost ? tr("{} (−{} points)", what, fixed(moment.points_lost, 1)) : what;
  return { t_s, to_s: moment.to_t_s ?? t_s, colour: k_lost_colour, text, site_mm: moment.site_mm };
}

export class Player {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly time: HTMLOutputElement;
  private readonly note: HTMLOutputElement;
  private readonly measured: HTMLElement;

  /** `chosen` is called with the place of what was stepped to; `values` says in words what was measured at a time. */
  constructor(private readonly clock: Clock, events: ExamEvent[], moments: Moment[], private readonly chosen: (site_mm: Vec3 | null) => void, private readonly values: (t_s: number) => string) {
    const stops = events.map(of_event);
    const losses = moments.filter((m) => m.t_s !== null).map(of_moment).sort((a, b) => a.t_s - b.t_s);
    const play = button(tr("Play"), { class: "play" }, () => (clock.is_playing ? clock.pause() : clock.play()));
    clock.on_play((playing) => {
      play.textContent = playing ? tr("Pause") : tr("Play");
      play.classList.toggle("playing", playing);
    });
    this.range = make("input", { type: "range", min: "0", max: String(clock.duration_s), step: String(k_step_s), value: "0", "aria-label": tr("Time in the exam") });
    this.range.addEventListener("input", () => {
      clock.pause();
      clock.set(Number(this.range.value));
    });
    this.range.addEventListener("keydown", (e) => this.key(e));
    this.time = make("output", { class: "time" });
    this.note = make("output", { class: "event", "aria-live": "polite" });
    const speeds = dropdown(tr("Speed"), [["1", "1×"], ["4", "4×"], ["16", "16×"]], "1", (v) => clock.set_speed(Number(v)));
    const buttons = make("div", { class: "buttons" }, play, speeds);
    if (stops.length > 0) buttons.append(this.stepping(tr("Event"), tr("Previous event"), tr("Next event"), stops));
    if (losses.length > 0) buttons.append(this.stepping(tr("Point lost"), tr("Previous point lost"), tr("Next point lost"), losses));
    this.measured = make("span", { class: "measured" });
    buttons.append(this.measured, this.note);
    this.element = make("div", { class: "player", role: "group", "aria-label": tr("Replay of the drilling") }, make("div", { class: "track" }, this.range, this.lane("ticks", stops), this.lane("ticks losses", losses), this.time), buttons);
    clock.on_time(() => this.show());
    this.show();
  }

  private stepping(title: string, previous: string, next: string, stops: Stop[]): HTMLElement {
    const back = button("◂", { "aria-label": previous, title: previous }, () => this.step(stops, -1));
    const on = button("▸", { "aria-label": next, title: next }, () => this.step(stops, 1));
    return make("span", { class: "stepping" }, back, title, on);
  }

  /** Ticks and bars under the range; the buttons do for the keyboard what a click on them does. */
  private lane(kind: string, stops: Stop[]): HTMLElement {
    const lane = make("div", { class: kind, "aria-hidden": "true" });
    const percent = (t_s: number): number => (this.clock.duration_s > 0 ? (100 * t_s) / this.clock.duration_s : 0);
    for (const stop of stops) {
      const tick = make("span", { title: `${time_text(stop.t_s)} ${stop.text}` });
      tick.style.left = `${percent(stop.t_s)}%`;
      if (stop.to_s > stop.t_s) tick.style.width = `max(3px, ${percent(stop.to_s - stop.t_s).toFixed(2)}%)`;
      tick.style.backgroundColor = stop.colour;
      tick.addEventListener("click", () => this.go_to(stop));
      lane.append(tick);
    }
    lane.hidden = stops.length === 0;
    return lane;
  }

  private go_to(stop: Stop): void {
    this.clock.pause();
    this.clock.set(stop.t_s);
    this.note.textContent = `${time_text(stop.t_s)} ${stop.text}`;
    this.chosen(stop.site_mm);
  }

  private step(stops: Stop[], by: 1 | -1): void {
    const now = this.clock.t_s;
    const beyond = stops.filter((s) => (by > 0 ? s.t_s > now + 0.01 : s.t_s < now - 0.01));
    if (beyond.length > 0) this.go_to(by > 0 ? beyond[0] : beyond[beyond.length - 1]);
  }

  private key(e: KeyboardEvent): void {
    if (e.key === " ") {
      e.preventDefault();
      if (this.clock.is_playing) this.clock.pause();
      else this.clock.play();
    }
  }

  private show(): void {
    const t = this.clock.t_s;
    this.range.value = String(t);
    const text = tr("{} of {}", time_text(t), time_text(this.clock.duration_s));
    this.range.setAttribute("aria-valuetext", text);
    this.time.textContent = text;
    this.range.style.setProperty("--share", `${this.clock.duration_s > 0 ? (100 * t) / this.clock.duration_s : 0}%`);
    this.measured.textContent = this.values(t);
    this.note.textContent = "";
  }
}
