// Two sessions of one exam: which of their moments are shown together, and what the second one has in common with the first.
import type { Beside, ReportData } from "./data.ts";

/** Time in the other session for a time in this one: as far into the same step, or the same second. */
export class Alignment {
  by_step = false;
  private readonly own: number[];
  private readonly other: number[];

  constructor(
    own: { steps_s: number[]; duration_s: number },
    private readonly beside: { steps_s: number[]; duration_s: number },
  ) {
    const both = Math.min(own.steps_s.length, beside.steps_s.length);
    this.own = [0, ...own.steps_s.slice(0, both), own.duration_s];
    this.other = [0, ...beside.steps_s.slice(0, both), beside.duration_s];
  }

  get has_steps(): boolean {
    return this.own.length > 2;
  }

  /** What ended earlier stands as it was left. */
  time(t_s: number): number {
    return this.by_step
      ? between(this.own, this.other, t_s)
      : Math.min(t_s, this.beside.duration_s);
  }

  /** The time here at which the other one is at a time of its own. */
  back(t_s: number): number {
    return this.by_step ? between(this.other, this.own, t_s) : t_s;
  }
}

function between(from: number[], to: number[], t_s: number): number {
  let i = 0;
  while (i + 2 < from.length && t_s > from[i + 1]) ++i;
  const whole = from[i + 1] - from[i];
  const share = whole > 0 ? Math.min(Math.max((t_s - from[i]) / whole, 0), 1) : 1;
  return to[i] + share * (to[i + 1] - to[i]);
}

/** The data of the other session as those of a report. */
export function adjacent_data(data: ReportData, beside: Beside): ReportData {
  return {
    ...data,
    ...beside,
    title: beside.name,
    grid: { ...data.grid, ...beside.grid },
    beside: undefined,
  };
}
