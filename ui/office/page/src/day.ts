// What people do on an exam day: pause exams and let them go on, announce, and see who is not here.
import { routes, type ForWhom, type Notice, type StationShown } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import { act, form, input, local_time, say, select, table, with_reason } from "./parts.ts";

/** For whom something is: all, a room, a station. Touched only when these are others: somebody may be choosing. */
export class Choice {
  readonly list = select(tr("For"), [["all", tr("all stations")]]);
  private held = "";

  take(stations: StationShown[]): void {
    const good = stations.filter((s) => !s.revoked);
    const now = JSON.stringify(good.map((s) => [s.public_key, s.name, s.room]));
    if (now === this.held) return;
    this.held = now;
    const chosen = this.list.value;
    const rooms = [...new Set(good.map((s) => s.room).filter((r) => r !== ""))].sort();
    const choices: [string, string][] = [
      ["all", tr("all stations")],
      ...rooms.map((r): [string, string] => [`room ${r}`, tr("all in {}", r)]),
      ...good.map((s): [string, string] => [`station ${s.public_key}`, s.name]),
    ];
    this.list.replaceChildren(...choices.map(([value, text]) => make("option", { value }, text)));
    if (choices.some(([value]) => value === chosen)) this.list.value = chosen;
  }

  get audience(): ForWhom {
    const value = this.list.value;
    if (value.startsWith("room ")) return { room: value.slice(5) };
    return value.startsWith("station ") ? { station: value.slice(8) } : { all: true };
  }
}

export function whom(of: { room: string; stations: string[] }, stations: StationShown[]): string {
  if (of.stations.length === 0) return tr("all stations");
  if (of.room !== "") return tr("all in {}", of.room);
  return of.stations
    .map((key) => stations.find((s) => s.public_key === key)?.name ?? key.slice(0, 8))
    .join(", ");
}

/** Pauses: what stands still now, and a form for the next. */
export class Pauses {
  readonly root = make("section", { "aria-label": tr("Pauses") });
  private readonly now = make("div", { role: "status" });
  private readonly choice = new Choice();
  private held = "";

  constructor() {
    const reason = input(
      tr("Why"),
      { required: "", maxlength: "500", autocomplete: "off", value: tr("Fire alarm") },
      tr("Candidates read it."),
    );
    const pause = form(
      tr("Pause the exams"),
      async () => {
        await post(routes.hold, { reason: reason.value, to: this.choice.audience });
        more.open = false;
        say(tr("The exams stand still; each candidate keeps his time."));
      },
      this.choice.list.block,
      reason.block,
    );
    const more = make(
      "details",
      { class: "pause" },
      make("summary", {}, tr("Pause: fire alarm, power cut")),
      pause,
    );
    this.root.append(this.now, more);
  }

  take(holds: Notice[], stations: StationShown[]): void {
    this.choice.take(stations);
    const now = JSON.stringify(holds);
    if (now === this.held) return; // somebody may be typing why they go on
    this.held = now;
    this.now.replaceChildren(
      ...holds.map((h) =>
        make(
          "div",
          { class: "card held" },
          make("h2", {}, tr("Paused: {0} ({1})", h.text, whom(h, stations))),
          make("p", {}, tr("Since {}", local_time(new Date(h.utc_ns / 1e6).toISOString()))),
          with_reason(tr("Let them go on"), { class: "main" }, async (reason) => {
            await post(routes.go_on, { hold: h.entry, reason });
            say(
              holds.length > 1
                ? tr("This pause is over. Other pauses still last: {}.", holds.length - 1)
                : tr("The exams go on."),
            );
          }),
        ),
      ),
    );
  }
}

/** What candidates are told. */
export class Announcements {
  readonly root = make("section", {}, make("h2", {}, tr("Announce")));
  private readonly choice = new Choice();
  private readonly list = make("ul");

  constructor() {
    const text = input(tr("What candidates read"), {
      required: "",
      maxlength: "500",
      autocomplete: "off",
    });
    this.root.append(
      form(
        tr("Announce it"),
        async () => {
          await post(routes.announce, { text: text.value, to: this.choice.audience });
          text.value = "";
          say(tr("Announced. A station's card says when it was not read yet."));
        },
        this.choice.list.block,
        text.block,
      ),
      this.list,
    );
  }

  take(announcements: Notice[], stations: StationShown[]): void {
    this.choice.take(stations);
    this.list.replaceChildren(
      ...announcements
        .slice(0, 5)
        .map((a) =>
          make(
            "li",
            {},
            `${local_time(new Date(a.utc_ns / 1e6).toISOString())}, ${whom(a, stations)}: ${a.text}`,
          ),
        ),
    );
  }
}

/** Who should be here and is not, by name. */
export class Attendance {
  readonly root = make("section", {}, make("h2", {}, tr("Not here")));
  private readonly list = make("div");
  private held = "";

  constructor() {
    this.root.append(
      this.list,
      act(tr("Look again"), {}, () => this.look()),
    );
  }

  async look(): Promise<void> {
    const { missing } = await get(routes.attendance);
    const now = JSON.stringify(missing);
    if (now === this.held) return; // somebody may be looking for a name in it
    this.held = now;
    if (missing.length === 0)
      return void this.list.replaceChildren(
        make("p", {}, tr("Nobody is missing whose time has come.")),
      );
    const rows = missing.map((m) => [
      m.id,
      m.name,
      m.candidate,
      m.exam,
      m.seat,
      m.no_show
        ? make(
            "span",
            { class: "wrong" },
            tr("no-show: could begin until {}", local_time(m.not_after)),
          )
        : tr("may begin until {}", local_time(m.not_after)),
    ]);
    this.list.replaceChildren(
      table(
        tr("Not here: {}", missing.length),
        [tr("Number"), tr("Name"), tr("Pseudonym"), tr("Exam"), tr("Station"), tr("State")],
        rows,
      ),
    );
  }
}
