// A makeup sitting in a real browser, by keys: for who was interrupted, with the accommodations of the first ticket, and for who did not come.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Page } from "puppeteer-core";
import { k_skip } from "../report_test/chromium.ts";
import {
  close_office,
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
import { issue, say_times } from "./hall.ts";

before(async () => {
  if (!k_skip) await open_office("seat");
});
after(close_office);

async function make_up(page: Page, code: string, became: string, granted: string): Promise<void> {
  await page.focus(`[aria-label="Makeup sitting for ${code}"]`);
  await page.keyboard.press("Enter");
  await page.select(await control(page, "The first sitting"), became);
  await say_times(page, -60, 180);
  await page.select(await control(page, "Accommodations"), granted);
}
async function granted_to(page: Page, code: string, extra: string): Promise<void> {
  await said(page, `${code} has a makeup sitting: `);
  assert.ok((await page.$eval("#said", (s) => s.textContent!)).includes(extra));
}

test("makeup sittings by keys", { skip: k_skip }, async () => {
  const officer = await desk("Anna Officer");
  const { page } = officer;
  await invite(page, "seat", "Seat 1");
  await go(page, "Class list");
  await type(
    page,
    "Paste the list, with its line of column names",
    "id,name,station\n4711,Anna A.,Seat 1\n4712,Bert B.,Seat 9\n",
  );
  await press(page, "Read the list");
  await said(page, "'Seat 9'");
  await look(officer, "unknown-station");
  await go(page, "Tickets");
  await issue(page, "id,name,extra_time_percent,station\n4711,Anna A.,25,Seat 1\n");
  await go(page, "Tickets");
  await issue(page, "id,name,extra_time_percent\n4712,Bert B.,30\n", -180, -120);
  await go(page, "Tickets");
  await said(page, "4712");
  assert.equal(
    await page.$eval(
      'td[data-label="Station"] select',
      (s) => (s as HTMLSelectElement).selectedOptions[0].textContent,
    ),
    "Seat 1",
  );
  const codes = await page.$$eval("tbody tr", (all) => all.map((r) => r.children[2].textContent!));

  await make_up(page, codes[0], "interrupted", "as before");
  await type(page, "Reason", "the power failed");
  await look(officer, "makeup-form");
  await page.keyboard.press("Enter");
  await granted_to(page, codes[0], "25 %");
  await said(page, "interrupted; ");
  await said(page, ". Reason: the power failed");

  await make_up(page, codes[1], "missed", "as before"); // it ran out, and is kept for this
  await type(page, "Reason", "ill, with a certificate");
  await page.keyboard.press("Enter");
  await granted_to(page, codes[1], "30 %");
  await said(page, "missed; ");
  await look(officer, "makeup-tickets");

  station("seat", "tickets", "--out", join(folder, "tickets"));
  const tickets = readdirSync(join(folder, "tickets")).filter((f) => f.endsWith(".ticket"));
  assert.deepEqual(
    tickets.map((t) => t.slice(0, -7)).sort(),
    [...codes].sort(),
    "one ticket for each",
  );
  run("seat", [
    "exam",
    task,
    "--ticket",
    join(folder, "tickets", `${codes[1]}.ticket`),
    "--operator",
    "expert",
    "--out",
    join(folder, "e.cavum"),
  ]);
  station("seat", "file", join(folder, "e.cavum"));
  await go(page, "Results");
  await said(page, "makeup sitting of ticket");
  assert.deepEqual(officer.complaints, []);
});
