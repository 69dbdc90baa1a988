// What the views are made of: fields with labels, tables that become cards on a narrow screen, and one line that says what happened.
import { routes, type Decided, type Noted } from "../made/routes.ts";
import { button, make } from "../report_src/dom.ts";
import { tr } from "../report_src/words.ts";

export interface View {
  root: HTMLElement;
  /** Where typing begins. */
  first?: HTMLElement;
  /** Ends what goes on: a stream of events. */
  leave?(): void;
}

let last = 0;
function id(): string {
  return `field-${++last}`;
}

/** A control below its label, and a hint below that. */
export function field<T extends HTMLElement>(
  label: string,
  control: T,
  hint = "",
): T & { block: HTMLElement } {
  control.id ||= id();
  const block = make("div", {}, make("label", { for: control.id }, label), control);
  if (hint !== "") {
    const text = make("p", { class: "hint", id: id() }, hint);
    control.setAttribute("aria-describedby", text.id);
    block.append(text);
  }
  return Object.assign(control, { block });
}

export function input(
  label: string,
  attributes: { [name: string]: string } = {},
  hint = "",
): HTMLInputElement & { block: HTMLElement } {
  return field(label, make("input", { type: "text", ...attributes }), hint);
}

/** For a code of the second factor. */
export function code_field(): ReturnType<typeof input> {
  const code = input(tr("Code of your app"), {
    required: "",
    inputmode: "numeric",
    autocomplete: "one-time-code",
    pattern: "[0-9]{6}",
  });
  code.addEventListener("input", () => {
    if (/\D/.test(code.value)) code.value = code.value.replace(/\D/g, "");
  }); // apps show it in two halves
  return code;
}

export function select(
  label: string,
  choices: [string, string][],
  chosen = "",
): HTMLSelectElement & { block: HTMLElement } {
  const list = make("select");
  for (const [value, text] of choices)
    list.append(Object.assign(make("option", { value }, text), { selected: value === chosen }));
  return field(label, list);
}

const k_long = 10;
/** What is looked for in long tables, by their headings: kept while a view is open, for its tables are made anew. */
const looked_for = new Map<string, string>();
export function look_for_nothing(): void {
  looked_for.clear();
}

/** What a row says to who reads it: of a list to choose from what is chosen. */
function words_of(row: HTMLTableRowElement): string {
  return [...row.cells]
    .map((c) => c.querySelector("select")?.selectedOptions[0]?.text ?? c.textContent ?? "")
    .join(" ")
    .toLowerCase();
}

/** A field above a long table that leaves the rows in which all words stand. */
function searched(long: HTMLTableElement, key: string): HTMLElement {
  const words = input(tr("Find in the list"), {
    type: "search",
    autocomplete: "off",
    spellcheck: "false",
  });
  const count = make("p", { class: "hint", role: "status" });
  const rows = [...long.tBodies[0].rows];
  const show = (): void => {
    looked_for.set(key, words.value);
    const wanted = words.value
      .toLowerCase()
      .split(/\s+/)
      .filter((w) => w !== "");
    for (const row of rows) row.hidden = !wanted.every((w) => words_of(row).includes(w));
    count.textContent =
      wanted.length === 0
        ? ""
        : tr("Shown: {0} of {1}", rows.filter((r) => !r.hidden).length, rows.length);
  };
  words.value = looked_for.get(key) ?? "";
  words.addEventListener("input", show);
  show();
  return make("div", {}, words.block, count, long);
}

/** One line for each row; on a narrow screen a card, each cell with its heading. A long one can be searched. */
export function table(caption: string, headings: string[], rows: (Node | string)[][]): HTMLElement {
  const body = make("tbody");
  for (const row of rows) {
    const line = make("tr");
    row.forEach((cell, i) =>
      line.append(
        i === 0
          ? make("th", { scope: "row" }, cell)
          : make("td", { "data-label": headings[i] }, cell),
      ),
    );
    body.append(line);
  }
  const head = make("tr", {}, ...headings.map((h) => make("th", { scope: "col" }, h)));
  const element = make(
    "table",
    { class: "stack" },
    make("caption", {}, caption),
    make("thead", {}, head),
    body,
  );
  return rows.length > k_long ? searched(element, headings.join()) : element;
}

/** Says what happened, for eyes and screen readers. The line stands over the page's lower end: what is scrolled to comes to lie above it. */
export function say(text: string, wrong = false): void {
  const line = document.getElementById("said")!;
  line.textContent = text;
  line.classList.toggle("wrong-said", wrong);
  document.documentElement.style.scrollPaddingBottom = `${line.offsetHeight}px`;
}

/** A button that does something once at a time, and says what went wrong. */
export function act(
  text: string,
  attributes: { [name: string]: string },
  does: () => Promise<void>,
): HTMLButtonElement {
  const control: HTMLButtonElement = button(text, attributes, () => void run(control, does));
  return control;
}

/** A form whose Enter key and button do the same. An event "done" says that it worked. */
export function form(
  text: string,
  does: () => Promise<void>,
  ...children: Node[]
): HTMLFormElement {
  const send = make("button", { type: "submit", class: "main" }, text);
  const element = make("form", {}, ...children, make("div", { class: "row" }, send));
  element.addEventListener("submit", (event) => {
    event.preventDefault();
    void run(send, async () => {
      await does();
      element.dispatchEvent(new Event("done"));
    });
  });
  return element;
}

async function run(control: HTMLButtonElement, does: () => Promise<void>): Promise<void> {
  if (control.disabled) return;
  control.disabled = true;
  say("");
  try {
    await does();
  } catch (wrong) {
    say(wrong instanceof Error ? wrong.message : tr("This did not work."), true);
    if (wrong instanceof Error && "status" in wrong && wrong.status === 401)
      window.dispatchEvent(new Event("signed-out"));
  } finally {
    control.disabled = false;
    if (document.activeElement === document.body)
      document.getElementById("main")!.focus({ preventScroll: true }); // what had it is gone: not from the page's top
    control.scrollIntoView({ block: "nearest" }); // else the line that says it would take the next click
  }
}

/** A button that opens a form below itself; Back closes it, and so does the form when it worked. */
export function opens_form(
  text: string,
  attributes: { [name: string]: string },
  make_form: () => HTMLFormElement,
): HTMLElement {
  const block = make("div");
  const open = button(text, { "aria-expanded": "false", ...attributes }, () => {
    const asked = make_form();
    const close = (): void => {
      asked.remove();
      open.hidden = false;
      open.setAttribute("aria-expanded", "false");
      open.focus();
    };
    asked.addEventListener("done", close);
    asked.addEventListener("keydown", (key) => {
      if (key.key === "Escape") close();
    });
    asked.querySelector(".row:last-child")!.append(button(tr("Back"), {}, close));
    open.hidden = true;
    open.setAttribute("aria-expanded", "true");
    block.append(asked);
    say(""); // what was said before is of something else
    asked.scrollIntoView({ block: "nearest" });
    asked.querySelector<HTMLElement>("input, select")!.focus();
  });
  block.append(open);
  return block;
}

/** Asks why in a form below a button, below what else it asks, and does it then; `sends` is on the form's own button. */
export function with_reason(
  text: string,
  attributes: { [name: string]: string },
  does: (reason: string) => Promise<void>,
  more: { sends?: string; asked?: Node[] } = {},
): HTMLElement {
  return opens_form(text, attributes, () => {
    const reason = input(
      tr("Reason"),
      { required: "", maxlength: "2000", autocomplete: "off" },
      tr("Kept for ever: no names."),
    );
    return form(
      more.sends ?? text,
      async () => does(reason.value),
      ...(more.asked ?? []),
      reason.block,
    );
  });
}

/** To the tooth in three dimensions and the replay of a recording, in a window of its own. */
export function report_link(sha256: string): HTMLAnchorElement {
  return make(
    "a",
    { href: routes.report.path.replace("*", sha256), target: "_blank", rel: "noopener" },
    tr("Tooth, replay and every figure"),
  );
}
export const verdict_words = (): { [verdict: string]: string } => ({
  pass: tr("pass"),
  fail: tr("fail"),
  review: tr("review"),
});

/** For dates: the page's language, as the browser's user writes it where that is the browser's, too (en-GB). */
function locale(): string {
  const language = document.documentElement.lang;
  return navigator.languages.find((l) => l.split("-")[0] === language) ?? language;
}
/** "2026-11-21T09:00:00Z" in the reader's own time zone. */
export function local_time(utc: string): string {
  return new Date(utc).toLocaleString(locale(), { dateStyle: "medium", timeStyle: "short" });
}
/** From one moment to another; the day once where both are on it. */
export function local_span(from: string, until: string): string {
  const same_day = new Date(from).toDateString() === new Date(until).toDateString();
  return tr(
    "{0} to {1}",
    local_time(from),
    same_day
      ? new Date(until).toLocaleTimeString(locale(), { timeStyle: "short" })
      : local_time(until),
  );
}
/** What a control for a moment says, as UTC to the second. Throws for what the clocks leave out when they are put forward. */
export function utc(local: string): string {
  const t = new Date(local),
    two = (n: number): string => String(n).padStart(2, "0");
  const clock = `${t.getFullYear()}-${two(t.getMonth() + 1)}-${two(t.getDate())}T${two(t.getHours())}:${two(t.getMinutes())}`;
  if (clock !== local.slice(0, 16))
    throw new Error(
      tr(
        "There is no {0} in {1}: the clocks are put forward then. Choose another time.",
        local.replace("T", " "),
        time_zone(),
      ),
    );
  return t.toISOString().replace(/\.\d+Z$/, "Z");
}
/** "m:ss" */
function minutes(s: number): string {
  return `${Math.floor(s / 60)}:${String(s % 60).padStart(2, "0")}`;
}
/** How long an exam takes, and the longest with what is granted to somebody. */
export function length_words(limit_s: number, longest_s: number): string {
  if (limit_s === 0) return tr("without a time limit");
  return longest_s > limit_s
    ? tr("takes {0} min, with accommodations up to {1} min", minutes(limit_s), minutes(longest_s))
    : tr("takes {} min", minutes(limit_s));
}
export function time_zone(): string {
  return Intl.DateTimeFormat().resolvedOptions().timeZone;
}

/** What a person has decided of a result. */
export function decided_text(d: Decided): string {
  const verdict = verdict_words()[d.verdict] ?? d.verdict;
  return d.counts
    ? tr("decided by {0} (entry {1}): {2}, {3}", d.by, d.entry, verdict, d.reason)
    : tr("decided before by {0} (entry {1}): {2}, {3}", d.by, d.entry, verdict, d.reason);
}

/** What was noted of a candidate on the day, and what a person has decided before: for whoever decides now. */
export function before_now(decided: Decided | undefined, noted: Noted[]): HTMLElement[] {
  const lines = [
    ...(decided === undefined ? [] : [decided_text(decided)]),
    ...noted.map((n) =>
      [tr("Incident"), local_time(n.utc), n.station, n.words].filter((t) => t !== "").join(", "),
    ),
  ];
  return lines.length === 0
    ? []
    : [make("ul", { class: "hint" }, ...lines.map((l) => make("li", {}, l)))];
}

/** Of whoever decides: kept, and read by the candidate. */
export function reason_to_read(): ReturnType<typeof input> {
  return input(
    tr("Reason"),
    { required: "", maxlength: "2000", autocomplete: "off" },
    tr("The candidate reads it, and it is kept for ever: no names."),
  );
}
