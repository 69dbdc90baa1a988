// A makeup sitting for who missed an exam, or whose exam was interrupted: a form below its ticket.
import { routes, type MakeUp, type TicketRow } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { post } from "./api.ts";
import { form, input, opens_form, say, select, time_zone, utc } from "./parts.ts";

export function with_makeup(t: TicketRow, show: () => Promise<void>): HTMLElement {
  return opens_form(tr("Makeup"), { "aria-label": tr("Makeup sitting for {}", t.candidate) }, () =>
    fields(t, show),
  );
}

function fields(t: TicketRow, show: () => Promise<void>): HTMLFormElement {
  const words: { [became: string]: string } = {
    missed: tr("was missed"),
    interrupted: tr("was interrupted"),
  };
  const became = select(tr("The first sitting"), [
    ["", tr("choose …")],
    ...t.makeup.map((b): [string, string] => [b, words[b] ?? b]),
  ]);
  const zone = tr("In your computer's time zone, {}.", time_zone());
  const from = input(tr("May begin from"), { type: "datetime-local", required: "" }, zone);
  const until = input(tr("May begin until"), { type: "datetime-local", required: "" }, zone);
  const granted = select(tr("Accommodations"), [
    ["", tr("choose …")],
    ...(t.grant_stored ? [["as before", tr("as on the first ticket")] as [string, string]] : []),
    ["none", tr("none")],
    ["these", tr("these:")],
  ]);
  const percent = input(tr("Extra time, per cent"), {
    type: "number",
    min: "0",
    max: "400",
    step: "any",
  });
  const seconds = input(tr("Extra time, seconds"), {
    type: "number",
    min: "0",
    max: "36000",
    step: "any",
  });
  const left = make("input", { type: "checkbox" }),
    contrast = make("input", { type: "checkbox" }),
    word = make("input", { type: "checkbox" });
  const these = make(
    "div",
    { hidden: "" },
    percent.block,
    seconds.block,
    make("label", { class: "beside" }, left, tr("Left-handed")),
    make("label", { class: "beside" }, contrast, tr("High contrast")),
  );
  const reason = input(
    tr("Reason"),
    { required: "", maxlength: "2000", autocomplete: "off" },
    tr("Kept for ever: no names."),
  );
  became.required = granted.required = true;
  granted.addEventListener("change", () => (these.hidden = granted.value !== "these"));
  const number = (text: string): number | undefined => (text === "" ? undefined : Number(text));
  const hint = t.grant_stored
    ? ""
    : tr("The office does not keep what was granted: look at the class list.");
  return form(
    tr("Give the makeup"),
    async () => {
      const done = await post(routes.make_up, {
        ticket: t.entry,
        became: became.value,
        from: utc(from.value),
        until: utc(until.value),
        begin_at_office: word.checked,
        reason: reason.value,
        accommodations: granted.value as MakeUp["accommodations"],
        extra_time_percent: number(percent.value),
        extra_time_s: number(seconds.value),
        left_handed: left.checked,
        high_contrast: contrast.checked,
      });
      await show();
      say(
        done.accommodations === ""
          ? tr("{} has a makeup sitting, without accommodations.", done.candidate)
          : tr("{0} has a makeup sitting: {1}.", done.candidate, done.accommodations),
      );
    },
    make(
      "p",
      { class: "hint" },
      tr("From now on the makeup counts, whatever became of the first sitting."),
    ),
    became.block,
    from.block,
    until.block,
    granted.block,
    ...(hint === "" ? [] : [make("p", { class: "hint" }, hint)]),
    these,
    make(
      "label",
      { class: "beside" },
      word,
      tr("Begins only when the office lets it (stations need the network)"),
    ),
    reason.block,
  );
}
