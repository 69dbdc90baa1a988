// The time that the page shows: one value that scrubber, tooth, instrument and charts follow, and the playing of it.
import { fixed } from "./words.ts";

export type Listener = (t_s: number) => void;

export class Clock {
  private now_s = 0;
  private speed = 1;
  private playing = false;
  private last_ms = 0;
  private readonly listeners: Listener[] = [];
  private readonly play_listeners: ((playing: boolean) => void)[] = [];

  constructor(readonly duration_s: number) {}

  get t_s(): number {
    return this.now_s;
  }

  get is_playing(): boolean {
    return this.playing;
  }

  on_time(listener: Listener): void {
    this.listeners.push(listener);
  }

  on_play(listener: (playing: boolean) => void): void {
    this.play_listeners.push(listener);
  }

  set(t_s: number): void {
    const t = Math.min(Math.max(Number.isFinite(t_s) ? t_s : 0, 0), this.duration_s);
    if (t === this.now_s) return;
    this.now_s = t;
    for (const listener of this.listeners) listener(t);
  }

  set_speed(speed: number): void {
    this.speed = speed;
  }

  play(): void {
    if (this.playing) return;
    if (this.now_s >= this.duration_s) this.set(0);
    this.playing = true;
    this.last_ms = performance.now();
    requestAnimationFrame((ms) => this.frame(ms));
    for (const listener of this.play_listeners) listener(true);
  }

  pause(): void {
    if (!this.playing) return;
    this.playing = false;
    for (const listener of this.play_listeners) listener(false);
  }

  private frame(ms: number): void {
    if (!this.playing) return;
    const elapsed_s = Math.max(ms - this.last_ms, 0) / 1000;
    this.last_ms = ms;
    this.set(this.now_s + Math.min(elapsed_s, 0.25) * this.speed);
    if (this.now_s >= this.duration_s) this.pause();
    else requestAnimationFrame((next) => this.frame(next));
  }
}

/** `1:05.3` for 65.39 s: as on any clock the tenth has begun, so that no second is named that the report's words do not name (clock_text of base/figures.h). */
export function time_text(t_s: number): string {
  const tenths = Math.floor(t_s * 10 + 1e-6);
  const minutes = Math.floor(tenths / 600);
  return `${minutes}:${fixed((tenths % 600) / 10, 1).padStart(4, "0")}`;
}
