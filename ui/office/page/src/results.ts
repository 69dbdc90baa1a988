// All results with what keeps them back, their release with the second factor, and the files for other systems.
import { routes, type ResultRow } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { fixed, tr } from "../report_src/words.ts";
import { get, post, type May } from "./api.ts";
import {
  act,
  code_field,
  decided_text,
  form,
  input,
  report_link,
  say,
  select,
  table,
  verdict_words,
  type View,
} from "./parts.ts";

/** States in which a result goes out by name only. */
const by_name = ["taken back", "marked otherwise", "questioned"];
const states = (): { [state: string]: string } => ({
  released: tr("released"),
  "to decide": tr("waits for a decision"),
  questioned: tr("questioned: released by name only"),
  "taken back": tr("taken back: released by name only"),
  "marked otherwise": tr(
    "filed after all of the exam was marked anew, and not marked so yet: released by name only",
  ),
  "not chosen": tr("another ending was chosen"),
  erased: tr("erased"),
  "made up": tr("does not count: a makeup sitting was given"),
  ready: tr("ready for release"),
});

export async function results(may: May, second_factor: boolean): Promise<View> {
  const list = make("div"),
    taking = make("div"),
    going = may(routes.release) ? new Going(second_factor) : null,
    counts = make("ul", { class: "counts" }),
    reports = may(routes.report);
  const show = async (): Promise<void> => {
    const { results } = await get(routes.results);
    going?.take(results);
    if (may(routes.retract) && second_factor)
      taking.replaceChildren(
        ...retraction(
          results.filter((r) => r.shown),
          show,
        ),
      );
    if (results.length === 0)
      return void list.replaceChildren(make("p", {}, tr("Nothing is filed yet.")));
    const named = results.some((r) => r.id !== undefined);
    const words = states();
    const of_state = Object.keys(words)
      .map((s): [string, number] => [words[s], results.filter((r) => r.state === s).length])
      .filter(([, n]) => n > 0);
    counts.replaceChildren(
      ...of_state.map(([word, n]) => make("li", {}, `${word}: `, make("b", {}, String(n)))),
    );
    const rows = results.map((r) => [
      String(r.session),
      ...(named ? [r.id ?? "", r.name ?? ""] : []),
      r.candidate,
      r.exam,
      verdict_words()[r.verdict] ?? r.verdict,
      r.points === undefined ? "" : tr("{0} of {1}", fixed(r.points, 1), r.max ?? ""),
      [
        words[r.state] ?? r.state,
        ...(r.why_back !== "" ? [tr("reason: {}", r.why_back)] : []),
        ...(r.grade !== undefined && r.points !== undefined && Math.abs(r.grade - r.points) > 1e-6
          ? [tr("grade in the gradebook: {}", fixed(r.grade, 1))]
          : []),
        ...(r.decided !== undefined ? [decided_text(r.decided)] : []),
        ...(r.seat !== "" && r.station !== "" && r.seat !== r.station
          ? [tr("sat at {0}, not at {1}", r.station, r.seat)]
          : []),
        ...(r.out
          ? [
              tr(
                "still out: {0}, {1} points",
                verdict_words()[r.out.verdict] ?? r.out.verdict,
                fixed(r.out.points ?? 0, 1),
              ),
            ]
          : []),
        ...(r.later !== undefined ? [tr("a later attempt counts: entry {}", r.later)] : []),
        ...(r.makes_up !== undefined ? [tr("makeup sitting of ticket {}", r.makes_up)] : []),
        ...(r.made_up_by !== undefined ? [tr("ticket {}", r.made_up_by)] : []),
        ...(r.appeal ? [tr("an appeal is open")] : []),
        ...(r.simulated !== "" ? [tr("simulated")] : []),
        ...r.findings.map((f) => f.text),
      ].join("; "),
      ...(reports ? [r.sha256 !== "" ? report_link(r.sha256) : ""] : []),
    ]);
    const headings = [
      tr("Entry"),
      ...(named ? [tr("Number"), tr("Name")] : []),
      tr("Pseudonym"),
      tr("Exam"),
      tr("Verdict"),
      tr("Points"),
      tr("State"),
      ...(reports ? [tr("Report")] : []),
    ];
    list.replaceChildren(table(tr("Results: {}", results.length), headings, rows));
  };
  await show();
  const root = make(
    "div",
    {},
    make("h1", {}, tr("Results")),
    act(tr("Look again"), {}, show),
    counts,
  );
  if (going !== null) root.append(going.open(show));
  const files = make("ul");
  if (may(routes.gradebook))
    files.append(
      make(
        "li",
        {},
        make(
          "a",
          { href: routes.gradebook.path, download: "gradebook.csv" },
          tr("Gradebook (CSV for Moodle), with names: what is released"),
        ),
      ),
    );
  if (may(routes.criteria))
    files.append(
      make(
        "li",
        {},
        make(
          "a",
          { href: routes.criteria.path, download: "criteria.csv" },
          tr("Every criterion (CSV), pseudonyms alone"),
        ),
      ),
    );
  root.append(make("h2", {}, tr("Files")), files, taking, list);
  return { root };
}

/** What was released goes back; nothing where nothing was. */
function retraction(released: ResultRow[], show: () => Promise<void>): HTMLElement[] {
  if (released.length === 0) return [];
  const which = select(tr("Released result"), [
    ["", tr("choose …")],
    ...released.map((r): [string, string] => [
      String(r.session),
      [tr("entry {}", r.session), r.name ?? "", r.candidate].filter((t) => t !== "").join(", "),
    ]),
  ]);
  which.required = true;
  const reason = input(
    tr("Reason"),
    { required: "", maxlength: "2000", autocomplete: "off" },
    tr("Kept for ever: no names."),
  );
  const code = code_field();
  return [
    make(
      "details",
      {},
      make("summary", {}, tr("Take a result back")),
      make(
        "p",
        {},
        tr(
          "It stands in no file from then on. What was handed out before is still with whoever has it.",
        ),
      ),
      form(
        tr("Take it back"),
        async () => {
          const { entry } = await post(routes.retract, {
            sessions: [Number(which.value)],
            reason: reason.value,
            code: code.value,
          });
          await show();
          say(tr("Taken back: entry {}.", entry));
        },
        which.block,
        reason.block,
        code.block,
      ),
    ),
  ];
}

/** What goes out: all that this page shows as ready, those of one exam, or one result by name; nothing that came since. */
class Going {
  private readonly what = select(tr("What goes out"), []);
  private choices = new Map<string, { results: number[]; with_findings: boolean }>();

  constructor(private readonly second_factor: boolean) {}

  take(results: ResultRow[]): void {
    const ready = results.filter((r) => r.state === "ready");
    const exams = [...new Set(ready.map((r) => r.exam))];
    const one = (r: ResultRow): [string, ResultRow[]] => [
      [
        tr("entry {}", r.session),
        r.name ?? "",
        r.candidate,
        r.exam,
        ...(r.state === "ready" ? [] : [states()[r.state]]),
      ]
        .filter((t) => t !== "")
        .join(", "),
      [r],
    ];
    const rows: [string, ResultRow[]][] = [
      [tr("all that are ready: {}", ready.length), ready],
      ...(exams.length > 1
        ? exams.map((e): [string, ResultRow[]] => [
            tr("ready of {0}: {1}", e, ready.filter((r) => r.exam === e).length),
            ready.filter((r) => r.exam === e),
          ])
        : []),
      ...results.filter((r) => by_name.includes(r.state)).map(one),
      ...ready.map(one),
    ];
    const chosen = this.what.value;
    this.choices = new Map(
      rows.map(([, all], i) => [
        i === 0 ? "all" : all.map((r) => r.result).join(),
        {
          results: all.map((r) => r.result),
          with_findings: all.some((r) => r.state === "questioned"),
        },
      ]),
    );
    this.what.replaceChildren(
      ...[...this.choices.keys()].map((key, i) => make("option", { value: key }, rows[i]![0])),
    );
    if (this.choices.has(chosen)) this.what.value = chosen;
  }

  open(show: () => Promise<void>): HTMLElement {
    const section = make("section", {}, make("h2", {}, tr("Release")));
    if (!this.second_factor) {
      section.append(
        make(
          "p",
          { class: "wrong" },
          tr("This account has no second factor, and releases nothing."),
        ),
      );
      return section;
    }
    const reason = input(
      tr("Reason"),
      { required: "", maxlength: "2000", autocomplete: "off" },
      tr("Kept for ever: no names."),
    );
    const code = code_field();
    section.append(
      make(
        "p",
        {},
        tr(
          "What waits for a decision stays. What has changed since this page was loaded refuses the release.",
        ),
      ),
      form(
        tr("Release"),
        async () => {
          const { results, with_findings } = this.choices.get(this.what.value)!;
          if (results.length === 0) throw new Error(tr("Nothing is ready."));
          try {
            const done = await post(routes.release, {
              results,
              with_findings,
              reason: reason.value,
              code: code.value,
            });
            await show();
            say(tr("Released: {}.", done.released));
          } catch (wrong) {
            await show();
            throw wrong;
          } finally {
            code.value = "";
          }
        },
        this.what.block,
        reason.block,
        code.block,
      ),
    );
    return section;
  }
}
