// From a learning platform to a released result, by clicks in a real browser: the platform is of another site, as a school's is, so that the browser's
// rules for cookies, forms and frames of other sites hold. The platform is the emulator of lti/platform.py.
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { readFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Page } from "puppeteer-core";
import { k_skip, until } from "../report_test/chromium.ts";
import {
  address,
  browser,
  close_office,
  code,
  control,
  desk,
  folder,
  go,
  invite,
  look,
  open_office,
  press,
  run,
  said,
  station,
  task,
  type,
} from "./browser.ts";
import { issue, tickets_page } from "./hall.ts";

let platform: ChildProcess | null = null;
let school = ""; // the platform's address

before(async () => {
  if (k_skip) return;
  await open_office("seat");
  const [certificate, key] = ["platform.pem", "platform.key"].map((name) => join(folder, name));
  const made = spawnSync(
    "openssl",
    [
      "req",
      "-x509",
      "-newkey",
      "ec",
      "-pkeyopt",
      "ec_paramgen_curve:prime256v1",
      "-nodes",
      "-days",
      "2",
      "-subj",
      "/CN=localhost",
      "-addext",
      "subjectAltName=DNS:localhost",
      "-keyout",
      key,
      "-out",
      certificate,
    ],
    { encoding: "utf8" },
  );
  assert.equal(made.status, 0, made.stderr);
  platform = spawn(
    "python3",
    [
      join(process.env.CAVUM_SOURCE_DIR!, "tests/ui/office/lti/platform.py"),
      "--certificate",
      certificate,
      "--key",
      key,
      "--tool",
      address,
      "--name",
      "localhost",
    ],
    { stdio: ["ignore", "pipe", "inherit"] },
  );
  let port = "";
  platform.stdout!.on("data", (text: Buffer) => (port += text.toString()));
  await until(async () => port.includes("\n"), "the platform says its port");
  school = `https://localhost:${port.trim()}`;
});
after(async () => {
  platform?.kill();
  await close_office();
});

/** What the activity of the course says to the tool. */
async function activity(exam: string): Promise<void> {
  const page = await browser.newPage();
  await page.goto(`${school}/course?as=Learner:1`);
  assert.equal(
    await page.evaluate(
      async (what) => (await fetch("/control", { method: "POST", body: what })).status,
      JSON.stringify({ exam }),
    ),
    200,
  );
  await page.close();
}
/** A browser of its own, in the course as this person ("Learner:4711"). */
async function course(who: string, framed = false): Promise<Page> {
  const page = await (await browser.createBrowserContext()).newPage();
  page.setDefaultTimeout(30_000);
  await page.goto(`${school}/course?as=${encodeURIComponent(who)}${framed ? "&framed=" : ""}`);
  return page;
}
const words = (page: Page): Promise<string> => page.$eval("body", (b) => b.innerText);

test("a learner comes from the course to his own result", { skip: k_skip }, async () => {
  const officer = await desk("Anna Officer");
  const { page } = officer;
  await invite(page, "seat", "Seat 1");
  await issue(page, "id,name\n4711,Anna A.\n4712,Bert B.\n");
  const one = (await tickets_page(page)).get("4711")!.code;
  station("seat", "tickets", "--out", join(folder, "tickets"));
  run("seat", [
    "exam",
    task,
    "--ticket",
    join(folder, "tickets", `${one}.ticket`),
    "--operator",
    "expert",
    "--out",
    join(folder, "e.cavum"),
  ]);
  station("seat", "file", join(folder, "e.cavum"));

  await go(page, "Learning platforms");
  await page.click("main details summary");
  for (const [label, value] of [
    ["Name of the platform", "Moodle"],
    ["Issuer", school],
    ["Client ID", "cavum-1"],
    ["Deployment IDs", "1"],
    ["Authentication request URL", `${school}/auth`],
    ["Access token URL", `${school}/token`],
    ["Public keyset URL of the platform", `${school}/jwks`],
    ["Code of your app", code()],
  ])
    await type(page, label, value);
  await page.focus(await control(page, "Certificate (PEM)"));
  await page.keyboard.sendCharacter(readFileSync(join(folder, "platform.pem"), "utf8"));
  await press(page, "Set it up");
  await said(page, "Set up. Give the platform's administrator the addresses above.");
  await look(officer, "platform-set-up");

  await activity("border_cavity");
  const early = await course("Learner:4711");
  await early.click("a");
  await early.waitForFunction((office) => location.origin === office, {}, address);
  await early.waitForSelector("main p");
  assert.equal(await early.$("main li"), null, "nothing was released");

  const result = JSON.parse(run("school", ["grade", join(folder, "e.cavum"), "--json"]));
  const eva = await desk("Eva Examiner");
  await go(eva.page, "Decisions");
  if (result.verdict === "review") {
    await eva.page.select(await control(eva.page, "Verdict"), "pass");
    await type(eva.page, "Reason", "whole");
    await press(eva.page, "Decide");
    await said(eva.page, "Decided: entry");
  }
  await go(page, "Results");
  await type(page, "Reason", "board");
  await type(page, "Code of your app", code(1));
  await press(page, "Release");
  await said(page, "Released: 1.");

  const learner = await course("Learner:4711");
  await learner.click("a");
  await learner.waitForFunction((office) => location.origin === office, {}, address);
  await said(learner, String(Math.round(result.score.points * 10) / 10));
  await look({ page: learner, complaints: [] }, "platform-learner");
  assert.match(
    await learner.$eval("main li", (l) => l.textContent!),
    /\. \S/,
    "that it is a rehearsal",
  );
  await Promise.all([learner.waitForNavigation(), learner.click("main a")]);
  await learner.waitForSelector(".verdict");
  await learner.goBack();
  await learner.reload(); // his visit lasts
  await said(learner, String(Math.round(result.score.points * 10) / 10));

  const other = await course("Learner:4712");
  await other.click("a");
  await other.waitForFunction((office) => location.origin === office, {}, address);
  assert.ok(
    !(await words(other)).includes(String(Math.round(result.score.points * 10) / 10)),
    "another's result",
  );

  // the platform's page has the tool in a frame: only a link stands there, and it opens a window
  const framed = await course("Learner:4711", true);
  const frame = await (await framed.waitForSelector("iframe"))!.contentFrame();
  const link = await frame.waitForSelector("a[target=_blank]");
  await framed.screenshot({ path: "pictures/platform-framed.png" });
  assert.ok(
    !(await frame.$eval("body", (b) => b.innerText)).includes(String(result.score.points)),
    "nothing of a result in a frame",
  );
  const window_opened = new Promise<Page>((done) => framed.once("popup", (p) => done(p!)));
  await link!.click();
  await said(await window_opened, String(Math.round(result.score.points * 10) / 10));

  // a teacher without an account reads, under pseudonyms
  const teacher = await course("Instructor:900");
  await teacher.click("a");
  await teacher.waitForSelector("nav");
  await said(teacher, one);
  assert.ok(!(await words(teacher)).includes("Anna A."), "a name");
  for (const one_desk of [officer, eva]) assert.deepEqual(one_desk.complaints, []);
});
