// What the program leaves to a person: each result with its reasons, and the decision with its own.
import { routes, type ToDecide } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { fixed, tr } from "../report_src/words.ts";
import { get, post } from "./api.ts";
import {
  act,
  before_now,
  form,
  reason_to_read,
  report_link,
  say,
  select,
  type View,
} from "./parts.ts";

const waiting = async (): Promise<ToDecide[]> => (await get(routes.queue)).queue;

export async function queue(may_decide: boolean): Promise<View> {
  const list = make("div");
  const draw = (queue: ToDecide[]): void =>
    list.replaceChildren(
      ...(queue.length > 0
        ? queue.map((w) => decision(w, may_decide, draw))
        : [make("p", {}, tr("Nothing waits for a decision."))]),
    );
  const show = async (): Promise<void> => draw(await waiting());
  await show();
  return {
    root: make(
      "div",
      {},
      make("h1", {}, tr("Left to a person")),
      act(tr("Look again"), {}, show),
      list,
    ),
  };
}

function decision(
  w: ToDecide,
  may_decide: boolean,
  draw: (queue: ToDecide[]) => void,
): HTMLElement {
  const element = make(
    "section",
    { class: "card", "aria-label": tr("Result of {}", w.candidate) },
    make("h2", {}, w.candidate),
    make(
      "p",
      {},
      tr("{0}, entry {1}: {2} of {3} points", w.exam, w.session, fixed(w.points, 1), w.max),
    ),
    make("ul", {}, ...w.reasons.map((r) => make("li", {}, r))),
    ...before_now(w.decided, w.noted),
  );
  if (w.sha256 !== "") element.append(report_link(w.sha256));
  if (!may_decide) return element;
  const verdict = select(tr("Verdict"), [
    ["", tr("choose …")],
    ["pass", tr("pass")],
    ["fail", tr("fail")],
  ]);
  verdict.required = true;
  const reason = reason_to_read();
  element.append(
    form(
      tr("Decide"),
      async () => {
        try {
          const { entry } = await post(routes.decide, {
            session: w.session,
            verdict: verdict.value,
            reason: reason.value,
          });
          draw(await waiting());
          say(tr("Decided: entry {}.", entry));
        } catch (wrong) {
          const left = await waiting();
          if (!left.some((other) => other.session === w.session)) draw(left); // somebody else was quicker; else what was typed stays
          throw wrong;
        }
      },
      verdict.block,
      reason.block,
    ),
  );
  return element;
}
