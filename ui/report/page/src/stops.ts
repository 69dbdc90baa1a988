// Moments that the time axis shows and leads to: events as ticks, what cost points as bars.
import { time_text } from "./clock.ts";
import type { ExamEvent, Moment, Vec3 } from "./data.ts";
import { make } from "./dom.ts";
import { fixed, tr } from "./words.ts";

/** Colours and shapes of the kinds of events, the same on the scrubber and in the charts. */
export const event_colour = (kind: string): string => k_colours[kind] ?? "#3d4a7a";
const k_colours: { readonly [kind: string]: string } = {
  perforation: "#b3123b",
  violation: "#b3123b",
  limit: "#b3123b",
  pause: "#6b6b6b",
  gap: "#6b6b6b",
  aim: "#00695c",
};

/** A moment that the scrubber can be put to. */
export interface Stop {
  t_s: number;
  to_s: number;
  colour: string;
  text: string;
  site_mm: Vec3 | null;
  lost: boolean;
}

const k_lost_colour = "#c65600";
const k_min_points = 0.005; // reads 0.00

function of_event(event: ExamEvent): Stop {
  return {
    t_s: event.t_s,
    to_s: event.t_s,
    colour: event_colour(event.kind),
    text: event.text,
    site_mm: event.site_mm,
    lost: false,
  };
}

function of_moment(moment: Moment): Stop {
  const t_s = moment.t_s ?? 0;
  const what = `${moment.criterion}: ${moment.what}`;
  const text = moment.points_lost
    ? tr("{} (−{} points)", what, fixed(moment.points_lost, 1))
    : what;
  return {
    t_s,
    to_s: moment.to_t_s ?? t_s,
    colour: k_lost_colour,
    text,
    site_mm: moment.site_mm,
    lost: true,
  };
}

export function event_stops(events: ExamEvent[]): Stop[] {
  return events.map(of_event).sort((a, b) => a.t_s - b.t_s);
}

/** Those that cost points: the others say more of a criterion, and stand in its table. */
export function loss_stops(moments: Moment[]): Stop[] {
  return moments
    .filter((m) => m.t_s !== null && m.points_lost !== null && m.points_lost > k_min_points)
    .map(of_moment)
    .sort((a, b) => a.t_s - b.t_s);
}

/** Ticks and bars under the range; buttons do for the keyboard what a click on them does. */
export function lane(
  kind: string,
  stops: Stop[],
  duration_s: number,
  go_to: (stop: Stop) => void,
): HTMLElement {
  const lane = make("div", { class: kind, "aria-hidden": "true" });
  const percent = (t_s: number): number => (duration_s > 0 ? (100 * t_s) / duration_s : 0);
  for (const stop of stops) {
    const tick = make("span", { title: `${time_text(stop.t_s)} ${stop.text}` });
    tick.style.left = `${percent(stop.t_s)}%`;
    if (stop.to_s > stop.t_s)
      tick.style.width = `max(3px, ${percent(stop.to_s - stop.t_s).toFixed(2)}%)`;
    tick.style.backgroundColor = stop.colour;
    tick.addEventListener("click", () => go_to(stop));
    lane.append(tick);
  }
  lane.hidden = stops.length === 0;
  return lane;
}
