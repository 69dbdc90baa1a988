// An exam day in a real browser, by clicks and keys only: sign-in, class list, tickets, a station's report, a decision, the release, the gradebook.
// Each page is looked at by axe-core, at 1280 and at 390 pixels, and its picture is kept.
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { createHmac } from "node:crypto";
import { copyFileSync, mkdirSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import { k_skip, launch, until, violations } from "../report_test/chromium.ts";

const cavum = process.env.CAVUM_BINARY!;
const source = process.env.CAVUM_SOURCE_DIR!;
const axe = readFileSync(createRequire(resolve("package.json")).resolve("axe-core/axe.min.js"), "utf8");
const pictures = resolve("pictures");
const password = "correct horse battery";

let folder = "";
let task = "";
let secret = "";
let address = "";
let server: ChildProcess | null = null;
let browser: Browser;

function run(home: string, args: string[], input = ""): string {
  const done = spawnSync(cavum, args, { encoding: "utf8", input, env: { ...process.env, CAVUM_HOME: join(folder, home), LANGUAGE: "en" } });
  assert.equal(done.status, 0, `cavum ${args.join(" ")}: ${done.stderr}`);
  return done.stdout;
}
const station = (...args: string[]): string => run("seat", ["office", args[0], "--server", address, "--certificate", join(folder, "school/office/certificate.pem"), ...args.slice(1)]);

/** RFC 6238, written anew: the code of this half minute. */
function code(): string {
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
  const bits = [...secret].map((c) => letters.indexOf(c).toString(2).padStart(5, "0")).join("");
  const key = Buffer.from(bits.match(/.{8}/g)!.map((b) => parseInt(b, 2)));
  const counter = Buffer.alloc(8);
  counter.writeBigUInt64BE(BigInt(Math.floor(Date.now() / 30_000)));
  const mac = createHmac("sha1", key).update(counter).digest();
  return String((mac.readUInt32BE(mac[19] & 15) & 0x7fffffff) % 1_000_000).padStart(6, "0");
}

before(async () => {
  if (k_skip) return;
  folder = mkdtempSync(join(tmpdir(), "cavum-office-"));
  mkdirSync(pictures, { recursive: true });
  mkdirSync(join(folder, "seat"));
  // its pass mark lies where an expert's sum is: the program leaves the verdict to a person
  const block = readFileSync(join(source, "tests/replay/block_cavity.toml"), "utf8");
  task = join(folder, "border_cavity.toml");
  writeFileSync(task, block.replace('id = "block_cavity"', 'id = "border_cavity"').replace("pass_percent = 60", "pass_percent = 99"));
  copyFileSync(join(source, "tests/replay/block.cvt"), join(folder, "block.cvt"));
  run("school", ["ledger", "init", join(folder, "ledger"), "--school", "School of Dentistry"]);
  secret = /secret=([A-Z2-7]+)/.exec(run("school", ["serve", "--add-account", "Anna Officer", "--role", "officer", "--second-factor"], `${password}\n`))![1];
  run("school", ["serve", "--add-account", "Eva Examiner", "--role", "examiner"], `${password}\n`);
  run("school", ["serve", "--add-account", "Ian Invigilator", "--role", "invigilator"], `${password}\n`);
  run("school", ["serve", "--add-account", "Rita Reader", "--role", "reader"], `${password}\n`);
  copyFileSync(join(folder, "school/school.pub"), join(folder, "seat/school.pub"));
  server = spawn(cavum, ["serve", join(folder, "ledger"), "--listen", "127.0.0.1:0", "--exam", task, "--simulated"], {
    env: { ...process.env, CAVUM_HOME: join(folder, "school"), LANGUAGE: "en" },
  });
  let said = "";
  server.stdout!.on("data", (text: Buffer) => (said += text.toString()));
  await until(async () => /https:\S+:\d+\s/.test(said), "the server says where it is");
  address = /https:\S+:\d+/.exec(said)![0];
  browser = await launch("--ignore-certificate-errors");
});

after(async () => {
  await browser?.close();
  server?.kill("SIGINT");
  if (folder) rmSync(folder, { recursive: true, force: true });
});

interface Desk { page: Page; complaints: string[] }

async function desk(name: string): Promise<Desk> {
  const context = await browser.createBrowserContext();
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  await page.setViewport({ width: 1280, height: 900 });
  const complaints: string[] = [];
  // a browser says of each request that is refused that it failed; the refusals are the server's to give
  page.on("console", (m) => { if (["error", "warn"].includes(m.type()) && !/status of 4\d\d/.test(m.text())) complaints.push(m.text()); });
  page.on("pageerror", (e) => complaints.push(String(e)));
  await page.goto(address);
  await type(page, "Name", name);
  await type(page, "Password", password);
  await page.keyboard.press("Enter");
  await page.waitForSelector("nav");
  return { page, complaints };
}

/** The control of a label, or with it as its own name. */
async function control(page: Page, label: string): Promise<string> {
  const id = await page.evaluate((text) => {
    const element = [...document.querySelectorAll("label")].find((l) => l.textContent!.trim() === text)?.htmlFor;
    if (element) return `#${element}`;
    return document.querySelector(`[aria-label="${text}"]`) ? `[aria-label="${text}"]` : "";
  }, label);
  assert.notEqual(id, "", `no control '${label}'`);
  return id;
}
async function type(page: Page, label: string, text: string): Promise<void> {
  await page.waitForFunction((l) => [...document.querySelectorAll("label")].some((e) => e.textContent!.trim() === l), {}, label).catch(() => undefined);
  const place = await control(page, label);
  await page.$eval(place, (e) => ((e as HTMLInputElement).value = ""));
  await page.type(place, text);
}
async function press(page: Page, text: string): Promise<void> {
  const found = await page.waitForSelector(`::-p-xpath(//button[normalize-space()="${text}" and not(@hidden)])`);
  await found!.click();
}
async function go(page: Page, title: string): Promise<void> {
  await (await page.waitForSelector(`::-p-xpath(//nav//a[normalize-space()="${title}"])`))!.click();
  await page.waitForSelector(`::-p-xpath(//nav//a[normalize-space()="${title}" and @aria-current="page"])`);
}
async function said(page: Page, words: string): Promise<void> {
  await until(async () => (await page.$eval("body", (b) => b.innerText)).includes(words), `'${words}' on the page: ${await page.$eval("body", (b) => b.innerText)}`);
}

async function look({ page }: Desk, name: string): Promise<void> {
  for (const width of [1280, 390]) {
    await page.setViewport({ width, height: width === 390 ? 844 : 900 });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${name} scrolls sideways at ${width}: ${wide}`);
    assert.deepEqual(await violations(page, axe), [], `${name} at ${width}`);
    await page.screenshot({ path: join(pictures, `${name}-${width}.png`) as `${string}.png`, fullPage: true });
  }
  await page.setViewport({ width: 1280, height: 900 });
}

function local(hours: number): string {
  const t = new Date(Date.now() + hours * 3_600_000 - new Date().getTimezoneOffset() * 60_000);
  return t.toISOString().slice(0, 16);
}

test("an exam day by clicks, from class list to gradebook", { skip: k_skip }, async () => {
  const entrance = await browser.newPage();
  await entrance.goto(address);
  await entrance.waitForSelector("form");
  await look({ page: entrance, complaints: [] }, "sign-in");
  await type(entrance, "Name", "Anna Officer");
  await type(entrance, "Password", "not the password");
  await press(entrance, "Sign in");
  await said(entrance, "do not belong together");
  await entrance.close();

  const officer = await desk("Anna Officer");
  const { page } = officer;
  await said(page, "No station is enrolled yet.");
  await type(page, "Name of the station", "Seat 3");
  await press(page, "Make a code");
  await page.waitForSelector("section code");
  station("enrol", "--code", await page.$eval("section code", (c) => c.textContent!));

  await go(page, "Class list");
  await type(page, "Paste the list, with its line of column names", "Matrikel;name;extra_time_percent;Platz\n4711;Anna Ä.;25;3\n4712;Berta;;4\n4713;Carl;;5\n");
  await press(page, "Read the list");
  await said(page, "Columns that wait for your answer: 2");
  await page.select(await control(page, "Use of column Matrikel"), "id");
  await said(page, "Columns that wait for your answer: 1");
  await page.select(await control(page, "Use of column Platz"), "pass over");
  await said(page, "25 % extra time");
  await look(officer, "class-list");
  for (const [label, hours] of [["May begin from", -1], ["May begin until", 3]] as [string, number][])
    await page.$eval(await control(page, label), (e, v) => ((e as HTMLInputElement).value = v), local(hours));
  await type(page, "Reason", "class of this year");
  await press(page, "Issue the tickets");
  await said(page, "Issued: 3. Refused: 0.");

  await go(page, "Tickets");
  await said(page, "4713");
  const cancelled = await page.$eval("tbody tr:nth-child(3) td:nth-child(3)", (c) => c.textContent!);
  await page.click(`[aria-label="Cancel the ticket of ${cancelled}"]`);
  await type(page, "Reason", "ill");
  await look(officer, "tickets-cancel");
  await page.keyboard.press("Enter");
  await said(page, "does not count any more");
  await look(officer, "tickets");

  station("tickets", "--out", join(folder, "tickets"));
  const tickets = readdirSync(join(folder, "tickets")).filter((f) => f.endsWith(".ticket"));
  assert.equal(tickets.length, 2, "the cancelled one is not among them");
  await go(page, "Exam day");
  station("report", "--state", "exam", "--candidate", tickets[0].slice(0, -7), "--step", "Outline", "--left-s", "754", "--alarm", "stylus lost");
  await said(page, "Alarm: stylus lost");
  await said(page, "12:3");
  await look(officer, "stations");
  tickets.forEach((t, i) => {
    run("seat", ["exam", task, "--ticket", join(folder, "tickets", t), "--operator", "expert", "--seed", String(i + 1), "--out", join(folder, `e${i}.cavum`)]);
    station("file", join(folder, `e${i}.cavum`), "--receipts", join(folder, "receipts"));
  });
  await said(page, "2 filed");

  const invigilator = await desk("Ian Invigilator");
  assert.deepEqual(await invigilator.page.$$eval("nav a", (all) => all.map((a) => a.textContent)), ["Exam day", "Tickets"]);
  const reader = await desk("Rita Reader");
  assert.deepEqual(await reader.page.$$eval("nav a", (all) => all.map((a) => a.textContent)), ["Results"]);
  assert.ok(!(await reader.page.$eval("main", (m) => m.innerText)).includes("4711"), "a reader sees no number");

  const examiner = await desk("Eva Examiner");
  await go(examiner.page, "Decisions");
  await said(examiner.page, tickets[0].slice(0, -7));
  await look(examiner, "decisions");
  for (const [verdict, reason] of [["pass", "the floor is sound"], ["fail", "a wall is thin"]]) {
    const waiting = (await examiner.page.$$("section.card")).length;
    await examiner.page.select(await control(examiner.page, "Verdict"), verdict);
    await type(examiner.page, "Reason", reason);
    await examiner.page.keyboard.press("Enter");
    await until(async () => (await examiner.page.$$("section.card")).length === waiting - 1, "one less waits");
  }
  await said(examiner.page, "Nothing waits for a decision.");
  assert.ok(!(await examiner.page.$eval("main", (m) => m.innerText)).includes("4711"), "an examiner sees no number");

  await go(page, "Results");
  await said(page, "ready for release");
  await type(page, "Reason", "board of May");
  await type(page, "Code of your app", "000000");
  await press(page, "Release all that are ready");
  await said(page, "is not good, or was used before");
  await look(officer, "results");
  await type(page, "Code of your app", code());
  await press(page, "Release all that are ready");
  await said(page, "Released: 2. Questioned: 0. Waiting for a decision: 0.");
  const book = await page.evaluate(async () => (await fetch("/api/gradebook.csv")).text());
  assert.match(book, /^"?ID number/);
  await press(page, "Sign out");
  await page.waitForSelector("input[type=password]");
  for (const one of [officer, invigilator, reader, examiner]) assert.deepEqual(one.complaints, []);
  const entries = run("school", ["ledger", "show", join(folder, "ledger")]);
  assert.match(entries, /release/);
  const verified = run("school", ["ledger", "verify", join(folder, "ledger")]);
  assert.match(verified, /verified/);
});
