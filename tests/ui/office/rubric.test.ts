// A new rubric over a whole class in a real browser, by keys: tried, left and come back to, looked at, counted with a reason and a code.
import assert from "node:assert/strict";
import { readdirSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { k_skip } from "../report_test/chromium.ts";
import {
  add_account,
  close_office,
  code_of,
  control,
  desk,
  folder,
  go,
  invite,
  look,
  open_office,
  refused,
  run,
  said,
  station,
  task,
  type,
} from "./browser.ts";
import { issue } from "./hall.ts";

before(async () => {
  if (!k_skip) await open_office("seat");
});
after(close_office);

test("a new rubric over a class by keys", { skip: k_skip }, async () => {
  const secret = add_account("Eva Second", "examiner", true);
  const { page } = await desk("Anna Officer");
  await invite(page, "seat", "Seat 1");
  await issue(page, "id,name\n4711,Anna A.\n4712,Bert B.\n");
  await said(page, "Issued: 2.");
  station("seat", "tickets", "--out", join(folder, "tickets"));
  const tickets = readdirSync(join(folder, "tickets")).filter((f) => f.endsWith(".ticket"));
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
    station("seat", "file", join(folder, `e${i}.cavum`));
  });

  const rubric = join(folder, "new.toml");
  writeFileSync(
    rubric,
    '[rubric]\nrule = "compensatory"\npass_percent = 10\n[[rubric.criteria]]\nid = "removed"\nmetric = "target_removed_percent"\nfull = 50\nzero = 0\npoints = 10\n',
  );
  const eva = await desk("Eva Second");
  await go(eva.page, "New rubric");
  await look(eva, "rubric-choice");
  await eva.page.select(await control(eva.page, "Exam"), "border_cavity");
  await (
    (await eva.page.$(
      await control(eva.page, "The new rubric"),
    )) as import("puppeteer-core").ElementHandle<HTMLInputElement>
  ).uploadFile(rubric);
  await eva.page.focus("main button.main");
  await eva.page.keyboard.press("Enter");
  await said(eva.page, "tried by Eva Second");
  await eva.page.reload(); // it goes on without its page
  await eva.page.waitForSelector("nav");
  await go(eva.page, "New rubric");
  await said(eva.page, "Who would change: 2");
  const shown = await eva.page.$eval("main", (m) => m.innerText);
  for (const t of tickets) assert.ok(shown.includes(t.slice(0, -7)));
  assert.ok(!shown.includes("4711"), "an examiner sees no number");
  await look(eva, "rubric-preview");

  await go(page, "Results");
  assert.equal(
    (await page.$$("::-p-xpath(//nav//a[normalize-space()='New rubric'])")).length,
    0,
    "no officer's view",
  );
  await type(eva.page, "Reason", "question 3 was misprinted");
  await type(eva.page, "Code of your app", "000000");
  await eva.page.keyboard.press("Enter");
  await refused(eva.page);
  await type(eva.page, "Code of your app", code_of(secret));
  await eva.page.keyboard.press("Enter");
  await said(eva.page, "Entered: 2 results, which wait for their release.");
  await said(eva.page, "It counts: entries");
  await look(eva, "rubric-counted");
  run("school", ["ledger", "verify", join(folder, "ledger")]);
  assert.deepEqual(eva.complaints, []);
});
