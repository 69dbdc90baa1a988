// What the views are made of: fields with labels, tables that become cards on a narrow screen, and one line that says what happened.
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
export function field<T extends HTMLElement>(label: string, control: T, hint = ""): T & { block: HTMLElement } {
  control.id ||= id();
  const block = make("div", {}, make("label", { for: control.id }, label), control);
  if (hint !== "") {
    const text = make("p", { class: "hint", id: id() }, hint);
    control.setAttribute("aria-describedby", text.id);
    block.append(text);
  }
  return Object.assign(control, { block });
}

export function input(label: string, attributes: { [name: string]: string } = {}, hint = ""): HTMLInputElement & { block: HTMLElement } {
  return field(label, make("input", { type: "text", ...attributes }), hint);
}

/** For a code of the second factor. */
export function code_field(): ReturnType<typeof input> {
  return input(tr("Code of your app"), { required: "", inputmode: "numeric", autocomplete: "one-time-code", pattern: "[0-9]{6}", maxlength: "6" });
}

export function select(label: string, choices: [string, string][], chosen = ""): HTMLSelectElement & { block: HTMLElement } {
  const list = make("select");
  for (const [value, text] of choices) list.append(Object.assign(make("option", { value }, text), { selected: value === chosen }));
  return field(label, list);
}

/** One line for each row; on a narrow screen a card, each cell with its heading. */
export function table(caption: string, headings: string[], rows: (Node | string)[][]): HTMLTableElement {
  const body = make("tbody");
  for (const row of rows) {
    const line = make("tr");
    row.forEach((cell, i) => line.append(i === 0 ? make("th", { scope: "row" }, cell) : make("td", { "data-label": headings[i] }, cell)));
    body.append(line);
  }
  const head = make("tr", {}, ...headings.map((h) => make("th", { scope: "col" }, h)));
  return make("table", { class: "stack" }, make("caption", {}, caption), make("thead", {}, head), body);
}

/** Says what happened, for eyes and screen readers. The line stands over the page's lower end: what is scrolled to comes to lie above it. */
export function say(text: string, wrong = false): void {
  const line = document.getElementById("said")!;
  line.textContent = text;
  line.classList.toggle("wrong-said", wrong);
  document.documentElement.style.scrollPaddingBottom = `${line.offsetHeight}px`;
}

/** A button that does something once at a time, and says what went wrong. */
export function act(text: string, attributes: { [name: string]: string }, does: () => Promise<void>): HTMLButtonElement {
  const control: HTMLButtonElement = button(text, attributes, () => void run(control, does));
  return control;
}

/** A form whose Enter key and button do the same. An event "done" says that it worked. */
export function form(text: string, does: () => Promise<void>, ...children: Node[]): HTMLFormElement {
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
    if (wrong instanceof Error && "status" in wrong && wrong.status === 401) window.dispatchEvent(new Event("signed-out"));
  } finally {
    control.disabled = false;
    control.scrollIntoView({ block: "nearest" });  // else the line that says it would take the next click
  }
}

/** A button that opens a form below itself; Back closes it, and so does the form when it worked. */
export function opens_form(text: string, attributes: { [name: string]: string }, make_form: () => HTMLFormElement): HTMLElement {
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
    asked.querySelector(".row:last-child")!.append(button(tr("Back"), {}, close));
    open.hidden = true;
    open.setAttribute("aria-expanded", "true");
    block.append(asked);
    say("");  // what was said before is of something else
    asked.scrollIntoView({ block: "nearest" });
    asked.querySelector<HTMLElement>("input, select")!.focus();
  });
  block.append(open);
  return block;
}

/** Asks why in a form below a button, below what else it asks, and does it then. */
export function with_reason(text: string, attributes: { [name: string]: string }, does: (reason: string) => Promise<void>, ...asked: Node[]): HTMLElement {
  return opens_form(text, attributes, () => {
    const reason = input(tr("Reason"), { required: "", maxlength: "2000", autocomplete: "off" }, tr("Kept for ever: no names."));
    return form(text, async () => does(reason.value), ...asked, reason.block);
  });
}

/** To the tooth in three dimensions and the replay of a recording, in a window of its own. */
export function report_link(sha256: string): HTMLAnchorElement {
  return make("a", { href: `/api/report/${sha256}`, target: "_blank", rel: "noopener" }, tr("Tooth, replay and every figure"));
}
export const verdict_words = (): { [verdict: string]: string } => ({ pass: tr("pass"), fail: tr("fail"), review: tr("review") });

/** "2026-11-21T09:00:00Z" in the reader's own time zone. */
export function local_time(utc: string): string {
  return new Date(utc).toLocaleString([], { dateStyle: "medium", timeStyle: "short" });
}
/** What a control for a moment says, as UTC to the second. */
export function utc(local: string): string {
  return new Date(local).toISOString().replace(/\.\d+Z$/, "Z");
}
export function time_zone(): string {
  return Intl.DateTimeFormat().resolvedOptions().timeZone;
}
