// The report's page: fills in the 3D view, the scrubber and the charts, and wires the buttons that jump to a moment. Everything else in the
// document was written by the program and stays as it is.
import { Charts, number_text } from "./charts.ts";
import { AdjacentView } from "./compared.ts";
import { Clock } from "./clock.ts";
import { read_data, type ReportData, type Vec3 } from "./data.ts";
import { k_distance_edges, k_heat_edges } from "./deviation.ts";
import { make, reduced_motion } from "./dom.ts";
import { Recording } from "./motion.ts";
import { Player } from "./player.ts";
import { ToothControls } from "./tooth_controls.ts";
import { ToothField } from "./tooth_field.ts";
import { ToothView } from "./view.ts";
import { fixed, set_words, tr } from "./words.ts";

function say_why(section: HTMLElement, why: string): void {
  let place = section.querySelector(".fallback");
  if (!place) {
    place = make("p", { class: "fallback" });
    section.append(place);
  }
  place.textContent = why;
}

function webgl_works(): boolean {
  try {
    return document.createElement("canvas").getContext("webgl2") !== null;
  } catch {
    return false;
  }
}

interface Shown {
  view: ToothView;
  beside: AdjacentView | null;
}

function tooth_in(section: HTMLElement, data: ReportData, clock: Clock | null): Shown | null {
  if (!webgl_works()) {
    say_why(
      section,
      tr(
        "The tooth cannot be shown in 3D: this browser offers no WebGL 2 here (it may be switched off, or the graphics driver may not support it). Everything else on this page works.",
      ),
    );
    return null;
  }
  const heat = data.kind === "class";
  const edges = heat ? k_heat_edges : k_distance_edges;
  const whole = heat ? 1 : (data.scale_mm ?? 0.5);
  const field = new ToothField(data);
  const canvas = make("canvas");
  const controls = new ToothControls(canvas, field, data, {
    edges,
    whole,
    with_instrument: (data.instruments ?? []).length > 0,
    go_to: clock
      ? (t) => {
          clock.pause();
          clock.set(t);
        }
      : undefined,
  });
  section.append(controls.element);
  try {
    const view = new ToothView(canvas, field, data, { edges, whole });
    controls.connect(view);
    section.querySelector(".fallback")?.remove();
    return {
      view,
      beside:
        data.beside && clock
          ? new AdjacentView(controls.frame, view, data, data.beside, { edges, whole }, clock)
          : null,
    };
  } catch (error) {
    controls.element.remove();
    say_why(
      section,
      tr(
        "The tooth cannot be shown in 3D: {}. Everything else on this page works.",
        error instanceof Error ? error.message : String(error),
      ),
    );
    return null;
  }
}

/** Each cell knows its heading: on a narrow screen rows are cards. */
function label_cells(table: HTMLTableElement): void {
  const headings = [...(table.tHead?.rows[0]?.cells ?? [])].map((cell) => cell.textContent ?? "");
  for (const row of [...table.tBodies].flatMap((body) => [...body.rows]))
    [...row.cells].forEach((cell, i) => {
      if (headings[i]) cell.dataset["label"] = headings[i];
    });
  table.classList.add("stack");
}

/** Tables that are wider than their place even so scroll by themselves, by keyboard too. */
function hold_wide_tables(): void {
  for (const table of document.querySelectorAll("table")) {
    label_cells(table);
    if (table.parentElement?.classList.contains("wide")) continue;
    const holder = make("div", { class: "wide" });
    table.before(holder);
    holder.append(table);
    const name = table.getAttribute("aria-label") ?? table.caption?.textContent ?? tr("Table");
    new ResizeObserver(() => {
      const wide = holder.scrollWidth > holder.clientWidth + 1;
      for (const [attribute, value] of [
        ["tabindex", "0"],
        ["role", "region"],
        ["aria-label", name],
      ]) {
        if (wide) holder.setAttribute(attribute, value);
        else holder.removeAttribute(attribute);
      }
    }).observe(holder);
  }
}

function start(): void {
  const data = read_data(document);
  set_words(data.words, data.decimal_sign);
  hold_wide_tables();
  document.documentElement.classList.add("scripted");
  document.documentElement.classList.toggle("high-contrast", data.high_contrast === true);
  const session = data.kind === "session" && data.motion !== undefined;
  const clock = session
    ? new Clock(Math.max(data.duration_s ?? 0, data.beside?.duration_s ?? 0))
    : null;
  const tooth = document.getElementById("tooth-3d");
  const shown = tooth ? tooth_in(tooth, data, clock) : null;
  const view = shown?.view;
  if (!clock || !data.motion) return;

  const events = [...(data.events ?? [])].sort((a, b) => a.t_s - b.t_s);
  const recording = new Recording(data.motion);
  clock.on_time((t) => {
    view?.mark(null); // a mark belongs to its moment
    view?.show(t, recording.at(t));
  });
  const measured = (t: number): string => {
    const at = recording.at(t);
    return at.depth_mm < 0
      ? tr(
          "{} N · {} mm above the opening · {} rpm",
          fixed(at.force_n, 2),
          fixed(-at.depth_mm, 2),
          number_text(at.rpm, 0),
        )
      : tr(
          "{} N · {} mm deep · {} rpm",
          fixed(at.force_n, 2),
          fixed(at.depth_mm, 2),
          number_text(at.rpm, 0),
        );
  };
  const player = new Player(
    clock,
    events,
    data.moments ?? [],
    (site_mm) => view?.mark(site_mm),
    measured,
  );
  if (tooth) {
    const frame = tooth.querySelector(".side-by-side, .view");
    if (frame) frame.after(player.element);
    else tooth.append(player.element);
  }
  if (shown?.beside && data.beside)
    player.add_adjacent(data.beside.name, shown.beside.axis, shown.beside.choice);
  const charts = document.getElementById("charts");
  if (charts && recording.n > 0) {
    new Charts(charts, recording, events, clock);
    charts.querySelector(".fallback")?.remove();
  }

  for (const jump of document.querySelectorAll<HTMLElement>(".jump"))
    jump.addEventListener("click", () => {
      clock.pause();
      clock.set(Number(jump.dataset.t));
      const site = [jump.dataset.x, jump.dataset.y, jump.dataset.z];
      view?.mark(site.every((v) => v !== undefined) ? (site.map(Number) as Vec3) : null);
      tooth?.scrollIntoView({ behavior: reduced_motion() ? "auto" : "smooth", block: "start" });
    });

  const from_address = (): void => {
    const found = /^#t=([0-9]+(?:\.[0-9]+)?)$/.exec(location.hash);
    if (found) clock.set(Number(found[1]));
  };
  window.addEventListener("hashchange", from_address);
  clock.set(clock.duration_s); // what the exam left
  from_address();
}

start();
