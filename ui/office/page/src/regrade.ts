// A new rubric over all of an exam: chosen, tried on every session in the background, looked at, and then counted with a reason and a code, or dropped.
import { routes, type FiledExam, type RegradeAll, type RegradeShown } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { fixed, tr } from "../report_src/words.ts";
import { get, listen, post, type May } from "./api.ts";
import {
  act,
  code_field,
  field,
  form,
  input,
  local_time,
  say,
  select,
  table,
  verdict_words,
  type View,
} from "./parts.ts";

function left(s: number | undefined): string {
  if (s === undefined) return tr("how long it takes is not known yet");
  return s < 90
    ? tr("about {} s left", Math.max(1, Math.round(s)))
    : tr("about {} min left", Math.round(s / 60));
}

class Regrade implements View {
  readonly root = make("div", {}, make("h1", {}, tr("New rubric")));
  private readonly now = make("section", { "aria-label": tr("State") });
  private readonly begin = make("div");
  private readonly bar = make("progress", { id: "regrade-progress" });
  private readonly how_far = make("p");
  private shown = "";
  private events: EventSource | null = null;

  constructor(
    private readonly me: string,
    private readonly may: May,
    private readonly second_factor: boolean,
  ) {
    this.root.append(
      make(
        "p",
        {},
        tr(
          "All sessions of an exam are marked by it. Nothing counts before you have seen who would change.",
        ),
      ),
      this.now,
      this.begin,
    );
  }

  async open(): Promise<this> {
    await this.show();
    this.events = listen(routes.regrade_events, (now) => this.hear(now));
    return this;
  }
  leave(): void {
    this.events?.close();
  }

  private hear(s: RegradeShown): void {
    if (`${s.state} ${s.id}` !== this.shown)
      void this.show().catch((wrong: Error) => say(wrong.message, true));
    else if (s.state === "marking") this.progress(s);
  }

  private progress(s: RegradeShown): void {
    this.bar.max = Math.max(1, s.of);
    this.bar.value = s.done;
    this.how_far.textContent = tr("{0} of {1} sessions, {2}", s.done, s.of, left(s.left_s));
  }

  private async show(): Promise<void> {
    const s = await get(routes.regrade);
    this.shown = `${s.state} ${s.id}`;
    this.now.replaceChildren(...this.said(s));
    const free = s.state !== "marking" && s.state !== "ready";
    if (!free || !this.may(routes.begin_regrade)) this.begin.replaceChildren();
    else if (this.begin.childElementCount === 0) this.begin.append(this.choice(s.exams));
  }

  private said(s: RegradeAll): Node[] {
    if (s.state === "none") return [];
    const out: Node[] = [
      make("h2", {}, tr("{0}, tried by {1} since {2}", s.exam, s.by, local_time(s.begun))),
    ];
    if (s.state === "marking") {
      this.progress(s);
      out.push(
        make("label", { for: this.bar.id }, tr("Progress")),
        this.bar,
        this.how_far,
        make("p", { class: "hint" }, tr("This goes on when you leave the page.")),
      );
    }
    if (s.state === "failed")
      out.push(
        make("p", { class: "wrong" }, tr("It cannot be marked by this rubric: {}", s.problem)),
        make("p", {}, tr("Nothing was entered.")),
      );
    if (s.state === "lost")
      out.push(
        make(
          "p",
          { class: "wrong" },
          tr("The server ended before this counted. Nothing of it was entered: begin anew."),
        ),
      );
    if (s.state === "counted")
      out.push(
        make(
          "p",
          {},
          s.counted === 0
            ? tr("Every session was marked by this rubric before: nothing new was entered.")
            : tr(
                "It counts: entries {0} to {1}. The new results wait for their release.",
                s.first_entry,
                s.first_entry + s.counted - 1,
              ),
        ),
      );
    if (s.state === "ready") out.push(...this.table(s));
    if (s.by === this.me && this.may(routes.drop_regrade)) {
      if (s.state === "ready") out.push(...this.counting(s));
      if (s.state !== "counted")
        out.push(
          act(
            s.state === "marking" || s.state === "ready" ? tr("Drop it") : tr("Clear"),
            {},
            async () => {
              await post(routes.drop_regrade, { id: s.id });
              await this.show();
              say(tr("Nothing was entered."));
            },
          ),
        );
    } else if (s.state === "ready") {
      out.push(make("p", {}, tr("{} lets it count, or drops it.", s.by)));
    }
    return out;
  }

  private table(s: RegradeAll): Node[] {
    const rows = s.sessions ?? [],
      changed = rows.filter((r) => r.other_verdict || r.other_points);
    const points = (n: number, max: number): string => tr("{0} of {1}", fixed(n, 1), max);
    const verdict = (v: string): string => verdict_words()[v] ?? v;
    const out: Node[] = [
      make(
        "p",
        {},
        tr(
          "Sessions: {0}. With another verdict: {1}. With other points: {2}.",
          rows.length,
          rows.filter((r) => r.other_verdict).length,
          rows.filter((r) => r.other_points).length,
        ),
      ),
    ];
    if (s.left_out > 0)
      out.push(make("p", {}, tr("Left out, for recording or result is erased: {}", s.left_out)));
    if (changed.length === 0)
      return [...out, make("p", {}, tr("Nobody's points or verdict would change."))];
    out.push(
      table(
        tr("Who would change: {}", changed.length),
        [
          tr("Entry"),
          tr("Pseudonym"),
          tr("Points now"),
          tr("Points by the new rubric"),
          tr("Verdict now"),
          tr("Verdict by the new rubric"),
          tr("To be known"),
        ],
        changed.map((r) => [
          String(r.session),
          r.candidate,
          points(r.points_before, r.max_before),
          points(r.points, r.max),
          verdict(r.verdict_before),
          r.other_verdict ? make("strong", {}, verdict(r.verdict)) : verdict(r.verdict),
          [
            ...(r.decided ? [tr("a person had decided this")] : []),
            ...(r.shown ? [tr("released: stands until the new one is")] : []),
          ].join("; "),
        ]),
      ),
    );
    return out;
  }

  private counting(s: RegradeAll): Node[] {
    if (!this.second_factor)
      return [
        make(
          "p",
          { class: "wrong" },
          tr("This account has no second factor, and lets no rubric count."),
        ),
      ];
    const reason = input(
      tr("Reason"),
      { required: "", maxlength: "2000", autocomplete: "off" },
      tr("Kept for ever: no names."),
    );
    const code = code_field();
    return [
      form(
        tr("Let it count"),
        async () => {
          const done = await post(routes.count_regrade, {
            id: s.id,
            reason: reason.value,
            code: code.value,
          });
          await this.show();
          say(tr("Entered: {} results, which wait for their release.", done.counted));
        },
        reason.block,
        code.block,
      ),
    ];
  }

  private choice(exams: FiledExam[]): HTMLElement {
    if (exams.length === 0) return make("p", {}, tr("Nothing is filed yet."));
    const exam = select(tr("Exam"), [
      ["", tr("choose …")],
      ...exams.map((e): [string, string] => [e.id, tr("{0}: {1} sessions", e.id, e.sessions)]),
    ]);
    exam.required = true;
    const file = field(
      tr("The new rubric"),
      make("input", { type: "file", accept: ".toml,text/plain", required: "" }),
      tr("TOML, as cavum ledger regrade takes it. It is kept for ever with the results: no names."),
    );
    return make(
      "section",
      {},
      make("h2", {}, tr("Try a rubric")),
      form(
        tr("Try it on all of them"),
        async () => {
          await post(routes.begin_regrade, {
            exam: exam.value,
            rubric: await file.files![0].text(),
          });
          await this.show();
        },
        exam.block,
        file.block,
      ),
    );
  }
}

export async function regrade(me: string, may: May, second_factor: boolean): Promise<View> {
  return new Regrade(me, may, second_factor).open();
}
