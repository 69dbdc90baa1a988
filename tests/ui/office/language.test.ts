// Every page of an office that speaks the pseudo-language, as officer and as examiner, with a class list that is wrong, tickets in several states, an exam
// that was filed and one that was refused: what is no data stands in brackets, and no letter in them is as English has it.
import assert from "node:assert/strict";
import { readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Page } from "puppeteer-core";
import { k_skip, until } from "../report_test/chromium.ts";
import {
  close_office,
  control,
  desk,
  folder,
  go,
  in_language,
  open_office,
  press,
  run,
  speak,
  station,
  task,
  type,
} from "./browser.ts";
import { say_times } from "./hall.ts";

before(async () => {
  if (k_skip) return;
  speak("qps");
  await open_office("seat");
});
after(close_office);

/** What people typed here, and names of files and fields that are the same in every language. */
const typed = [
  "School of Dentistry",
  "Anna Officer",
  "Eva Examiner",
  "Anna A.",
  "Bert B.",
  "Seat 1",
  "Seat 9",
  "Hall 1",
  "Matrikel",
  "much",
  "class of this year",
  "was ill",
  "the lamp is broken",
  "it smells",
  "the pedal was unplugged",
  "looked at it",
  "the wall is thick enough",
  "1/1 cavity",
  "Round cavity in a layered block",
  "UTF-8",
  "border_cavity",
  "extra_time_percent",
  "extra_time_s",
  "left_handed",
  "high_contrast",
  "custom.number",
  "Cavum",
  "UTC",
];
/** Fields and headings of the lists. */
const fields = ["id", "name", "station", "yes", "yes; much"],
  columns = "id, name, station, extra_time_percent, extra_time_s, left_handed, high_contrast";

/** Texts of the page, also of what is not unfolded yet, of lists to choose from, and what a screen reader says. */
const texts = (page: Page): Promise<string[]> =>
  page.evaluate(() => {
    const out = [document.title];
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    for (let n = walk.nextNode(); n !== null; n = walk.nextNode())
      if (!["SCRIPT", "STYLE"].includes(n.parentElement!.tagName)) out.push(n.textContent!);
    for (const e of document.querySelectorAll("*"))
      for (const name of ["aria-label", "title", "placeholder", "data-label", "alt"])
        out.push(e.getAttribute(name) ?? "");
    for (const e of document.querySelectorAll("input")) out.push(e.defaultValue);
    return [...new Set(out.map((t) => t.trim()).filter((t) => t !== ""))];
  });

/** What is left of a text without data: letters outside of brackets, and such in them as the pseudo-language would have changed. */
function english_in(text: string): string {
  if (fields.includes(text)) return "";
  let rest = text
    .replace(columns, " ")
    .replace(/ id;/g, ";")
    .replace(/⟨[^⟩]*⟩/g, " ")
    .replace(new RegExp(`(?<= )(${fields.join("|")})(?=⟧$|: )`, "g"), " ");
  for (const data of [...typed].sort((a, b) => b.length - a.length))
    rest = rest.replaceAll(data, " ");
  rest = rest
    .replace(
      /\b[CS](-\w{4}){3,}\b|\b[0-9a-f]{16,64}\b|\b[-\d]+T[:\d]+Z|https:\/\/127\.0\.0\.1[:\w/.-]*/g,
      " ",
    )
    .replace(/(?<=\d) s\b/g, " ") // a figure's unit
    .replace(
      /\b(Jan|Feb|Mar|Apr|May|Jun|Jul|Aug|Sep|Oct|Nov|Dec) \d+, \d{4}, \d+:\d\d\s[AP]M|\b\d+:\d\d\s[AP]M/g,
      " ",
    );
  let depth = 0,
    found = "";
  for (const c of rest) {
    if (c === "⟦") ++depth;
    else if (c === "⟧") --depth;
    else if (depth === 0 ? /\p{L}/u.test(c) : /[abcdeghilnoprstuyzAEOT]/.test(c)) found += c;
  }
  return depth === 0 ? found : `${found} (brackets)`;
}

const wrong: string[] = [];
async function read(page: Page, where: string): Promise<void> {
  const all = await texts(page);
  assert.ok(
    all.some((t) => t.includes("⟦")),
    `${where} speaks the pseudo-language`,
  );
  for (const text of all) if (english_in(text) !== "") wrong.push(`${where}: ${text}`);
}
/** Waits until that stands there, in the page's language, up to its first gap. */
async function waits(page: Page, english: string): Promise<void> {
  const words = in_language(english).split("{")[0];
  assert.notEqual(words, english.split("{")[0], `the page has no translation of '${english}'`);
  await until(
    async () => (await texts(page)).some((t) => t.includes(words)),
    `'${english}' on the page`,
    async () => `, where there is: ${(await texts(page)).join(" | ")}`,
  );
}
async function list(page: Page, text: string): Promise<void> {
  await go(page, "Class list");
  await type(page, "Paste the list, with its line of column names", text);
  await page.$$eval("main h2", (all) => all.forEach((h) => h.setAttribute("data-old", "")));
  await press(page, "Read the list");
  await page.waitForSelector("main h2:not([data-old])");
}
async function issue(page: Page, text: string, from_min: number, until_min: number): Promise<void> {
  await list(page, text);
  await waits(page, "Who gets a ticket");
  await read(page, "preview");
  await say_times(page, from_min, until_min);
  await type(page, "Reason", "class of this year");
  await press(page, "Issue the tickets");
  await waits(page, "Issued: {0}. Refused: {1}.");
  await read(page, "issued");
}

test("every text of every page is the language's", { skip: k_skip }, async () => {
  const officer = await desk("Anna Officer");
  const { page } = officer;
  await waits(page, "No station is enrolled yet.");
  await read(page, "day");
  await type(page, "Name of the station", "Seat 1");
  await press(page, "Make a code");
  await page.waitForSelector("section code");
  station("seat", "enrol", "--code", await page.$eval("section code", (c) => c.textContent!));

  await list(page, "Matrikel;name\n4711;Anna A.\n");
  await waits(page, "Columns that wait for your answer: {}. Use each, or pass it over.");
  await read(page, "open column");
  await list(page, "4711;Anna A.\n4712;Bert B.\n");
  await page.waitForSelector("main [role=alert]");
  await read(page, "no line of column names");
  await list(
    page,
    "id;name;extra_time_percent;left_handed\n4711;Anna A.;much;yes\n4712;Bert B.\n4711;Anna A.;9000;much\n4711;;;\n",
  );
  await page.waitForSelector("main p.wrong");
  await read(page, "list with mistakes");
  await list(page, "id;station\n4711;Seat 9\n");
  await page.waitForSelector("main p.wrong");
  await read(page, "list with a station that is none");
  await issue(
    page,
    "id;name;extra_time_percent;left_handed;high_contrast\n4711;Anna A.;100;yes;yes\n",
    -60,
    180,
  );
  await issue(page, "id;name;extra_time_s\n4712;Bert B.;90\n", -180, -120);
  await issue(page, "id;name\n4711;Anna A.\n", -60, 180); // refused: there is one

  await go(page, "Tickets");
  await waits(page, "Tickets: {0}; times in {1}");
  for (const button of await page.$$("main td button")) await button.click(); // the forms below them
  await read(page, "tickets");
  await page.evaluate(() => (document.documentElement.lang = "de")); // dates follow the page's language, not the browser's
  await press(page, "Look again");
  await until(
    async () => (await texts(page)).some((t) => /\d\d\.\d\d\.\d{4}, \d\d:\d\d/.test(t)),
    "dates as German has them",
    async () => `: ${(await texts(page)).join(" | ")}`,
  );
  await page.evaluate(() => (document.documentElement.lang = "qps"));

  station("seat", "tickets", "--out", join(folder, "tickets"));
  const ticket = readdirSync(join(folder, "tickets")).find((f) => f.endsWith(".ticket"))!;
  const recording = join(folder, "e.cavum"),
    none = join(folder, "none.cavum");
  run("seat", [
    "exam",
    task,
    "--ticket",
    join(folder, "tickets", ticket),
    "--operator",
    "expert",
    "--seed",
    "3",
    "--out",
    recording,
  ]);
  writeFileSync(none, `SQLite format 3\0${"no exam ".repeat(100)}`);
  assert.throws(() => station("seat", "file", none), "it is not filed");
  await go(page, "Exam day");
  station(
    "seat",
    "report",
    "--state",
    "exam",
    "--candidate",
    ticket.slice(0, -7),
    "--step",
    "1/1 cavity",
    "--remaining-s",
    "754",
    "--alarm",
    "the pedal was unplugged",
  );
  await waits(page, "{} left");
  await page.click("details.pause summary");
  await press(page, "Pause the exams");
  await waits(page, "Let them go on");
  await type(page, "What candidates read", "the lamp is broken");
  await press(page, "Announce it");
  await waits(page, "Announcements not read yet: {}");
  await waits(page, "Refused");
  await press(page, "Let them go on");
  await read(page, "day with a station");
  station("seat", "file", recording, "--receipts", join(folder, "receipts"));

  await go(page, "Incidents");
  await type(page, "What happened", "it smells");
  await press(page, "Note it");
  await waits(page, "Noted: entry {}.");
  await read(page, "incidents");
  await go(page, "Results");
  await waits(page, "Results: {}");
  await type(page, "Reason", "looked at it");
  await type(page, "Code of your app", "000000");
  await press(page, "Release");
  await page.waitForSelector("#said.wrong-said:not(:empty)");
  await read(page, "results");
  await go(page, "Appeals");
  const filed = await page.$eval(await control(page, "Result"), (s) =>
    [...(s as HTMLSelectElement).options].map((o) => o.value).find((v) => v !== "")!,
  );
  await page.select(await control(page, "Result"), filed);
  await type(page, "What the candidate objects to", "the wall is thick enough");
  await press(page, "Enter the appeal");
  await waits(page, "The appeal is open: entry {}.");
  await read(page, "appeals");
  await go(page, "Learning platforms");
  await read(page, "platforms");
  await go(page, "Trail");
  await page.waitForSelector("main table");
  await read(page, "trail");

  const examiner = await desk("Eva Examiner");
  await waits(examiner.page, "Left to a person");
  for (const view of ["Decisions", "Appeals", "New rubric", "Results", "Trail"]) {
    await go(examiner.page, view);
    await read(examiner.page, `examiner's ${view}`);
  }
  await press(examiner.page, "Sign out");
  await examiner.page.waitForSelector("input[type=password]");
  await type(examiner.page, "Name", "Eva Examiner");
  await type(examiner.page, "Password", "much");
  await press(examiner.page, "Sign in");
  await examiner.page.waitForSelector("#said.wrong-said:not(:empty)");
  await read(examiner.page, "sign-in");
  assert.deepEqual(wrong, []);
  for (const one of [officer, examiner]) assert.deepEqual(one.complaints, []);
});
