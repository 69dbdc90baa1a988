// The live board: every station as it speaks, what waits to be filed, and the stations' register.
import { routes, type BoardShown, type StationShown } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { listen, post, type May } from "./api.ts";
import { Announcements, Attendance, Pauses } from "./day.ts";
import { form, input, local_time, say, select, table, with_reason, type View } from "./parts.ts";

const silent_s = 15;
const states = (): { [state: string]: string } => ({
  free: tr("free"),
  check: tr("self-check"),
  briefing: tr("briefing"),
  exam: tr("exam under way"),
  paused: tr("paused"),
  ended: tr("exam ended"),
});
const groups = (): { [group: string]: string } => ({
  live: tr("live"),
  begun: tr("begun"),
  filed: tr("filed"),
  cancelled: tr("cancelled"),
  "run out": tr("run out"),
  "made up": tr("made up by another sitting"),
});

function clock(s: number): string {
  return `${Math.floor(s / 60)}:${String(Math.floor(s % 60)).padStart(2, "0")}`;
}

function card(s: StationShown, now_ns: number): HTMLElement {
  const lines = make("div");
  const element = make("li", { class: "card" }, make("h3", {}, s.name), lines);
  if (s.room !== "") lines.append(make("p", { class: "hint" }, s.room));
  if (s.revoked) {
    element.classList.add("silent");
    lines.append(make("p", {}, tr("Key revoked")));
    return element;
  }
  if (s.report === undefined) {
    element.classList.add("silent");
    lines.append(make("p", {}, tr("Has not spoken yet")));
    return element;
  }
  const ago_s = Math.max(0, Math.round((now_ns - s.report.seen_utc_ns) / 1e9));
  lines.append(make("p", {}, states()[s.report.state] ?? s.report.state));
  if (s.report.candidate !== "") lines.append(make("p", {}, make("code", {}, s.report.candidate)));
  if (s.report.step !== "") lines.append(make("p", {}, s.report.step));
  if (s.report.left_s >= 0) lines.append(make("p", {}, tr("{} left", clock(s.report.left_s))));
  if (s.hold !== 0)
    lines.append(
      make(
        "p",
        { class: s.report.held || s.report.state !== "exam" ? "" : "wrong" },
        s.report.held
          ? tr("Stands still: paused by the office")
          : s.report.state === "exam"
            ? tr("Paused by the office, and has not stopped yet")
            : tr("Paused by the office"),
      ),
    );
  if (s.unread > 0 && s.report.state !== "free")
    lines.append(make("p", {}, tr("Announcements not read yet: {}", s.unread)));
  if (s.twins.length > 0) {
    element.classList.add("alarm");
    const who = s.report.refused !== "" ? s.report.refused : s.report.candidate;
    lines.append(
      make(
        "p",
        { class: "wrong" },
        tr("{0} is at {1}, too: one ticket at two stations", who, s.twins.join(", ")),
      ),
    );
  }
  if (s.report.alarm !== "") {
    element.classList.add("alarm");
    lines.append(make("p", { class: "wrong" }, tr("Alarm: {}", s.report.alarm)));
  }
  if (ago_s > silent_s) {
    element.classList.add("silent");
    lines.append(make("p", { class: "wrong" }, tr("Silent for {}", clock(ago_s))));
  }
  return element;
}

export async function board(may: May): Promise<View> {
  const counts = make("ul", { class: "counts" });
  const cards = make("ul", { class: "cards" });
  const inbox = make("div");
  const line = make("p", { class: "hint" }, tr("Connecting …"));
  const pauses = new Pauses();
  const announcements = new Announcements();
  const attendance = new Attendance();
  const root = make(
    "div",
    {},
    make("h1", {}, tr("Exam day")),
    line,
    pauses.root,
    make("h2", {}, tr("Tickets")),
    counts,
    make("h2", {}, tr("Stations")),
    cards,
    announcements.root,
    attendance.root,
    make("h2", {}, tr("Exams that were handed in")),
    inbox,
  );
  const revocation = may(routes.revoke_station) ? new Revocation() : null;
  const placing = may(routes.place_station) ? new Placing() : null;
  let shown: BoardShown | null = null;
  let came_ms = 0;
  let counted = "";
  const draw = (): void => {
    if (shown === null) return;
    const now_ns = shown.utc_ns + (performance.now() - came_ms) * 1e6; // by the office's clock
    cards.replaceChildren(
      ...(shown.stations.length > 0
        ? shown.stations.map((s) => card(s, now_ns))
        : [make("li", {}, tr("No station is enrolled yet."))]),
    );
  };
  const take = (what: BoardShown): void => {
    shown = what;
    came_ms = performance.now();
    const names = groups();
    counts.replaceChildren(
      ...Object.keys(names).map((g) =>
        make("li", {}, make("b", {}, String(what.tickets[g] ?? 0)), ` ${names[g]}`),
      ),
    );
    inbox.replaceChildren(
      make("p", {}, tr("Waiting to be verified and filed: {}", what.inbox.waiting)),
    );
    if (what.inbox.trouble !== "") inbox.append(make("p", { class: "wrong" }, what.inbox.trouble));
    if (what.inbox.refused.length > 0)
      inbox.append(
        table(
          tr("Refused"),
          [tr("Station"), tr("Candidate"), tr("Why"), tr("Recording")],
          what.inbox.refused.map((r) => [
            r.station === "" ? tr("unknown") : r.station,
            r.candidate,
            r.findings.map((f) => f.text).join("; "),
            make("code", {}, r.sha256.slice(0, 16)),
          ]),
        ),
      );
    revocation?.take(what.stations);
    placing?.take(what.stations);
    pauses.take(what.holds, what.stations);
    announcements.take(what.announcements, what.stations);
    const now = JSON.stringify([what.tickets, what.stations.map((s) => s.report?.candidate ?? "")]);
    if (now !== counted) attendance.look().catch((wrong: Error) => say(wrong.message, true));
    counted = now;
    draw();
  };
  const source = listen(routes.board_events, (now) => {
    line.textContent = tr("Live");
    take(now);
  });
  source.onerror = () => {
    line.textContent = tr("The office does not answer; trying again …");
    if (source.readyState === EventSource.CLOSED) window.dispatchEvent(new Event("signed-out"));
  };
  const timer = setInterval(draw, 1000);
  const missing_timer = setInterval(() => void attendance.look().catch(() => undefined), 10_000); // a time comes by the clock alone
  if (may(routes.invite_station)) root.append(invite());
  if (placing !== null) root.append(placing.root);
  if (revocation !== null) root.append(revocation.root);
  return {
    root,
    leave: () => {
      source.close();
      clearInterval(timer);
      clearInterval(missing_timer);
    },
  };
}

function invite(): HTMLElement {
  const name = input(
    tr("Name of the station"),
    { required: "", maxlength: "100", autocomplete: "off" },
    tr("As people call it: Seat 3."),
  );
  const out = make("p");
  return make(
    "section",
    {},
    make("h2", {}, tr("Invite a station")),
    form(
      tr("Make a code"),
      async () => {
        const made = await post(routes.invite_station, { name: name.value });
        out.replaceChildren(
          tr(
            "One-time code of {0}, good until {1}, shown only now:",
            name.value,
            local_time(made.until),
          ),
          " ",
          make("code", {}, made.code),
        );
        say(tr("Type the code at the station."));
      },
      name.block,
    ),
    out,
  );
}

/** Stations by name in a list, touched only when they are others: somebody may be choosing. Where the chosen one is gone, none is. */
class StationList {
  readonly list = select(tr("Station"), []);
  private held = "";

  constructor() {
    this.list.required = true;
  }

  take(stations: StationShown[]): void {
    const good = stations.filter((s) => !s.revoked);
    const now = JSON.stringify(good.map((s) => [s.public_key, s.name]));
    if (now === this.held) return;
    this.held = now;
    const chosen = this.list.value;
    this.list.replaceChildren(
      make("option", { value: "" }, tr("choose …")),
      ...good.map((s) => make("option", { value: s.public_key }, s.name)),
    );
    if (good.some((s) => s.public_key === chosen)) this.list.value = chosen;
  }
}

class Placing {
  private readonly stations = new StationList();
  readonly root = make("section", {}, make("h2", {}, tr("Room of a station")));

  constructor() {
    const room = input(tr("Room"), { maxlength: "80", autocomplete: "off" }, tr("Empty: in none."));
    this.root.append(
      form(
        tr("It stands there"),
        async () => {
          await post(routes.place_station, {
            public_key: this.stations.list.value,
            room: room.value,
          });
          say(tr("The board shows it."));
        },
        this.stations.list.block,
        room.block,
      ),
    );
  }

  take(stations: StationShown[]): void {
    this.stations.take(stations);
  }
}

class Revocation {
  private readonly stations = new StationList();
  readonly root = make("section", {}, make("h2", {}, tr("Revoke a station's key")));

  constructor() {
    const { list } = this.stations;
    this.root.append(
      with_reason(
        tr("Revoke"),
        { class: "bad" },
        async (reason) => {
          const name = list.selectedOptions[0].text;
          await post(routes.revoke_station, { public_key: list.value, reason });
          list.value = "";
          say(tr("What {} sends from now on does not count.", name));
        },
        { asked: [list.block] },
      ),
    );
  }

  take(stations: StationShown[]): void {
    this.stations.take(stations);
  }
}
