// The exam office in a browser: who is signed in sees the views that his role has, by the address after #.
import { routes, type Me, type Route } from "../made/routes.ts";
import { make } from "../report_src/dom.ts";
import { set_words, tr } from "../report_src/words.ts";
import { get, post, Refused, set_token, type May } from "./api.ts";
import { appeals } from "./appeals.ts";
import { board } from "./board.ts";
import { incidents } from "./incidents.ts";
import { platforms } from "./lti.ts";
import { act, look_for_nothing, say, type View } from "./parts.ts";
import { queue } from "./queue.ts";
import { regrade } from "./regrade.ts";
import { results } from "./results.ts";
import { forget_list, roster } from "./roster.ts";
import { sign_in } from "./sign_in.ts";
import { tickets } from "./tickets.ts";
import { trail } from "./trail.ts";

let me: Me | null = null;
let by_proxy = false;
let view: View | null = null;
const may: May = ({ method, path }) => me?.may.includes(`${method} ${path}`) ?? false;

const roles = (): { [role: string]: string } => ({
  officer: tr("exam officer"),
  examiner: tr("examiner"),
  invigilator: tr("invigilator"),
  reader: tr("reader"),
});

interface Place {
  name: string;
  title: string;
  route: Route<unknown, unknown>;
  open(): Promise<View>;
}
const places = (): Place[] => [
  { name: "day", title: tr("Exam day"), route: routes.board_events, open: () => board(may) },
  { name: "list", title: tr("Class list"), route: routes.issue, open: roster },
  { name: "tickets", title: tr("Tickets"), route: routes.tickets, open: () => tickets(may) },
  { name: "incidents", title: tr("Incidents"), route: routes.incidents, open: incidents },
  {
    name: "decisions",
    title: tr("Decisions"),
    route: routes.queue,
    open: () => queue(may(routes.decide)),
  },
  {
    name: "appeals",
    title: tr("Appeals"),
    route: routes.appeals,
    open: () => appeals(me?.name ?? "", may),
  },
  {
    name: "rubric",
    title: tr("New rubric"),
    route: routes.begin_regrade,
    open: () => regrade(me?.name ?? "", may, me?.second_factor ?? false),
  },
  {
    name: "platforms",
    title: tr("Learning platforms"),
    route: routes.lti,
    open: () => platforms(me?.second_factor ?? false),
  },
  {
    name: "results",
    title: tr("Results"),
    route: routes.results,
    open: () => results(may, me?.second_factor ?? false),
  },
  { name: "trail", title: tr("Trail"), route: routes.trail, open: trail },
];

function put(next: View): void {
  view?.leave?.();
  view = next;
  const main = document.getElementById("main")!;
  main.replaceChildren(next.root);
  (next.first ?? main).focus();
}

function head(mine: Place[], now: string): void {
  const bar = document.getElementById("head")!;
  bar.replaceChildren(make("strong", {}, me?.school ?? tr("Exam office")));
  if (me === null) return;
  if (me.rehearsal)
    bar.append(
      make(
        "span",
        { class: "rehearsal" },
        tr("Rehearsal: exams that no hand moved are filed, too"),
      ),
    );
  const list = make("ul");
  for (const p of mine) {
    const link = make(
      "a",
      { href: `#${p.name}`, ...(p.name === now ? { "aria-current": "page" } : {}) },
      p.title,
    );
    link.addEventListener("click", () => {
      if (location.hash === `#${p.name}`) void show();
    }); // the same view, as it is now
    list.append(make("li", {}, link));
  }
  bar.append(
    make("nav", { "aria-label": tr("Views") }, list),
    make("span", {}, `${me.name}, ${roles()[me.role] ?? me.role}`),
    act(tr("Sign out"), {}, async () => {
      await post(routes.sign_out, {});
      signed_out();
    }),
  );
}

function signed_out(): void {
  me = null;
  set_token("");
  forget_list();
  void show();
}
/** The office knows nobody here any more, and nobody pressed a button for that. */
function ended(): void {
  const was_in = me !== null;
  signed_out();
  if (was_in) say(tr("Your session has ended. Sign in again."));
}

let asked = 0;
async function show(): Promise<void> {
  const mine = places().filter((p) => may(p.route));
  const place = mine.find((p) => `#${p.name}` === location.hash) ?? mine[0];
  head(mine, place?.name ?? "");
  document.title = `${place?.title ?? tr("Sign in")} · ${me?.school ?? "Cavum"}`;
  if (place === undefined) return put(sign_in(signed_in, by_proxy));
  const this_time = ++asked;
  look_for_nothing();
  try {
    const next = await place.open();
    if (this_time === asked) put(next);
    else next.leave?.();
  } catch (wrong) {
    if (wrong instanceof Refused && wrong.status === 401) ended();
    else say(wrong instanceof Error ? wrong.message : tr("This did not work."), true);
  }
}

function signed_in(who: Me): void {
  me = who;
  set_token(who.token);
  void show();
}

async function begin(): Promise<void> {
  const { language, decimal_sign, words, proxy } = await get(routes.words);
  by_proxy = proxy;
  set_words(words, decimal_sign);
  document.documentElement.lang = language;
  document.getElementById("skip")!.textContent = tr("To the content");
  window.addEventListener("hashchange", () => {
    say("");
    void show();
  });
  window.addEventListener("signed-out", ended);
  try {
    signed_in(await get(routes.me));
  } catch (wrong) {
    if (!(wrong instanceof Refused && wrong.status === 401))
      say(wrong instanceof Error ? wrong.message : "", true);
    void show();
  }
}
void begin();
