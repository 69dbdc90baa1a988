// The scrubber: a range over the exam's time with its events as ticks and the points lost as bars, playing at three speeds, and stepping from event
// to event and from one point lost to the next.
import { type Clock, time_text } from "./clock.ts";
import type { ExamEvent, Moment, Vec3 } from "./data.ts";
import { button, dropdown, make } from "./dom.ts";
import { event_stops, lane, loss_stops, type Stop } from "./stops.ts";
import { tr } from "./words.ts";

const k_step_s = 0.1;

export class Player {
  readonly element: HTMLElement;
  private readonly range: HTMLInputElement;
  private readonly time: HTMLOutputElement;
  private readonly note: HTMLOutputElement;
  private readonly measured: HTMLElement;
  private readonly buttons: HTMLElement;

  /** `chosen` is called with the place of what was stepped to; `values` says in words what was measured at a time. */
  constructor(
    private readonly clock: Clock,
    events: ExamEvent[],
    moments: Moment[],
    private readonly chosen: (site_mm: Vec3 | null) => void,
    private readonly values: (t_s: number) => string,
  ) {
    const stops = event_stops(events);
    const losses = loss_stops(moments);
    const go = (stop: Stop): void => this.go_to(stop);
    const play = button(tr("Play"), { class: "play" }, () =>
      clock.is_playing ? clock.pause() : clock.play(),
    );
    clock.on_play((playing) => {
      play.textContent = playing ? tr("Pause") : tr("Play");
      play.classList.toggle("playing", playing);
    });
    this.range = make("input", {
      type: "range",
      min: "0",
      max: String(clock.duration_s),
      step: String(k_step_s),
      value: "0",
      "aria-label": tr("Time in the exam"),
    });
    this.range.addEventListener("input", () => {
      clock.pause();
      clock.set(Number(this.range.value));
    });
    this.range.addEventListener("keydown", (e) => this.key(e));
    this.time = make("output", { class: "time" });
    this.note = make("output", { class: "event", "aria-live": "polite" });
    const speeds = dropdown(
      tr("Speed"),
      [
        ["1", "1×"],
        ["4", "4×"],
        ["16", "16×"],
      ],
      "1",
      (v) => clock.set_speed(Number(v)),
    );
    const buttons = (this.buttons = make("div", { class: "buttons" }, play, speeds));
    if (stops.length > 0)
      buttons.append(this.stepping(tr("Event"), tr("Previous event"), tr("Next event"), stops));
    if (losses.length > 0)
      buttons.append(
        this.stepping(tr("Point lost"), tr("Previous point lost"), tr("Next point lost"), losses),
      );
    this.measured = make("span", { class: "measured" });
    buttons.append(this.measured, this.note);
    this.element = make(
      "div",
      { class: "player", role: "group", "aria-label": tr("Replay of the drilling") },
      make(
        "div",
        { class: "track" },
        this.range,
        lane("ticks", stops, clock.duration_s, go),
        lane("ticks losses", losses, clock.duration_s, go),
        this.time,
      ),
      buttons,
    );
    clock.on_time(() => this.show());
    this.show();
  }

  /** Another session's time axis below this one's, and how both go together. */
  add_adjacent(name: string, axis: HTMLElement, choice: HTMLElement | null): void {
    this.element
      .querySelector(".track")!
      .after(make("p", { class: "small other-name" }, name), axis);
    if (choice) this.buttons.prepend(choice);
  }

  private stepping(title: string, previous: string, next: string, stops: Stop[]): HTMLElement {
    const back = button("◂", { "aria-label": previous, title: previous }, () =>
      this.step(stops, -1),
    );
    const on = button("▸", { "aria-label": next, title: next }, () => this.step(stops, 1));
    return make("span", { class: "stepping" }, back, title, on);
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
    this.range.style.setProperty(
      "--share",
      `${this.clock.duration_s > 0 ? (100 * t) / this.clock.duration_s : 0}%`,
    );
    this.measured.textContent = this.values(t);
    this.note.textContent = "";
  }
}
