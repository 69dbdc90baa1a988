// What the pages say once something was done, refused, or is over: of which station, of which recording, and why somebody is out.
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Page } from "puppeteer-core";
import { k_skip, until } from "../report_test/chromium.ts";
import {
  add_account,
  close_office,
  control,
  desk,
  folder,
  go,
  invite,
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
import { download } from "./hall.ts";

const seats = ["seat1", "seat2", "seat3"];
before(async () => {
  if (k_skip) return;
  await open_office(...seats);
});
after(close_office);

/** Stations whose key is revoked, as the board's cards say. */
const dead = (page: Page): Promise<string[]> =>
  page.$$eval(".cards .card", (all) =>
    all
      .filter((c) => (c as HTMLElement).innerText.includes("Key revoked"))
      .map((c) => c.querySelector("h3")!.textContent!),
  );

test(
  "two stations are revoked one after the other, each by its name",
  { skip: k_skip },
  async () => {
    const { page, complaints } = await desk("Anna Officer");
    for (const [i, home] of seats.entries()) await invite(page, home, `Seat ${i + 1}`);
    const revoked: string[] = [];
    page.on("request", (r) => {
      if (r.url().endsWith("/api/stations/revoke"))
        revoked.push((JSON.parse(r.postData()!) as { reason: string }).reason);
    });
    for (const name of ["Seat 2", "Seat 3"]) {
      const section = (await page.waitForSelector(
        '::-p-xpath(//section[h2="Revoke a station\'s key"])',
      ))!;
      await press(page, "Revoke");
      const list = (await section.$("select"))!;
      assert.equal(await list.evaluate((l) => l.value), "", "no station is chosen by itself");
      await list.select(
        ...(await list.$$eval(
          "option",
          (all, n) => all.filter((o) => o.textContent === n).map((o) => o.value),
          name,
        )),
      );
      await type(page, "Reason", `${name} was stolen`);
      await press(page, "Revoke");
      await said(page, `What ${name} sends from now on does not count.`);
      assert.equal(await section.$("form"), null, "the form is closed");
      await until(async () => (await dead(page)).includes(name), `${name} is dead on the board`);
    }
    assert.deepEqual(revoked, ["Seat 2 was stolen", "Seat 3 was stolen"]);
    assert.deepEqual(await dead(page), ["Seat 2", "Seat 3"]);

    // what is said covers no button that was just pressed
    await press(page, "Revoke");
    const section = (await page.$('::-p-xpath(//section[h2="Revoke a station\'s key"])'))!;
    await (await section.$("select"))!.select(
      await section.$$eval("option", (all) => all.find((o) => o.textContent === "Seat 1")!.value),
    );
    await type(page, "Reason", "x");
    await page.$eval(
      "section form input[maxlength='2000']",
      (e) => ((e as HTMLInputElement).value = "ä".repeat(1500)),
    ); // more bytes than the office takes
    await press(page, "Revoke");
    await page.waitForSelector("#said.wrong-said:not(:empty)");
    const on_top = await page.$$eval("form button.main", (all) => {
      const last = all[all.length - 1],
        at = last.getBoundingClientRect();
      return document.elementFromPoint(at.x + at.width / 2, at.y + at.height / 2) === last;
    });
    assert.ok(on_top, "the next click is the button's");
    assert.deepEqual(complaints, []);
  },
);

test(
  "of what was refused the station is said, and no folder of the server",
  { skip: k_skip },
  async () => {
    const officer = await desk("Anna Officer");
    const { page, complaints } = officer;
    const file = join(folder, "no_exam.cavum");
    writeFileSync(file, `SQLite format 3\0${"no exam ".repeat(100)}`);
    assert.throws(() => station("seat1", "file", file), "it is not filed");
    await said(page, "Refused");
    const row = await page.$$eval("table.stack tbody tr", (all) =>
      all
        .map((r) => [...r.children].map((c) => c.textContent!))
        .find((cells) => cells[0] === "Seat 1")!,
    );
    assert.notEqual(row[2], "", "why");
    assert.ok(
      !(await page.$eval("main", (m) => m.innerText)).includes("/"),
      await page.$eval("main", (m) => m.innerText),
    );
    await look(officer, "day-refused");
    await page.setViewport({ width: 390, height: 844 });
    const wide = await page.$eval("table.stack td[data-label=Why]", (cell) => {
      cell.textContent = "/a_long_word".repeat(40);
      return document.documentElement.scrollWidth;
    });
    assert.ok(wide <= 390, `a long word scrolls sideways: ${wide}`);
    assert.deepEqual(complaints, []);
  },
);

test("who decides second hears of the first, and sees what is left", { skip: k_skip }, async () => {
  const file = join(folder, "border.cavum");
  run("seat1", [
    "exam",
    task,
    "--candidate",
    "K7",
    "--operator",
    "expert",
    "--seed",
    "3",
    "--out",
    file,
  ]);
  assert.throws(
    () =>
      run("school", [
        "ledger",
        "add",
        join(folder, "ledger"),
        file,
        "--with-findings",
        "--simulated",
      ]),
    "it was found that it has no ticket",
  );
  add_account("Emil Examiner", "examiner");
  const both = [await desk("Eva Examiner"), await desk("Emil Examiner")];
  for (const { page } of both) {
    await go(page, "Decisions");
    await page.select(await control(page, "Verdict"), "pass");
    await type(page, "Reason", "looked at it");
  }
  const [first, second] = both.map((d) => d.page);
  await press(first, "Decide");
  await said(first, "Decided: entry");
  await press(second, "Decide");
  await refused(second, "Eva Examiner");
  await said(second, "Nothing waits for a decision.");
  assert.ok(
    !/cavum|--/.test(await second.$eval("#said", (s) => s.textContent!)),
    "no word of the command line",
  );
  for (const { complaints } of both) assert.deepEqual(complaints, []);
});

test(
  "a class list says what it knows, and outlives a look at another page",
  { skip: k_skip },
  async () => {
    const officer = await desk("Anna Officer");
    const { page, complaints } = officer;
    const place = "Paste the list, with its line of column names";
    const read = async (): Promise<void> => {
      await page.$$eval("main h2", (all) => all.forEach((h) => h.setAttribute("data-old", "")));
      await press(page, "Read the list");
      await page.waitForSelector("main h2:not([data-old])");
    };
    await go(page, "Class list");
    const { uses } = await page.evaluate(async () => {
      const token = ((await (await fetch("/api/me")).json()) as { token: string }).token;
      return (await (
        await fetch("/api/roster/preview", {
          method: "POST",
          headers: { "Content-Type": "application/json", "X-Cavum-Token": token },
          body: '{"base64":"aWQK"}',
        })
      ).json()) as { uses: string[] };
    });
    await said(page, `Columns that are known: ${uses.join(", ")}.`);
    await type(page, place, "4711;Weber;Ada\n4712;Stein;Eva\n");
    await read();
    assert.match(
      await page.$eval("main [role=alert]", (e) => e.textContent!),
      /first line: 4711; Weber; Ada\. Is it a candidate/,
    );
    await type(
      page,
      place,
      "Matrikel;Nachname;Vorname;Links\n4711;Weber;Ada;x\n4712;Stein;Eva;vielleicht\n",
    );
    await read();
    for (const [heading, use] of [
      ["Matrikel", "id"],
      ["Nachname", "name"],
      ["Vorname", "name"],
      ["Links", "left_handed"],
    ]) {
      await page.$$eval("main h2", (all) => all.forEach((h) => h.setAttribute("data-old", "")));
      await page.select(await control(page, `Use of column ${heading}`), use);
      await page.waitForSelector("main h2:not([data-old])");
    }
    await said(page, "'vielleicht'");
    await look(officer, "class-list-names");
    // the corrected list has a column more, and asks about that alone
    await type(
      page,
      place,
      "Platz;Matrikel;Nachname;Vorname;Links\n3;4711;Weber;Ada;x\n4;4712;Stein;Eva;nein\n",
    );
    await read();
    await said(page, "Columns that wait for your answer: 1");
    await go(page, "Tickets");
    await go(page, "Class list");
    assert.match(
      await page.$eval(await control(page, place), (e) => (e as HTMLTextAreaElement).value),
      /^Platz;Matrikel/,
    );
    await read();
    await said(page, "Columns that wait for your answer: 1");
    await page.select(await control(page, "Use of column Platz"), "pass over");
    await said(page, "Weber, Ada");
    await said(page, "takes 2:00 min");

    // a time that the clocks leave out
    await page.emulateTimezone("Europe/Berlin");
    const issues = async (from: string): Promise<void> => {
      for (const [label, time] of [
        ["May begin from", from],
        ["May begin until", "2027-03-28T09:00"],
      ])
        await page.$eval(
          await control(page, label),
          (e, v) => ((e as HTMLInputElement).value = v),
          time,
        );
      await type(page, "Reason", "class");
      await press(page, "Issue the tickets");
    };
    await issues("2027-03-28T02:30");
    await said(page, "There is no 2027-03-28 02:30 in Europe/Berlin");
    await go(page, "Tickets");
    await said(page, "There is no ticket yet.");
    await page.click("::-p-xpath(//a[normalize-space()='Candidate cards (PDF)'])");
    await refused(page);
    await go(page, "Class list");
    await read();
    await said(page, "Weber, Ada");
    await issues("2027-03-28T03:30");
    await said(page, "Issued: 2. Refused: 0.");
    assert.deepEqual(
      await page.evaluate(async () =>
        (
          (await (await fetch("/api/tickets")).json()) as { tickets: { not_before: string }[] }
        ).tickets.map((t) => t.not_before),
      ),
      ["2027-03-28T01:30:00Z", "2027-03-28T01:30:00Z"],
      "by summer time",
    );
    await go(page, "Tickets");
    await said(page, "takes 2:00 min");
    assert.equal(
      readFileSync(await download(page, "Candidate cards (PDF)", "cards.pdf"))
        .subarray(0, 5)
        .toString(),
      "%PDF-",
    );
    await press(page, "Sign out");
    await page.waitForSelector("input[type=password]");
    await type(page, "Name", "Anna Officer");
    await type(page, "Password", "correct horse trial");
    await press(page, "Sign in");
    await page.waitForSelector("nav");
    await go(page, "Class list");
    assert.equal(
      await page.$eval(await control(page, place), (e) => (e as HTMLTextAreaElement).value),
      "",
      "for whoever comes next nothing is kept",
    );
    assert.deepEqual(complaints, []);
  },
);

test("who is out hears why", { skip: k_skip }, async () => {
  const { page, complaints } = await desk("Anna Officer");
  await said(page, "Exam day");
  await (await page.createCDPSession()).send("Network.clearBrowserCookies");
  await page.click("nav a[href='#tickets']");
  await said(page, "Your session has ended. Sign in again.");
  await type(page, "Name", "Anna Officer");
  await type(page, "Password", "something else");
  await page.keyboard.press("Enter");
  await until(
    async () => !(await page.$eval("body", (b) => b.innerText)).includes("Your session has ended"),
    "another word",
  );
  await refused(page);
  assert.deepEqual(complaints, []);
});
