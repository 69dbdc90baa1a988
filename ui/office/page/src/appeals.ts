// Appeals: what a candidate objects to, the verdict that a person may decide meanwhile, and the answer.
import { routes, type AppealRow, type Route } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { fixed, tr } from "../report_src/words.ts";
import { get, post, type May } from "./api.ts";
import {
  act,
  before_now,
  form,
  input,
  local_time,
  reason_to_read,
  report_link,
  say,
  select,
  verdict_words,
  type View,
} from "./parts.ts";

const entered = async (): Promise<AppealRow[]> => (await get(routes.appeals)).appeals;

export async function appeals(me: string, may: May): Promise<View> {
  const list = make("div");
  const draw = (all: AppealRow[]): void => {
    const open = all.filter((a) => a.open),
      answered = all.filter((a) => !a.open);
    list.replaceChildren(
      make("h2", {}, tr("Open: {}", open.length)),
      ...open.map((a) => card(a, me, may, draw)),
      make("h2", {}, tr("Answered: {}", answered.length)),
      ...answered.map((a) => card(a, me, may, draw)),
    );
  };
  const show = async (): Promise<void> => draw(await entered());
  await show();
  const root = make("div", {}, make("h1", {}, tr("Appeals")), act(tr("Look again"), {}, show));
  if (may(routes.open_appeal)) root.append(await opening(show));
  root.append(list);
  return { root };
}

async function opening(show: () => Promise<void>): Promise<HTMLElement> {
  const { results } = await get(routes.results);
  const choices: [string, string][] = results
    .filter((r) => !r.appeal)
    .map((r) => [
      String(r.session),
      [tr("entry {}", r.session), r.name ?? "", r.candidate, r.exam]
        .filter((t) => t !== "")
        .join(", "),
    ]);
  const which = select(tr("Result"), [["", tr("choose …")], ...choices]);
  which.required = true;
  const reason = input(
    tr("What the candidate objects to"),
    { required: "", maxlength: "2000", autocomplete: "off" },
    tr("Kept for ever: no names."),
  );
  return make(
    "section",
    {},
    make("h2", {}, tr("A new appeal")),
    form(
      tr("Enter the appeal"),
      async () => {
        const { entry } = await post(routes.open_appeal, {
          session: Number(which.value),
          reason: reason.value,
        });
        reason.value = "";
        which.querySelector(`option[value="${which.value}"]`)?.remove();
        await show();
        say(tr("The appeal is open: entry {}.", entry));
      },
      which.block,
      reason.block,
    ),
  );
}

function card(a: AppealRow, me: string, may: May, draw: (all: AppealRow[]) => void): HTMLElement {
  const words = verdict_words();
  const points =
    a.points === undefined ? "" : tr("{0} of {1} points", fixed(a.points, 1), a.max ?? "");
  const element = make(
    "section",
    { class: "card", "aria-label": tr("Appeal of {}", a.candidate) },
    make("h3", {}, a.candidate),
    make(
      "p",
      {},
      [a.exam, tr("entry {}", a.session), words[a.verdict] ?? a.verdict, points]
        .filter((t) => t !== "")
        .join(", "),
    ),
    make("p", {}, `${local_time(a.utc)}: ${a.reason}`),
  );
  element.append(...before_now(a.decided, a.noted));
  if (a.made_up_by !== undefined)
    element.append(
      make(
        "p",
        { class: "wrong" },
        tr(
          "A makeup sitting (entry {}) counts in its place: nothing can be decided of this one any more.",
          a.made_up_by,
        ),
      ),
    );
  if (a.sha256 !== "" && may(routes.report)) element.append(report_link(a.sha256));
  if (!a.open) {
    element.append(
      make(
        "p",
        {},
        make(
          "strong",
          {},
          a.outcome === "changed" ? tr("The result was changed.") : tr("The result stands."),
        ),
        ` ${a.answer}`,
      ),
    );
    return element;
  }
  if (a.changed) element.append(make("p", {}, tr("Another result was entered since the appeal.")));
  if (may(routes.decide) && a.made_up_by === undefined) element.append(deciding(a, draw));
  if (may(routes.answer_appeal)) {
    if (a.decided?.by === me)
      element.append(
        make(
          "p",
          {},
          tr(
            "You have decided this result yourself. Let another examiner answer where there is one.",
          ),
        ),
      );
    element.append(answering(a, draw));
  }
  return element;
}

/** The entry's number. What somebody else did meanwhile is shown also when nothing was entered; else what was typed stays. */
async function entering<Request>(
  a: AppealRow,
  draw: (all: AppealRow[]) => void,
  route: Route<Request, { entry: number }>,
  what: NoInfer<Request>,
): Promise<number> {
  try {
    const { entry } = await post(route, what);
    draw(await entered());
    return entry;
  } catch (wrong) {
    const now = await entered();
    if (
      !now.some(
        (other) =>
          other.entry === a.entry &&
          other.open &&
          other.changed === a.changed &&
          other.verdict === a.verdict,
      )
    )
      draw(now);
    throw wrong;
  }
}

function deciding(a: AppealRow, draw: (all: AppealRow[]) => void): HTMLElement {
  const verdict = select(tr("Another verdict"), [
    ["", tr("choose …")],
    ["pass", tr("pass")],
    ["fail", tr("fail")],
  ]);
  verdict.required = true;
  const reason = reason_to_read();
  return make(
    "details",
    {},
    make("summary", {}, tr("Decide otherwise")),
    form(
      tr("Decide"),
      async () => {
        const entry = await entering(a, draw, routes.decide, {
          session: a.session,
          verdict: verdict.value,
          reason: reason.value,
        });
        say(tr("Decided: entry {}.", entry));
      },
      verdict.block,
      reason.block,
    ),
  );
}

function answering(a: AppealRow, draw: (all: AppealRow[]) => void): HTMLElement {
  const outcome = a.changed ? "changed" : "stands";
  const reason = input(
    tr("Answer"),
    { required: "", maxlength: "2000", autocomplete: "off" },
    tr("Kept for ever: no names."),
  );
  return form(
    a.changed ? tr("Answer: the result was changed") : tr("Answer: the result stands"),
    async () => {
      const entry = await entering(a, draw, routes.answer_appeal, {
        session: a.session,
        outcome,
        reason: reason.value,
      });
      say(tr("Answered: entry {}.", entry));
    },
    reason.block,
  );
}
