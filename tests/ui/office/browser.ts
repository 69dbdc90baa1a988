// An exam office in a headless Chromium: `cavum serve` with accounts and stations' folders, people at its pages, and what they click and type.
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { createHmac } from "node:crypto";
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import type { Browser, Page } from "puppeteer-core";
import { launch, until, violations } from "../report_test/chromium.ts";

const cavum = process.env.CAVUM_BINARY!;
const source = process.env.CAVUM_SOURCE_DIR!;
const axe = readFileSync(
  createRequire(resolve("package.json")).resolve("axe-core/axe.min.js"),
  "utf8",
);
const pictures = resolve("pictures");
const password = "correct horse trial";

/** Of the office that is open. */
export let folder = "";
export let task = "";
export let address = "";
export let browser: Browser;
let secret = "";
let server: ChildProcess | null = null;

export function run(home: string, args: string[], input = ""): string {
  const done = spawnSync(cavum, args, {
    encoding: "utf8",
    input,
    env: { ...process.env, CAVUM_HOME: join(folder, home), LANGUAGE: "en" },
  });
  assert.equal(done.status, 0, `cavum ${args.join(" ")}: ${done.stderr}`);
  return done.stdout;
}
/** `cavum office` of the station whose folder this is. */
export function station(home: string, ...args: string[]): string {
  return run(home, [
    "office",
    args[0],
    "--server",
    address,
    "--certificate",
    join(folder, "school/office/certificate.pem"),
    ...args.slice(1),
  ]);
}

/** RFC 6238, written anew: the code of this half minute, or of one beside it, which is good, too. */
export function code(steps_on = 0): string {
  return code_of(secret, steps_on);
}
export function code_of(secret: string, steps_on = 0): string {
  const letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZ234567";
  const bits = [...secret].map((c) => letters.indexOf(c).toString(2).padStart(5, "0")).join("");
  const key = Buffer.from(bits.match(/.{8}/g)!.map((b) => parseInt(b, 2)));
  const counter = Buffer.alloc(8);
  counter.writeBigUInt64BE(BigInt(Math.floor(Date.now() / 30_000) + steps_on));
  const mac = createHmac("sha1", key).update(counter).digest();
  return String((mac.readUInt32BE(mac[19] & 15) & 0x7fffffff) % 1_000_000).padStart(6, "0");
}

/** The secret of its second factor, where it gets one. */
export function add_account(
  name: string,
  role: string,
  second_factor = false,
  ...further: string[]
): string {
  const told = run(
    "school",
    [
      "serve",
      "--add-account",
      name,
      "--role",
      role,
      ...(second_factor ? ["--second-factor"] : []),
      ...further,
    ],
    `${password}\n`,
  );
  return /secret=([A-Z2-7]+)/.exec(told)?.[1] ?? "";
}

/** Further options of the next office's server, by its folder. */
let more: (folder: string) => string[] = () => [];
export function serve_with(options: (folder: string) => string[]): void {
  more = options;
}

/** Of the next office's exam: its pass mark, and what stands below the rest of the scenario. */
let pass_percent = 99,
  more_toml = "";
export function examine_with(mark: number, toml: string): void {
  pass_percent = mark;
  more_toml = toml;
}

/** Of the next office's pages. Helpers name what they press in English, and find it by what it says in that language. */
let language = "en",
  words: { [english: string]: string } = {};
export function speak(other: string): void {
  language = other;
}
/** A text of the page as the office's language has it. */
export function in_language(english: string): string {
  return words[english] ?? english;
}

/** Opens an office with an account of each role and a folder for each station. */
export async function open_office(...seats: string[]): Promise<void> {
  folder = mkdtempSync(join(tmpdir(), "cavum-office-"));
  mkdirSync(pictures, { recursive: true });
  // its pass mark lies where an expert's sum is: the program leaves the verdict to a person
  const block = readFileSync(join(source, "tests/replay/block_cavity.toml"), "utf8");
  task = join(folder, "border_cavity.toml");
  writeFileSync(
    task,
    block
      .replace('id = "block_cavity"', 'id = "border_cavity"')
      .replace("pass_percent = 60", `pass_percent = ${pass_percent}`) + more_toml,
  );
  copyFileSync(join(source, "tests/replay/block.cvt"), join(folder, "block.cvt"));
  run("school", ["ledger", "init", join(folder, "ledger"), "--school", "School of Dentistry"]);
  secret = add_account("Anna Officer", "officer", true);
  add_account("Eva Examiner", "examiner");
  add_account("Ian Invigilator", "invigilator");
  add_account("Rita Reader", "reader");
  for (const seat of seats) {
    mkdirSync(join(folder, seat));
    copyFileSync(join(folder, "school/school.pub"), join(folder, seat, "school.pub"));
  }
  server = spawn(
    cavum,
    [
      "serve",
      join(folder, "ledger"),
      "--listen",
      "127.0.0.1:0",
      "--exam",
      task,
      "--simulated",
      ...more(folder),
    ],
    {
      env: { ...process.env, CAVUM_HOME: join(folder, "school"), LANGUAGE: language },
    },
  );
  let said = "";
  server.stdout!.on("data", (text: Buffer) => (said += text.toString()));
  await until(async () => /https:\S+:\d+\D/.test(said), "the server says where it is");
  address = /https:\S+:\d+/.exec(said)![0];
  browser = await launch("--ignore-certificate-errors");
  if (language === "en") return;
  const page = await browser.newPage();
  await page.goto(address);
  words = await page.evaluate(
    async () =>
      ((await (await fetch("/api/words")).json()) as { words: { [english: string]: string } })
        .words,
  );
  await page.close();
}

export async function close_office(): Promise<void> {
  await browser?.close();
  server?.kill("SIGINT");
  if (folder) rmSync(folder, { recursive: true, force: true });
}

export interface Desk {
  page: Page;
  complaints: string[];
}

export async function desk(name: string): Promise<Desk> {
  const context = await browser.createBrowserContext();
  const page = await context.newPage();
  page.setDefaultTimeout(30_000);
  await page.setViewport({ width: 1280, height: 900 });
  const complaints: string[] = [];
  // a browser says of each request that is refused that it failed; the refusals are the server's to give
  page.on("console", (m) => {
    if (["error", "warn"].includes(m.type()) && !/status of 4\d\d/.test(m.text()))
      complaints.push(m.text());
  });
  page.on("pageerror", (e) => complaints.push(String(e)));
  await page.goto(address);
  await type(page, "Name", name);
  await type(page, "Password", password);
  await page.keyboard.press("Enter");
  await page.waitForSelector("nav");
  return { page, complaints };
}

/** The control of a label, or with it as its own name. */
export async function control(page: Page, english: string): Promise<string> {
  const label = in_language(english);
  const id = await page.evaluate((text) => {
    const element = [...document.querySelectorAll("label")].find(
      (l) => l.textContent!.trim() === text,
    )?.htmlFor;
    if (element) return `#${element}`;
    return document.querySelector(`[aria-label="${text}"]`) ? `[aria-label="${text}"]` : "";
  }, label);
  assert.notEqual(id, "", `no control '${label}'`);
  return id;
}
export async function type(page: Page, label: string, text: string): Promise<void> {
  await page
    .waitForFunction(
      (l) => [...document.querySelectorAll("label")].some((e) => e.textContent!.trim() === l),
      {},
      in_language(label),
    )
    .catch(() => undefined);
  const place = await control(page, label);
  await page.$eval(place, (e) => ((e as HTMLInputElement).value = ""));
  await page.type(place, text);
}
/** Waits until it stands still: the live board may grow above it. */
export async function press(page: Page, text: string): Promise<void> {
  await page
    .locator(`::-p-xpath(//button[normalize-space()="${in_language(text)}" and not(@hidden)])`)
    .click();
}
export async function go(page: Page, english: string): Promise<void> {
  const title = in_language(english);
  if (await page.$(`::-p-xpath(//nav//a[normalize-space()="${title}" and @aria-current="page"])`))
    return;
  const before = await page.$eval("h1", (h) => h.textContent);
  await (await page.waitForSelector(`::-p-xpath(//nav//a[normalize-space()="${title}"])`))!.click();
  await page.waitForSelector(
    `::-p-xpath(//nav//a[normalize-space()="${title}" and @aria-current="page"])`,
  );
  await page.waitForFunction(
    (old) => document.querySelector("h1")?.textContent !== old,
    {},
    before,
  );
}
export async function said(page: Page, words: string): Promise<void> {
  const text = (): Promise<string> => page.$eval("body", (b) => b.innerText);
  await until(
    async () => (await text()).includes(words),
    `'${words}' on the page`,
    async () => `, where there is: ${await text()}`,
  );
}
/** Waits for a refusal in which all these names stand. */
export async function refused(page: Page, ...names: string[]): Promise<void> {
  const told = (): Promise<string> =>
    page.$eval("#said", (s) => (s.classList.contains("wrong-said") ? s.textContent! : ""));
  await until(async () => {
    const words = await told();
    return words !== "" && names.every((n) => words.includes(n));
  }, `a refusal: ${names.join()}`);
}

/** A station of this folder and name is enrolled, by an officer at the board. */
export async function invite(page: Page, home: string, name: string): Promise<void> {
  await type(page, "Name of the station", name);
  const before = /S(-\w{4}){5}/.exec(await page.$eval("main", (m) => m.innerText))?.[0] ?? "";
  await press(page, "Make a code");
  let code = before;
  await until(
    async () =>
      (code = /S(-\w{4}){5}/.exec(await page.$eval("main", (m) => m.innerText))?.[0] ?? before) !==
      before,
    "a code",
  );
  station(home, "enrol", "--code", code);
  await said(page, name);
}

export async function look({ page }: Desk, name: string): Promise<void> {
  for (const width of [1280, 390]) {
    await page.setViewport({ width, height: width === 390 ? 844 : 900 });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.ok(wide <= width, `${name} scrolls sideways at ${width}: ${wide}`);
    assert.deepEqual(await violations(page, axe), [], `${name} at ${width}`);
    const height = Math.min(4000, await page.evaluate(() => document.documentElement.scrollHeight)); // of a long list its beginning
    await page.screenshot({
      path: join(pictures, `${name}-${width}.png`) as `${string}.png`,
      clip: { x: 0, y: 0, width, height },
      captureBeyondViewport: true,
    });
  }
  await page.setViewport({ width: 1280, height: 900 });
}

export function local(hours: number): string {
  const t = new Date(Date.now() + hours * 3_600_000 - new Date().getTimezoneOffset() * 60_000);
  return t.toISOString().slice(0, 16);
}
