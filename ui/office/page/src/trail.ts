// Every entry of the ledger in words, the newest first; of one candidate where that is asked.
import { routes, type EntryKind, type TrailEntry } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { post } from "./api.ts";
import { act, form, input, local_time, table, time_zone, type View } from "./parts.ts";

/** Where one kind does several things, which of them. */
type What = EntryKind | "makeup" | "begin again" | "session with findings" | "decision";
const whats = (): { [what in What]: string } => ({
  init: tr("Ledger begun"),
  ticket: tr("Ticket issued"),
  makeup: tr("Makeup sitting"),
  cancel: tr("Ticket cancelled"),
  begin: tr("Exam let begin"),
  "begin again": tr("Exam let begin again"),
  session: tr("Exam filed"),
  "session with findings": tr("Exam filed, with findings"),
  regrade: tr("Marked anew"),
  decision: tr("Decided"),
  release: tr("Released"),
  retract: tr("Taken back"),
  appeal: tr("Appeal entered"),
  answer: tr("Appeal answered"),
  announce: tr("Announcement"),
  hold: tr("Exams paused"),
  go_on: tr("Pause ended"),
  incident: tr("Incident noted"),
  seats: tr("Seats given"),
  passback: tr("Score sent to a learning platform, its answer"),
  forget: tr("Candidate forgotten"),
  erase: tr("Erased"),
  key: tr("Key of the school changed"),
  restore: tr("Restored from a backup"),
  invite: tr("Station invited"),
  enrol: tr("Station enrolled"),
  revoke: tr("Station revoked"),
  room: tr("Room of a station"),
});

function who(e: TrailEntry): string {
  const first = e.people[0];
  if (first === undefined) return e.count === 0 ? "" : tr("{} candidates", e.count);
  return [first.id ?? "", first.name ?? ""].filter((t) => t !== "").join(" ") || first.candidate;
}

export async function trail(): Promise<View> {
  const list = make("div");
  const words: { [what: string]: string } = whats();
  let about = "";
  const show = async (before?: number): Promise<void> => {
    const { entries, earlier } = await post(routes.trail, { about, before });
    if (entries.length === 0)
      return void list.replaceChildren(make("p", {}, tr("Nothing was entered.")));
    const rows = entries.map((e) => [
      String(e.entry),
      local_time(e.utc),
      e.number > 1 ? `${words[e.what] ?? e.what} (${e.number})` : (words[e.what] ?? e.what),
      who(e),
      e.why,
      e.by,
    ]);
    list.replaceChildren(
      table(
        tr(
          "Entries {0} to {1}, the newest first; times in {2}",
          entries[0]!.entry,
          entries[entries.length - 1]!.entry,
          time_zone(),
        ),
        [tr("Entry"), tr("When"), tr("What"), tr("Candidate"), tr("Why"), tr("Who")],
        rows,
      ),
    );
    if (earlier !== undefined) list.append(act(tr("Earlier entries"), {}, () => show(earlier)));
  };
  const one = input(
    tr("Only of this candidate"),
    { maxlength: "200", autocomplete: "off" },
    tr("Number or pseudonym. Empty: all."),
  );
  const asked = form(
    tr("Show"),
    async () => {
      about = one.value.trim();
      await show();
    },
    one.block,
  );
  await show();
  return {
    root: make(
      "div",
      {},
      make("h1", {}, tr("Trail")),
      make(
        "p",
        {},
        tr("Whatever changed something is an entry of the ledger, and none is ever changed."),
      ),
      asked,
      list,
    ),
  };
}
