// A class of 60 and the 8 stations of three rooms, as processes of their own; the keyboard alone; and files as spreadsheets read them.
import assert from "node:assert/strict";
import { execFile, spawn, type ChildProcess } from "node:child_process";
import { existsSync, mkdirSync, rmSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import type { Page } from "puppeteer-core";
import { until } from "../report_test/chromium.ts";
import {
  address,
  code,
  control,
  folder,
  go,
  local,
  press,
  said,
  station,
  task,
  type,
} from "./browser.ts";

const cavum = process.env.CAVUM_BINARY!;

export interface Person {
  id: string;
  name: string;
  extra: string;
  hand: string;
  seed: number;
}
export const seats = [1, 2, 3, 4, 5, 6, 7, 8].map((n) => ({
  home: `seat${n}`,
  name: `Seat ${n}`,
  room: n < 4 ? "Room A" : n < 7 ? "Room B" : "Room C",
}));
export const home_of = (name: string): string => seats.find((s) => s.name === name)!.home;

const first = [
  "Ada",
  "Björn",
  "Chloé",
  "Dilara",
  "Emil",
  "Fatma",
  "Goran",
  "Hanna",
  "Ivo",
  "Jana",
  "Karim",
  "Lea",
];
const last = ["Albrecht", "Brückner", "Çelik", "Dvořák", "Eßer"];
/** Hands so that passes, fails and three reviews come up; what each really comes to is the sealed recording's to say. */
const hands: [string, number][] = [
  ["expert", 1],
  ["expert", 2],
  ["student-90", 1],
  ["expert", 3],
  ["novice", 1],
  ["student-90", 2],
  ["student-60", 1],
  ["expert", 4],
  ["perforator", 1],
  ["expert", 5],
  ["careless", 1],
  ["student-90", 3],
];
const reviews: { [at: number]: [string, number] } = {
  10: ["student-75", 1],
  21: ["student-75", 2],
  37: ["student-85", 3],
};
export const people: Person[] = Array.from({ length: 60 }, (_, i) => {
  const [hand, seed] = reviews[i] ?? hands[i % hands.length];
  return {
    id: String(5001 + i),
    name: `${last[i % 5]}, ${first[i % 12]}`,
    extra: [3, 11, 24, 35, 50].includes(i) ? "25" : "",
    hand,
    seed,
  };
});
/** As a spreadsheet's user pastes it: bars, and a column that nobody knows. */
export function list_of(these: Person[]): string {
  return (
    [
      "id|name|extra_time_percent|Tutor",
      ...these.map((p, i) => `${p.id}|${p.name}|${p.extra}|Dr. ${"KLM"[i % 3]}`),
    ].join("\n") + "\n"
  );
}

export const text = (page: Page): Promise<string> => page.$eval("main", (m) => m.innerText);
export async function gone(page: Page, words: string): Promise<void> {
  await until(
    async () => !(await text(page)).includes(words),
    `no '${words}' on the page`,
    async () => `, where there is: ${await text(page)}`,
  );
}

/** The program beside the test, so that the pages are heard meanwhile. */
export function start(home: string, args: string[]): Promise<string> {
  return new Promise((done, failed) =>
    execFile(
      cavum,
      args,
      {
        encoding: "utf8",
        maxBuffer: 1 << 26,
        env: { ...process.env, CAVUM_HOME: join(folder, home), LANGUAGE: "en" },
      },
      (wrong, out, told) =>
        wrong ? failed(new Error(`cavum ${args.join(" ")}: ${told}`)) : done(out),
    ),
  );
}
/** Two at a time. */
export async function in_pairs<T>(all: T[], does: (one: T) => Promise<void>): Promise<void> {
  const left = [...all];
  const work = async (): Promise<void> => {
    for (let one = left.shift(); one !== undefined; one = left.shift()) await does(one);
  };
  await Promise.all([work(), work()]);
}
export async function place(page: Page, name: string, room: string): Promise<void> {
  const list = (await page.$("::-p-xpath(//section[h2='Room of a station']//select)"))!;
  await list.select(
    ...(await list.$$eval(
      "option",
      (all, n) => all.filter((o) => o.textContent === n).map((o) => o.value),
      name,
    )),
  );
  await type(page, "Room", room);
  await press(page, "It stands there");
  await until(
    async () =>
      page.$$eval(
        "li.card",
        (all, n, r) =>
          all.some((c) => c.querySelector("h3")?.textContent === n && c.innerText.includes(r)),
        name,
        room,
      ),
    `${name} in ${room}`,
  );
}

export interface Row {
  code: string;
  seat: string;
  may_begin: string;
}
/** The list of tickets, by the candidates' numbers; of several of one candidate the last. */
export async function tickets_of(page: Page): Promise<Map<string, Row>> {
  const rows = await page.$$eval("tbody tr", (all) =>
    all.map((r) => {
      const of = (heading: string): Element => r.querySelector(`td[data-label="${heading}"]`)!;
      const seat = of("Station");
      return [
        r.children[0].textContent!,
        of("Pseudonym").textContent!,
        seat.querySelector("select")?.selectedOptions[0].textContent ?? seat.textContent!,
        of("May begin").textContent!,
      ];
    }),
  );
  return new Map(rows.map(([id, code, seat, may_begin]) => [id, { code, seat, may_begin }]));
}
export async function say_times(page: Page, from_min: number, until_min: number): Promise<void> {
  for (const [label, minutes] of [
    ["May begin from", from_min],
    ["May begin until", until_min],
  ] as [string, number][])
    await page.$eval(
      await control(page, label),
      (e, v) => ((e as HTMLInputElement).value = v),
      local(minutes / 60),
    );
}
/** Pastes a list and waits for what was found in it. */
export async function paste(page: Page, these: Person[]): Promise<void> {
  await go(page, "Class list");
  const place = await control(page, "Paste the list, with its line of column names");
  await page.$eval(place, (e) => ((e as HTMLTextAreaElement).value = ""));
  await page.focus(place);
  await page.keyboard.sendCharacter(list_of(these));
  await press(page, "Read the list");
  await said(page, "What was found");
}
/** The column that nobody knows; the page remembers that for the next list. */
export async function pass_over(page: Page): Promise<void> {
  await said(page, "Columns that wait for your answer: 1");
  await page.select(await control(page, "Use of column Tutor"), "pass over");
  await said(page, "Who gets a ticket");
}

/** A list that asks nothing back: all get a ticket. */
export async function issue(
  page: Page,
  list: string,
  from_min = -60,
  until_min = 180,
): Promise<void> {
  await go(page, "Class list");
  await type(page, "Paste the list, with its line of column names", list);
  await press(page, "Read the list");
  await said(page, "Who gets a ticket");
  await say_times(page, from_min, until_min);
  await type(page, "Reason", "class of this year");
  await press(page, "Issue the tickets");
  await said(page, "Refused: 0.");
}

export async function tickets_page(page: Page): Promise<Map<string, Row>> {
  await go(page, "Tickets");
  await page.$eval("main table", (t) => t.setAttribute("data-old", ""));
  await press(page, "Look again");
  await page.waitForSelector("main table:not([data-old])");
  return tickets_of(page);
}
/** The next sitting has its seats, by one press; who sits where. */
export async function seat_them(
  page: Page,
  sitting: Person[],
  room = "",
): Promise<Map<string, string>> {
  const begins = (await tickets_page(page)).get(sitting[0].id)!.may_begin;
  await page.select(
    await control(page, "Sitting"),
    await page.$eval(
      await control(page, "Sitting"),
      (s, b) => [...(s as HTMLSelectElement).options].find((o) => o.text.startsWith(b))!.value,
      begins,
    ),
  );
  if (room !== "") await page.select(await control(page, "Room"), room);
  await press(page, "Seat them");
  await said(page, "Seated: ");
  const rows = await tickets_of(page);
  return new Map(sitting.map((p) => [p.id, rows.get(p.id)!.seat]));
}
export async function cancel(page: Page, code: string, reason: string): Promise<void> {
  const button = `[aria-label="Cancel the ticket of ${code}"]`;
  await page.$eval(button, (b) => b.scrollIntoView({ block: "center" }));
  await page.click(button);
  await type(page, "Reason", reason);
  await page.keyboard.press("Enter");
  await said(page, `The ticket of ${code} does not count any more.`);
}
export async function download(page: Page, words: string, name: string): Promise<string> {
  const to = join(folder, "downloads");
  mkdirSync(to, { recursive: true });
  rmSync(join(to, name), { force: true });
  const session = await page.createCDPSession();
  await session.send("Browser.setDownloadBehavior", {
    behavior: "allow",
    downloadPath: to,
    browserContextId: page.browserContext().id,
  });
  await (await page.waitForSelector(`::-p-xpath(//a[normalize-space()="${words}"])`))!.click();
  await until(async () => existsSync(join(to, name)), name);
  return join(to, name);
}

export function reports(home: string, who: string, state = "exam", ...more: string[]): string {
  return station(
    home,
    "report",
    "--state",
    state,
    ...(who === "" ? [] : ["--candidate", who]),
    ...(state === "exam" ? ["--step", "1/1 cavity", "--remaining-s", "104"] : []),
    ...more,
  );
}
/** Fetches the ticket, sits the exam, and leaves its recording at the station. */
export async function sit(home: string, p: Person, code: string): Promise<string> {
  const out = join(folder, home, "exams", `${code}.cavum`);
  mkdirSync(join(folder, home, "exams"), { recursive: true });
  station(home, "tickets", "--out", join(folder, home, "tickets"));
  await start(home, [
    "exam",
    task,
    "--ticket",
    join(folder, home, "tickets", `${code}.ticket`),
    "--operator",
    p.hand,
    "--seed",
    String(p.seed),
    "--out",
    out,
    "--quiet",
  ]);
  return out;
}
export async function file(home: string, recording: string): Promise<void> {
  await start(home, [
    "office",
    "file",
    "--server",
    address,
    "--certificate",
    join(folder, "school/office/certificate.pem"),
    recording,
  ]);
}

/** A virtual screen, and the exam window on it. */
export async function screen(): Promise<{ display: string; child: ChildProcess }> {
  const child = spawn(
    "Xvfb",
    ["-displayfd", "3", "-screen", "0", "1280x800x24", "-nolisten", "tcp"],
    { stdio: ["ignore", "ignore", "ignore", "pipe"] },
  );
  let display = "";
  (child.stdio[3] as NodeJS.ReadableStream).on("data", (t: Buffer) => (display += t.toString()));
  await until(async () => display.includes("\n"), "a virtual screen");
  return { display: `:${display.trim()}`, child };
}
export function open_window(display: string, home: string, p: Person, code: string): ChildProcess {
  const script = join(folder, home, "script");
  mkdirSync(join(folder, home, "exams"), { recursive: true });
  writeFileSync(
    script,
    `wait sign-in\nsleep 3\ntype ${code}\ngo device-check\ngo briefing\nkey enter\nwait exam\nwait result\nsleep 600\n`,
  );
  return spawn(
    cavum,
    [
      "station",
      task,
      "--device",
      "simulated",
      "--operator",
      p.hand,
      "--seed",
      String(p.seed),
      "--width",
      "640",
      "--height",
      "480",
      "--effects",
      "5",
      "--out",
      join(folder, home, "exams"),
      "--server",
      address,
      "--certificate",
      join(folder, "school/office/certificate.pem"),
      "--script",
      script,
    ],
    {
      env: { ...process.env, CAVUM_HOME: join(folder, home), LANGUAGE: "en", DISPLAY: display },
      stdio: "ignore",
    },
  );
}

/** What has the focus, by the name that a screen reader says. */
const focused = (page: Page): Promise<string> =>
  page.evaluate(() => {
    const e = document.activeElement;
    return (
      e?.getAttribute("aria-label") ??
      [...document.querySelectorAll("label")]
        .find((l) => e?.id && l.htmlFor === e.id)
        ?.textContent?.trim() ??
      e?.textContent?.trim() ??
      ""
    );
  });
/** Presses Tab until that has the focus; how often. */
export async function tab_to(page: Page, name: string): Promise<number> {
  for (let n = 1; n < 1000; ++n) {
    await page.keyboard.press("Tab");
    if ((await focused(page)) === name) return n;
  }
  throw new Error(`Tab comes to no '${name}'`);
}
export async function write_keys(page: Page, words: string): Promise<void> {
  await page.keyboard.down("Control");
  await page.keyboard.press("a");
  await page.keyboard.up("Control");
  await page.keyboard.type(words);
}

let used = 0;
/** A code that was not used before, nor one after it: waits for the next half minute where it must. */
export async function fresh_code(): Promise<string> {
  const now = (): number => Math.floor(Date.now() / 30_000);
  const step = Math.max(used + 1, now() - 1);
  while (step > now() + 1) await new Promise((done) => setTimeout(done, 500));
  used = step;
  return code(step - now());
}

export async function release(page: Page, reason: string): Promise<void> {
  await go(page, "Results");
  await type(page, "Reason", reason);
  await type(page, "Code of your app", await fresh_code());
  await press(page, "Release");
}

/** Fields of a file of comma-separated values (RFC 4180). */
export function csv(bytes: string): { [heading: string]: string }[] {
  const rows: string[][] = [[]];
  for (const m of bytes.matchAll(/(?:"((?:[^"]|"")*)"|([^",\r\n]*))(,|\r?\n|$)/g)) {
    if (m.index === bytes.length) break;
    rows[rows.length - 1].push((m[1] ?? m[2]).replaceAll('""', '"'));
    if (m[3] !== ",") rows.push([]);
  }
  const [head, ...body] = rows.filter((r) => r.length > 0);
  return body.map((r) => {
    assert.equal(r.length, head.length, `a row of another length: ${r.join("|")}`);
    return Object.fromEntries(r.map((v, i) => [head[i], v]));
  });
}
