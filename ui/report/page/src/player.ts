// The scrubber: a range over the exam's time with its events as ticks, playing at three speeds, and stepping from event to event.
import { type Clock, time_text } from "./clock.ts";
import type { ExamEvent } from "./data.ts";
import { button, dropdown, make } from "./dom.ts";

const k_step_s = 0.1;

/** Colours and shapes of the kinds of events, the same on the scrubber and in the charts. */
export function event_colour(kind: string): string {
  if (/perforation|violation|limit|critical|fault/.test(kind)) return "#b3123b";
  if (/pause|resume|gap/.test(kind)) return "#6b6b6b";
  if (/aim/.test(kind)) return "#00695c";
  return "#3d4a7a";
}

export class Player {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly time: HTMLOutputElement;
  private readonly note: HTMLOutputElement;
  private readonly measured: HTMLElement;

  /** `chosen` is called with an event that was stepped to; `values` says in words what was measured at a time. */
  constructor(private readonly clock: Clock, private readonly events: ExamEvent[], private readonly chosen: (event: ExamEvent) => void, private readonly values: (t_s: number) => string) {
    const play = button("Play", { class: "play" }, () => (clock.is_playing ? clock.pause() : clock.play()));
    clock.on_play((playing) => {
      play.textContent = playing ? "Pause" : "Play";
      play.classList.toggle("playing", playing);
    });
    this.range = make("input", { type: "range", min: "0", max: String(clock.duration_s), step: String(k_step_s), value: "0", "aria-label": "Time in the exam" });
    this.range.addEventListener("input", () => {
      clock.pause();
      clock.set(Number(this.range.value));
    });
    this.range.addEventListener("keydown", (e) => this.key(e));
    this.time = make("output", { class: "time" });
    this.note = make("output", { class: "event", "aria-live": "polite" });
    const ticks = make("div", { class: "ticks", "aria-hidden": "true" });
    for (const event of events) {
      const tick = make("span", { title: `${time_text(event.t_s)} ${event.text}` });
      tick.style.left = `${clock.duration_s > 0 ? (100 * event.t_s) / clock.duration_s : 0}%`;
      tick.style.backgroundColor = event_colour(event.kind);
      tick.addEventListener("click", () => this.go_to(event));
      ticks.append(tick);
    }
    const speeds = dropdown("Speed", [["1", "1×"], ["4", "4×"], ["16", "16×"]], "1", (v) => clock.set_speed(Number(v)));
    const buttons = make("div", { class: "buttons" }, play, speeds);
    if (events.length > 0) buttons.append(button("Previous event", {}, () => this.step(-1)), button("Next event", {}, () => this.step(1)));
    this.measured = make("span", { class: "measured" });
    buttons.append(this.measured, this.note);
    this.element = make("div", { class: "player", role: "group", "aria-label": "Replay of the drilling" }, make("div", { class: "track" }, this.range, ticks, this.time), buttons);
    clock.on_time(() => this.show());
    this.show();
  }

  private go_to(event: ExamEvent): void {
    this.clock.pause();
    this.clock.set(event.t_s);
    this.note.textContent = `${time_text(event.t_s)} ${event.text}`;
    this.chosen(event);
  }

  private step(by: 1 | -1): void {
    const now = this.clock.t_s;
    const later = this.events.filter((e) => (by > 0 ? e.t_s > now + 0.01 : e.t_s < now - 0.01));
    if (later.length > 0) this.go_to(by > 0 ? later[0] : later[later.length - 1]);
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
    const text = `${time_text(t)} of ${time_text(this.clock.duration_s)}`;
    this.range.setAttribute("aria-valuetext", text);
    this.time.textContent = text;
    this.range.style.setProperty("--share", `${this.clock.duration_s > 0 ? (100 * t) / this.clock.duration_s : 0}%`);
    this.measured.textContent = this.values(t);
    this.note.textContent = "";
  }
}
