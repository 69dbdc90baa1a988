// What happened and no recording shows: a list, and a form for the next.
import { routes } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import { act, form, input, local_time, say, select, table, time_zone, type View } from "./parts.ts";

export async function incidents(): Promise<View> {
  const list = make("div");
  const show = async (): Promise<void> => {
    const { incidents } = await get(routes.incidents);
    if (incidents.length === 0)
      return void list.replaceChildren(make("p", {}, tr("Nothing was noted.")));
    const rows = incidents.map((i) => [
      String(i.entry),
      local_time(i.utc),
      i.station,
      [i.id, i.name].filter((t) => t !== "").join(" ") || i.candidate,
      i.erased ? tr("erased") : i.words,
      i.by,
    ]);
    list.replaceChildren(
      table(
        tr("Incidents: {0}; times in {1}", incidents.length, time_zone()),
        [tr("Entry"), tr("When"), tr("Station"), tr("Candidate"), tr("What"), tr("Noted by")],
        rows,
      ),
    );
  };
  const { stations } = await get(routes.board);
  const { tickets } = await get(routes.tickets);
  const none: [string, string] = ["", tr("none in particular")];
  const station = select(tr("Station"), [
    none,
    ...stations.filter((s) => !s.revoked).map((s): [string, string] => [s.public_key, s.name]),
  ]);
  const people = new Map(
    tickets.map((t) => [t.candidate, `${t.id} ${t.name}`.trim() || t.candidate]),
  );
  const candidate = select(tr("Candidate"), [none, ...people]);
  const words = input(
    tr("What happened"),
    { required: "", maxlength: "500", autocomplete: "off" },
    tr("Without names: it is kept until the candidate is forgotten."),
  );
  const asked = form(
    tr("Note it"),
    async () => {
      const { entry } = await post(routes.note_incident, {
        station: station.value,
        candidate: candidate.value,
        words: words.value,
      });
      words.value = "";
      await show();
      say(tr("Noted: entry {}.", entry));
    },
    station.block,
    candidate.block,
    words.block,
  );
  await show();
  return {
    root: make(
      "div",
      {},
      make("h1", {}, tr("Incidents")),
      asked,
      act(tr("Look again"), {}, show),
      list,
    ),
  };
}
