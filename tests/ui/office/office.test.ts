// An exam day in a real browser, by clicks and keys only: sign-in, class list, tickets, a station's report, a decision, the release, the gradebook.
// Each page is looked at by axe-core, at 1280 and at 390 pixels, and its picture is kept.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
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
  local,
  look,
  open_office,
  press,
  refused,
  run,
  said,
  station,
  task,
  type,
} from "./browser.ts";

before(async () => {
  if (!k_skip) await open_office("seat");
});
after(close_office);

test("an exam day by clicks, from class list to gradebook", { skip: k_skip }, async () => {
  const entrance = await browser.newPage();
  await entrance.goto(address);
  await entrance.waitForSelector("form");
  await look({ page: entrance, complaints: [] }, "sign-in");
  await type(entrance, "Name", "Anna Officer");
  await type(entrance, "Password", "not the password");
  await press(entrance, "Sign in");
  await refused(entrance);
  await entrance.close();

  const officer = await desk("Anna Officer");
  const { page } = officer;
  await said(page, "No station is enrolled yet.");
  await type(page, "Name of the station", "Seat 3");
  await press(page, "Make a code");
  await page.waitForSelector("section code");
  station("seat", "enrol", "--code", await page.$eval("section code", (c) => c.textContent!));

  await go(page, "Class list");
  await type(
    page,
    "Paste the list, with its line of column names",
    "Matrikel;name;extra_time_percent;Platz\n4711;Anna Ä.;25;3\n4712;Berta;;4\n4713;Carl;;5\n",
  );
  await press(page, "Read the list");
  await said(page, "Columns that wait for your answer: 2");
  await page.select(await control(page, "Use of column Matrikel"), "id");
  await said(page, "Columns that wait for your answer: 1");
  await page.select(await control(page, "Use of column Platz"), "pass over");
  await said(page, "25 %");
  await look(officer, "class-list");
  for (const [label, hours] of [
    ["May begin from", -1],
    ["May begin until", 3],
  ] as [string, number][])
    await page.$eval(
      await control(page, label),
      (e, v) => ((e as HTMLInputElement).value = v),
      local(hours),
    );
  await type(page, "Reason", "class of this year");
  await press(page, "Issue the tickets");
  await said(page, "Issued: 3. Refused: 0.");

  await go(page, "Tickets");
  await said(page, "4713");
  const cancelled = await page.$eval(
    "tbody tr:nth-child(3) td:nth-child(3)",
    (c) => c.textContent!,
  );
  await page.click(`[aria-label="Cancel the ticket of ${cancelled}"]`);
  await type(page, "Reason", "ill");
  await look(officer, "tickets-cancel");
  await page.keyboard.press("Enter");
  await said(page, "does not count any more");
  await look(officer, "tickets");

  station("seat", "tickets", "--out", join(folder, "tickets"));
  const tickets = readdirSync(join(folder, "tickets")).filter((f) => f.endsWith(".ticket"));
  assert.equal(tickets.length, 2, "the cancelled one is not among them");
  await go(page, "Exam day");
  station(
    "seat",
    "report",
    "--state",
    "exam",
    "--candidate",
    tickets[0].slice(0, -7),
    "--step",
    "Outline",
    "--remaining-s",
    "754",
    "--alarm",
    "stylus lost",
  );
  await said(page, "Alarm: stylus lost");
  await said(page, "12:3");
  await look(officer, "stations");
  tickets.forEach((t, i) => {
    run("seat", [
      "exam",
      task,
      "--ticket",
      join(folder, "tickets", t),
      "--operator",
      "expert",
      "--seed",
      String(i + 1),
      "--out",
      join(folder, `e${i}.cavum`),
    ]);
    station("seat", "file", join(folder, `e${i}.cavum`), "--receipts", join(folder, "receipts"));
  });
  await said(page, "2 filed");

  const invigilator = await desk("Ian Invigilator");
  assert.deepEqual(await invigilator.page.$$eval("nav a", (all) => all.map((a) => a.textContent)), [
    "Exam day",
    "Tickets",
    "Incidents",
  ]);
  const reader = await desk("Rita Reader");
  assert.deepEqual(await reader.page.$$eval("nav a", (all) => all.map((a) => a.textContent)), [
    "Results",
    "Trail",
  ]);
  assert.ok(
    !(await reader.page.$eval("main", (m) => m.innerText)).includes("4711"),
    "a reader sees no number",
  );

  const examiner = await desk("Eva Examiner");
  await go(examiner.page, "Decisions");
  await said(examiner.page, tickets[0].slice(0, -7));
  await look(examiner, "decisions");
  for (const [verdict, reason] of [
    ["pass", "the floor is sound"],
    ["fail", "a wall is thin"],
  ]) {
    const waiting = (await examiner.page.$$("section.card")).length;
    await examiner.page.select(await control(examiner.page, "Verdict"), verdict);
    await type(examiner.page, "Reason", reason);
    await examiner.page.keyboard.press("Enter");
    await until(
      async () => (await examiner.page.$$("section.card")).length === waiting - 1,
      "one less waits",
    );
  }
  await said(examiner.page, "Nothing waits for a decision.");
  assert.ok(
    !(await examiner.page.$eval("main", (m) => m.innerText)).includes("4711"),
    "an examiner sees no number",
  );

  await go(page, "Results");
  await said(page, "ready for release");
  await type(page, "Reason", "board of May");
  await type(page, "Code of your app", "000000");
  await press(page, "Release");
  await refused(page);
  await look(officer, "results");
  await type(page, "Code of your app", code(-1));
  await press(page, "Release");
  await said(page, "Released: 2.");
  const book = await page.evaluate(async () => (await fetch("/api/gradebook.csv")).text());
  assert.match(book, /^"?ID number/);

  // An appeal: the officer enters it, the examiner looks at tooth and replay, decides otherwise, and answers.
  await go(page, "Appeals");
  const failed = await page.evaluate(
    async () =>
      (await (await fetch("/api/results")).json()).results.find(
        (r: { verdict: string }) => r.verdict === "fail",
      ) as { session: number; candidate: string; sha256: string },
  );
  await page.select(await control(page, "Result"), String(failed.session));
  await type(page, "What the candidate objects to", "the wall is as thick as asked");
  await press(page, "Enter the appeal");
  await said(page, "The appeal is open");
  await look(officer, "appeals");
  await go(examiner.page, "Appeals");
  await said(examiner.page, "the wall is as thick as asked");
  const [opened] = await Promise.all([
    new Promise<import("puppeteer-core").Page>((found) =>
      examiner.page.once("popup", (p) => found(p!)),
    ),
    examiner.page.click("a[href^='/api/report/']"),
  ]);
  await opened.waitForFunction(() => document.querySelector("canvas") !== null, {
    timeout: 60_000,
  });
  assert.ok((await opened.$eval("body", (b) => b.innerText)).includes(failed.candidate));
  assert.ok(
    await opened.evaluate(() => {
      try {
        return document.cookie === "";
      } catch {
        return true;
      }
    }),
    "no cookie of the office's is seen",
  );
  await opened.close();
  await examiner.page.click("details summary");
  await examiner.page.select(await control(examiner.page, "Another verdict"), "pass");
  await type(examiner.page, "Reason", "measured again by two");
  await press(examiner.page, "Decide");
  await said(examiner.page, "Another result was entered since the appeal.");
  await type(examiner.page, "Answer", "the wall holds");
  await look(examiner, "appeal-answer");
  await press(examiner.page, "Answer: the result was changed");
  await said(examiner.page, "The result was changed.");

  // A retraction, and the release of what is ready then: of the changed result, and not of what was taken back.
  await go(page, "Results");
  const first = await page.evaluate(
    async () =>
      (await (await fetch("/api/results")).json()).results.find(
        (r: { verdict: string; state: string }) => r.state === "released",
      ) as { session: number },
  );
  await page.click("main details summary");
  await page.select(await control(page, "Released result"), String(first.session));
  const back = await page.evaluateHandle(() =>
    [...document.querySelectorAll("form")].find((f) => f.textContent!.includes("Take it back"))!,
  );
  const fields = await back.$$("input");
  await fields[0].type("the wrong tooth was mounted");
  await fields[1].type(code());
  await look(officer, "results-back");
  await fields[1].press("Enter");
  await said(page, "Taken back: entry");
  await type(page, "Reason", "after the appeal");
  await type(page, "Code of your app", code(1));
  await press(page, "Release");
  await said(page, "Released: 1.");
  await said(page, "taken back: released by name only; reason: the wrong tooth was mounted");

  // Learning platforms: what is typed in is looked at, and changes nothing without a code.
  await go(page, "Learning platforms");
  await said(page, "No course is known yet.");
  await page.click("details summary");
  const typed: [string, string][] = [
    ["Name of the platform", "Moodle"],
    ["Issuer", "https://moodle.example"],
    ["Client ID", "c1"],
    ["Deployment IDs", "1, 2"],
    ["Authentication request URL", "https://moodle.example/auth"],
    ["Access token URL", "https://moodle.example/token"],
    ["Public keyset URL of the platform", "https://moodle.example/jwks"],
  ];
  for (const [label, text] of typed) await type(page, label, text);
  await look(officer, "platforms");
  await page.type("details[open] input[autocomplete=one-time-code]", "000000");
  await press(page, "Set it up");
  await refused(page);
  await press(page, "Sign out");
  await page.waitForSelector("input[type=password]");
  for (const one of [officer, invigilator, reader, examiner]) assert.deepEqual(one.complaints, []);
  run("school", ["ledger", "verify", join(folder, "ledger")]);
});
