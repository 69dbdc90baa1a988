// From a class list to tickets: paste or file, what was found in it, an answer for each column, a preview, and then the tickets.
import { routes, type ClassList, type Issued, type Preview } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import {
  field,
  form,
  input,
  length_words,
  local_span,
  say,
  select,
  table,
  time_zone,
  utc,
  type View,
} from "./parts.ts";

const k_portion = 100;

function base64(bytes: Uint8Array): string {
  let binary = "";
  for (let i = 0; i < bytes.length; i += 8192)
    binary += String.fromCharCode(...bytes.subarray(i, i + 8192));
  return btoa(binary);
}

const separators = (): { [sign: string]: string } => ({
  ",": tr("comma"),
  ";": tr("semicolon"),
  "\t": tr("tab"),
  "|": tr("bar"),
});
const uses = (): { [name: string]: string } => ({
  id: tr("Candidate's number (id)"),
  name: tr("Name"),
  station: tr("Station"),
  extra_time_percent: tr("Extra time, per cent"),
  extra_time_s: tr("Extra time, seconds"),
  left_handed: tr("Left-handed (yes or no)"),
  high_contrast: tr("High contrast (yes or no)"),
});

/** What was pasted or chosen last and what was answered about its columns, by their headings: kept while the tab lives and somebody is signed in. */
const nothing = () => ({
  text: "",
  file: "",
  bytes: new Uint8Array(),
  answers: new Map<string, string>(),
});
let kept = nothing();
export function forget_list(): void {
  kept = nothing();
}

class Roster {
  readonly root = make("div", {}, make("h1", {}, tr("Class list")));
  private bytes = new Uint8Array();
  private answers: string[] = [];
  private readonly found = make("div");

  constructor() {
    const known = tr(
      "Columns that are known: {}. Only id is needed; about any other column you are asked.",
      Object.keys(uses()).join(", "),
    );
    const text = field(
      tr("Paste the list, with its line of column names"),
      make("textarea", { spellcheck: "false" }),
      known,
    );
    text.value = kept.text;
    text.addEventListener("input", () => (kept.text = text.value));
    const file = field(
      tr("or choose a file (CSV)"),
      make("input", { type: "file", accept: ".csv,.txt,.tsv,text/csv,text/plain" }),
      kept.file === ""
        ? ""
        : tr(
            "{} is still here, as it was chosen: it is read when you paste nothing and choose no other.",
            kept.file,
          ),
    );
    const read = form(
      tr("Read the list"),
      async () => {
        const chosen = file.files?.[0];
        if (chosen !== undefined) {
          kept.file = chosen.name;
          kept.bytes = new Uint8Array(await chosen.arrayBuffer());
        }
        this.bytes =
          chosen !== undefined || text.value === ""
            ? kept.bytes
            : new TextEncoder().encode(text.value);
        this.answers = [];
        await this.look();
      },
      text.block,
      file.block,
    );
    this.root.append(read, this.found);
  }

  private asked(): ClassList {
    return { base64: base64(this.bytes), answers: this.answers };
  }

  private async look(): Promise<void> {
    let preview = await post(routes.preview, this.asked());
    if (this.answers.length === 0) {
      // read anew: a column of the same heading keeps its answer
      const headings = preview.columns.map((c) => c.heading);
      this.answers = preview.columns.map(
        (c) =>
          (headings.filter((h) => h === c.heading).length === 1
            ? kept.answers.get(c.heading)
            : undefined) ?? c.use,
      );
      if (this.answers.some((a, i) => a !== preview.columns[i].use))
        preview = await post(routes.preview, this.asked());
    }
    this.answers = preview.columns.map((c) => c.use);
    this.found.replaceChildren(make("h2", { tabindex: "-1" }, tr("What was found")));
    if (preview.columns.length > 0 && !preview.headed)
      this.found.append(
        make(
          "p",
          { class: "wrong", role: "alert" },
          tr(
            "No known column stands in the first line: {}. Is it a candidate? Then he would get no ticket: write a line of column names above him, and read the list again.",
            preview.columns.map((c) => c.heading).join("; "),
          ),
        ),
      );
    if (preview.columns.length > 0) {
      this.found.append(
        make(
          "p",
          {},
          tr(
            "Candidates: {0}; encoding: {1}; fields parted by: {2}",
            preview.rows,
            preview.encoding,
            separators()[preview.separator] ?? preview.separator,
          ),
        ),
      );
      this.found.append(this.columns(preview));
    }
    const open = preview.columns.filter((c) => c.use === "").length;
    for (const problem of preview.problems)
      this.found.append(make("p", { class: "wrong" }, problem));
    if (open > 0)
      this.found.append(
        make(
          "p",
          { class: "wrong", id: "open-columns" },
          tr("Columns that wait for your answer: {}. Use each, or pass it over.", open),
        ),
      );
    if (preview.people.length > 0)
      this.found.append(this.people(preview), await this.issue(preview.longest_s));
    this.found.querySelector("h2")!.focus();
  }

  private columns(preview: Preview): HTMLElement {
    const names = uses();
    const rows = preview.columns.map((c, i) => {
      const choices: [string, string][] = [
        ["", tr("choose …")],
        ...preview.uses.map((u): [string, string] => [u, names[u] ?? u]),
        ["pass over", tr("Pass over: not needed")],
      ];
      const list = select(tr("Use of column {}", c.heading), choices, c.use);
      list.block.querySelector("label")!.remove();
      list.setAttribute("aria-label", tr("Use of column {}", c.heading));
      list.addEventListener("change", () => {
        this.answers[i] = list.value;
        kept.answers.set(c.heading, list.value);
        this.look().catch((wrong: Error) => say(wrong.message, true));
      });
      return [c.heading, c.samples.join("; "), list.block];
    });
    const hint = make(
      "p",
      { class: "hint" },
      tr(
        "Surname and first name in two columns: use both as Name, and they are joined, with a comma between them.",
      ),
    );
    return make(
      "div",
      {},
      hint,
      table(tr("Columns of the list"), [tr("Column"), tr("First values"), tr("Use")], rows),
    );
  }

  private people(preview: Preview): HTMLElement {
    return table(
      tr("Who gets a ticket"),
      [tr("Number"), tr("Name"), tr("Station"), tr("Accommodations")],
      preview.people.map((p) => [p.id, p.name, p.station, p.accommodations]),
    );
  }

  private async issue(longest_s: { [exam: string]: number }): Promise<HTMLElement> {
    const { exams } = await get(routes.exams);
    const exam = select(
      tr("Exam"),
      exams.map((e) => [
        e.id,
        `${e.title} (${e.id}): ${length_words(e.time_limit_s, longest_s[e.id] ?? 0)}`,
      ]),
    );
    const zone = tr("In your computer's time zone, {}.", time_zone());
    const from = input(tr("May begin from"), { type: "datetime-local", required: "" }, zone);
    const until = input(tr("May begin until"), { type: "datetime-local", required: "" }, zone);
    const at_once = input(
      tr("Candidates in a sitting"),
      { type: "number", min: "1", max: "10000", step: "1" },
      tr("As many as there are stations, in the order of the list. Empty: all in one sitting."),
    );
    const apart = input(
      tr("Minutes from one sitting to the next"),
      { type: "number", min: "1", max: "10080", step: "1" },
      tr("Each later sitting may begin that much later."),
    );
    const overlap = make("input", { type: "checkbox", id: "sittings-overlap" });
    const may_overlap = make(
      "label",
      { class: "beside", for: overlap.id },
      overlap,
      tr("Sittings may overlap: one may begin while the last is still sat"),
    );
    apart.block.hidden = may_overlap.hidden = true;
    at_once.addEventListener("input", () => {
      apart.block.hidden = may_overlap.hidden = at_once.value === "";
      apart.required = at_once.value !== "";
    });
    const sittings = (): { at_once?: number; minutes_apart?: number; overlap?: boolean } =>
      at_once.value === ""
        ? {}
        : {
            at_once: Number(at_once.value),
            minutes_apart: Number(apart.value),
            overlap: overlap.checked,
          };
    const word = make("input", { type: "checkbox", id: "begin-at-office" });
    const another = make("input", { type: "checkbox", id: "another-attempt" });
    const reason = input(
      tr("Reason"),
      { required: "", maxlength: "2000", autocomplete: "off" },
      tr("Kept for ever: no names."),
    );
    const out = make("div");
    const asked = form(
      tr("Issue the tickets"),
      async () => {
        const wish = {
          ...this.asked(),
          exam: exam.value,
          from: utc(from.value),
          until: utc(until.value),
          ...sittings(),
          begin_at_office: word.checked,
          another: another.checked,
          reason: reason.value,
        };
        const done: Issued = { issued: [], refused: [], done: 0, of: 1 };
        while (done.done < done.of) {
          // by portions: the office hears stations in between
          const next = await post(routes.issue, { ...wish, first: done.done, most: k_portion });
          done.issued.push(...next.issued);
          done.refused.push(...next.refused);
          done.done = next.done;
          done.of = next.of;
          say(tr("{0} of {1} …", done.done, done.of));
        }
        say(
          tr("Issued: {0}. Refused: {1}.", done.issued.length, done.refused.length),
          done.refused.length > 0,
        );
        out.replaceChildren(
          table(
            tr("Issued"),
            [tr("Number"), tr("Name"), tr("Pseudonym"), tr("May begin"), tr("Station")],
            done.issued.map((p) => [
              p.id,
              p.name,
              p.candidate,
              local_span(p.not_before, p.not_after),
              p.station,
            ]),
          ),
        );
        if (done.refused.length > 0)
          out.append(
            table(
              tr("Refused"),
              [tr("Number"), tr("Name"), tr("Why")],
              done.refused.map((p) => [p.id, p.name, p.why]),
            ),
          );
      },
      exam.block,
      from.block,
      until.block,
      at_once.block,
      apart.block,
      may_overlap,
      make(
        "label",
        { class: "beside", for: word.id },
        word,
        tr("Begins only when the office lets it (stations need the network)"),
      ),
      make(
        "label",
        { class: "beside", for: another.id },
        another,
        tr(
          "Also to those who have a good ticket for it, or have sat it: of several attempts the last one that is released counts",
        ),
      ),
      reason.block,
    );
    return make("section", {}, make("h2", {}, tr("Tickets for them")), asked, out);
  }
}

export async function roster(): Promise<View> {
  return { root: new Roster().root };
}
