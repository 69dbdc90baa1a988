// An exam day of 60 candidates on 8 stations in three rooms, from class list to gradebook, by clicks and keys, with all that can happen on one; then the gradebook
// is held row by row against what the test knows by itself. Takes minutes: CAVUM_DEEP=1. A picture of each page and state, at 1280 and at 390 pixels, is kept.
import assert from "node:assert/strict";
import { spawn, spawnSync, type ChildProcess } from "node:child_process";
import { existsSync, readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import type { Page } from "puppeteer-core";
import { k_skip, until } from "../report_test/chromium.ts";
import {
  add_account,
  close_office,
  control,
  desk,
  examine_with,
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
  type Desk,
} from "./browser.ts";
import {
  cancel,
  csv,
  download,
  file,
  fresh_code,
  gone,
  home_of,
  in_pairs,
  open_window,
  pass_over,
  paste,
  people,
  place,
  release,
  reports,
  say_times,
  screen,
  seat_them,
  seats,
  sit,
  tab_to,
  tickets_page,
  write_keys,
  type Person,
} from "./hall.ts";

const skip =
  k_skip ||
  (process.env.CAVUM_DEEP
    ? false
    : "an exam day of 60 candidates takes some minutes; CAVUM_DEEP=1 runs it");
const cavum = process.env.CAVUM_BINARY!;
const [absent, missed, dead, offline, ill, late] = [6, 7, 11, 19, 27, 35].map((i) => people[i]);
let officer: Desk, invigilator: Desk, eva: Desk, emil: Desk;
const recordings = new Map<string, string>(); // of who sat, by number
const codes = new Map<string, string>(); // the last one, by number
const photo = (d: Desk, name: string): Promise<void> => look(d, `sixty-${name}`);
const began = Date.now();
const tell = (words: string): void =>
  console.log(`${Math.round((Date.now() - began) / 1000)} s: ${words}`);

before(async () => {
  if (skip) return;
  examine_with(95, '\n[careless]\nperforates = true\nfails_by = "perforation"\n');
  await open_office(...seats.map((s) => s.home));
  add_account("Emil Examiner", "examiner");
});
const children: ChildProcess[] = [];
after(async () => {
  for (const child of children) child.kill("SIGTERM");
  await close_office();
});

/** Sits and files; the station says so to the board. */
async function whole(home: string, p: Person): Promise<void> {
  const code = codes.get(p.id)!;
  reports(home, code);
  recordings.set(p.id, await sit(home, p, code));
  await file(home, recordings.get(p.id)!);
  reports(home, "", "free");
}
test("before: class list, stations, sittings, seats, papers", { skip }, async () => {
  officer = await desk("Anna Officer");
  const { page } = officer;
  for (const seat of seats) await invite(page, seat.home, seat.name);
  for (const seat of seats) await place(page, seat.name, seat.room);
  await photo(officer, "board-enrolled");
  await paste(page, people);
  await said(page, "Columns that wait for your answer: 1");
  await photo(officer, "list-column-asked");
  assert.equal(
    (await page.$$("::-p-xpath(//button[.='Issue the tickets'])")).length,
    0,
    "nothing is issued while a column waits",
  );
  await pass_over(page);
  await say_times(page, -60, 5);
  await type(page, "Candidates in a sitting", "8");
  await type(page, "Minutes from one sitting to the next", "2");
  await page.click("#sittings-overlap");
  await type(page, "Reason", "class of this year");
  await photo(officer, "list-preview");
  await press(page, "Issue the tickets");
  await said(page, "Issued: 60. Refused: 0.");
  await photo(officer, "list-issued");
  const rows = await tickets_page(page);
  assert.deepEqual([...rows.keys()].sort(), people.map((p) => p.id).sort());
  assert.equal(new Set([...rows.values()].map((r) => r.may_begin)).size, 8, "eight sittings");
  for (const [id, row] of rows) codes.set(id, row.code);
  await photo(officer, "tickets");
  for (const [words, name] of [
    ["Candidate cards (PDF)", "cards.pdf"],
    ["Sign-in sheet (PDF)", "sign-in-sheet.pdf"],
  ]) {
    const told = spawnSync("pdftotext", ["-layout", await download(page, words, name), "-"], {
      encoding: "utf8",
    }).stdout;
    for (const p of people) assert.ok(told.includes(codes.get(p.id)!), `${p.id} on ${name}`);
  }
  tell("before");
});

test(
  "a fire alarm in the first sitting: a real window stands still, and nobody loses time",
  { skip },
  async () => {
    const { page } = officer;
    const sitting = people.slice(0, 8);
    await seat_them(page, sitting, "Room A");
    await said(page, "Seated: 3. Without a station still: 5.");
    await photo(officer, "tickets-room-seated");
    const at = await seat_them(page, sitting);
    assert.equal(new Set(at.values()).size, 8, "a station for each");
    invigilator = await desk("Ian Invigilator");
    const hall = invigilator.page;
    await said(hall, `Not here: 60`);
    await photo(invigilator, "board-nobody-here");
    const windows = [people[3]]; // with extra time; the others are simulated without a window
    const here = sitting.filter((p) => p !== absent && p !== missed);
    for (const p of here.filter((h) => !windows.includes(h)))
      reports(home_of(at.get(p.id)!), codes.get(p.id)!);
    await hall.click("details.pause summary");
    const { display, child: x } = await screen();
    children.push(x);
    const open = windows.map((p) =>
      open_window(display, home_of(at.get(p.id)!), p, codes.get(p.id)!),
    );
    children.push(...open);
    const board = async (): Promise<{ name: string; said?: { held: boolean; state: string } }[]> =>
      (await hall.evaluate(async () => (await fetch("/api/board")).json())).stations;
    const of_windows = async (
      is: (s: { held: boolean; state: string }) => boolean,
    ): Promise<boolean> =>
      (await board())
        .filter((s) => windows.some((p) => at.get(p.id) === s.name))
        .every((s) => s.report !== undefined && is(s.report));
    await until(async () => of_windows((s) => s.state === "exam"), "the window is in its exam");
    tell("the window is in its exam");
    await press(hall, "Pause the exams");
    await said(hall, "Paused: Fire alarm (all stations)");
    await until(async () => of_windows((s) => s.held), "it stands still");
    for (const p of here.filter((h) => !windows.includes(h)))
      assert.match(reports(home_of(at.get(p.id)!), codes.get(p.id)!), /Fire alarm/);
    await photo(invigilator, "board-paused");
    await press(hall, "Let them go on");
    await type(hall, "Reason", "a false alarm");
    await hall.keyboard.press("Enter");
    await gone(hall, "Paused: Fire alarm");
    await hall.select(
      await control(hall, "What candidates read").then(() =>
        hall.$$eval("section select", (all) => `#${all[all.length - 1].id}`),
      ),
      "room Room A",
    );
    await type(hall, "What candidates read", "Go on where you were.");
    await press(hall, "Announce it");
    await said(hall, "all in Room A: Go on where you were.");
    const handed = new Map(windows.map((p) => [p, join(folder, home_of(at.get(p.id)!), "exams")]));
    await said(hall, "1 filed");
    for (const child of open) child.kill("SIGTERM");
    x.kill("SIGTERM");
    for (const [p, exams] of handed) {
      const recording = join(
        exams,
        readdirSync(exams).find((f) => f.endsWith(".cavum"))!,
      );
      const sealed = JSON.parse(run("school", ["grade", recording, "--json"]));
      assert.equal(
        sealed.pauses.list.filter((l: { by_office: boolean }) => l.by_office).length,
        1,
        "the office's pause stands in the recording",
      );
      assert.ok(sealed.pauses.ticks >= 1000, `${sealed.pauses.ticks} ticks`);
      assert.equal(sealed.verdict, "pass", "whole");
      assert.ok(sealed.time_s < 20, `the pause is no time of the candidate's: ${sealed.time_s} s`);
      recordings.set(p.id, recording);
      reports(home_of(at.get(p.id)!), "", "free");
    }
    await in_pairs(
      here.filter((h) => !windows.includes(h)),
      (p) => whole(home_of(at.get(p.id)!), p),
    );
    await said(hall, "6 filed");
    for (const p of [absent, missed]) await said(hall, p.name);
    tell("fire alarm");
  },
);

test("a station dies: its candidate has another ticket at another station", { skip }, async () => {
  const { page } = officer,
    hall = invigilator.page;
  // by the keyboard alone: two who did not come give their stations free
  await tickets_page(page);
  for (const p of [absent, missed]) {
    const tabs = await tab_to(page, `Station of ${codes.get(p.id)!}`);
    tell(`keyboard: ${tabs} Tabs to a seat`);
    await page.keyboard.press("Home");
    await said(page, `${codes.get(p.id)!} has another station.`);
  }
  const sitting = people.slice(8, 16);
  const at = await seat_them(page, sitting);
  const home = home_of(at.get(dead.id)!),
    code = codes.get(dead.id)!;
  station(home, "tickets", "--out", join(folder, home, "tickets"));
  const lost = join(folder, home, "lost.cavum");
  const dying = spawn(
    cavum,
    [
      "exam",
      task,
      "--ticket",
      join(folder, home, "tickets", `${code}.ticket`),
      "--device",
      "simulated",
      "--operator",
      dead.hand,
      "--out",
      lost,
      "--quiet",
    ],
    { env: { ...process.env, CAVUM_HOME: join(folder, home) }, stdio: "ignore" },
  );
  reports(home, code);
  await new Promise((done) => setTimeout(done, 4000));
  dying.kill("SIGKILL");
  assert.ok(
    existsSync(lost),
    "what it recorded until then lies at the station, and is filed by nobody",
  );
  await in_pairs(
    sitting.filter((p) => p !== dead),
    (p) => whole(home_of(at.get(p.id)!), p),
  );
  await said(hall, "Silent for");
  await photo(invigilator, "board-station-died");
  await tickets_page(page);
  await cancel(page, code, "the station died");
  await paste(page, [dead]);
  await said(page, "Who gets a ticket"); // the column stays passed over
  await say_times(page, -60, 60);
  await type(page, "Reason", "the station died");
  await press(page, "Issue the tickets");
  await said(page, "Issued: 1. Refused: 0.");
  codes.set(dead.id, (await tickets_page(page)).get(dead.id)!.code);
  const other = seats.find((s) => s.home !== home)!;
  await page.select(
    `[aria-label="Station of ${codes.get(dead.id)!}"]`,
    await page.$eval(
      `[aria-label="Station of ${codes.get(dead.id)!}"]`,
      (s, n) => [...(s as HTMLSelectElement).options].find((o) => o.text === n)!.value,
      other.name,
    ),
  );
  await said(page, "has another station.");
  await whole(other.home, dead);
  tell("station died");
});

test(
  "no network, a ticket cancelled by keys, a late candidate, a ticket at two stations, an incident",
  { skip },
  async () => {
    const { page } = officer,
      hall = invigilator.page;
    let at = await seat_them(page, people.slice(16, 24));
    const alone = home_of(at.get(offline.id)!);
    recordings.set(offline.id, await sit(alone, offline, codes.get(offline.id)!)); // its tickets came before; from here on nobody hears it
    await in_pairs(
      people.slice(16, 24).filter((p) => p !== offline),
      (p) => whole(home_of(at.get(p.id)!), p),
    );
    await said(hall, offline.name);

    await tickets_page(page);
    tell(
      `keyboard: ${await tab_to(page, `Cancel the ticket of ${codes.get(ill.id)!}`)} Tabs to a ticket that is cancelled`,
    );
    await page.keyboard.press("Enter");
    await page.keyboard.type("ill");
    await photo(officer, "tickets-cancel");
    await page.keyboard.press("Enter");
    await said(page, `The ticket of ${codes.get(ill.id)!} does not count any more.`);
    at = await seat_them(page, people.slice(24, 32));
    await in_pairs(
      people.slice(24, 32).filter((p) => p !== ill),
      (p) => whole(home_of(at.get(p.id)!), p),
    );

    await said(hall, offline.name);
    await file(alone, recordings.get(offline.id)!); // the network is back
    await gone(hall, offline.name);

    at = await seat_them(page, people.slice(32, 40));
    const others = people.slice(32, 40).filter((p) => p !== late);
    for (const p of others) reports(home_of(at.get(p.id)!), codes.get(p.id)!);
    await said(hall, late.name);
    await photo(invigilator, "board-one-is-late");
    await in_pairs(others, (p) => whole(home_of(at.get(p.id)!), p));
    await whole(home_of(at.get(late.id)!), late);
    await gone(hall, late.name);
    at = await seat_them(page, people.slice(40, 48));
    const [one, two] = people
      .slice(40, 42)
      .map((p) => ({ home: home_of(at.get(p.id)!), code: codes.get(p.id)!, p }));
    for (const s of people.slice(40, 48)) reports(home_of(at.get(s.id)!), codes.get(s.id)!);
    reports(two.home, one.code);
    await said(hall, `${one.code} is at ${at.get(two.p.id)!}, too: one ticket at two stations`);
    await photo(invigilator, "board-two-stations");
    reports(two.home, two.code);
    await gone(hall, "one ticket at two stations");
    await go(hall, "Incidents");
    await hall.select(
      await control(hall, "Station"),
      await hall.$eval(
        await control(hall, "Station"),
        (s, n) => [...(s as HTMLSelectElement).options].find((o) => o.text === n)!.value,
        at.get(two.p.id)!,
      ),
    );
    await hall.select(await control(hall, "Candidate"), one.code);
    await type(hall, "What happened", "sat down at the wrong station");
    await press(hall, "Note it");
    await said(hall, `${one.p.id} ${one.p.name}`);
    await photo(invigilator, "incidents");
    await go(hall, "Tickets");
    await photo(invigilator, "tickets-invigilator");
    await go(hall, "Exam day");
    await in_pairs(people.slice(40, 48), (p) => whole(home_of(at.get(p.id)!), p));

    for (const sitting of [people.slice(48, 56), people.slice(56)]) {
      at = await seat_them(page, sitting);
      await in_pairs(sitting, (p) => whole(home_of(at.get(p.id)!), p));
    }
    await said(hall, "57 filed");
    tell("the day is over");
  },
);

/** Sealed verdicts and points of all who sat, by number; read from the recordings alone. */
function sealed(): Map<string, { verdict: string; points: number }> {
  const told = JSON.parse(run("school", ["grade", ...recordings.values(), "--json"])) as {
    failed: number;
    sessions: { file: string; old: { verdict: string; points: number } }[];
  };
  assert.equal(told.failed, 0);
  const by_file = new Map(told.sessions.map((s) => [s.file, s.old]));
  return new Map([...recordings].map(([id, recording]) => [id, by_file.get(recording)!]));
}
const card_of = (code: string): string => `::-p-xpath(//section[@aria-label="Result of ${code}"])`;
async function results_page(
  page: Page,
): Promise<Map<string, { session: string; verdict: string; state: string }>> {
  await go(page, "Exam day");
  await go(page, "Results");
  const rows = await page.$$eval("tbody tr", (all) =>
    all.map((r) => [...r.children].map((c) => c.textContent!)),
  );
  return new Map(rows.map((r) => [r[1], { session: r[0], verdict: r[5], state: r[7] }]));
}
/** The gradebook as a person fetches it, by candidates' numbers. */
async function gradebook(page: Page): Promise<Map<string, { [heading: string]: string }>> {
  await go(page, "Results");
  const rows = csv(
    readFileSync(
      await download(
        page,
        "Gradebook (CSV for Moodle), with names: what is released",
        "gradebook.csv",
      ),
      "utf8",
    ),
  );
  const by_code = new Map([...codes].map(([id, code]) => [code, id]));
  return new Map(rows.map((r) => [by_code.get(r["ID number"].replace("SIMULATED ", ""))!, r]));
}

test(
  "after: decisions by two, release, an appeal, a result taken back and corrected, a makeup, and the gradebook",
  { skip },
  async () => {
    const { page } = officer,
      hall = invigilator.page;
    const marks = sealed();
    const reviews = [...marks].filter(([, m]) => m.verdict === "review").map(([id]) => id);
    for (const verdict of ["pass", "fail"])
      assert.ok([...marks.values()].filter((m) => m.verdict === verdict).length > 5, verdict);
    assert.equal(reviews.length, 3);
    const final = new Map([...marks].map(([id, m]) => [id, m.verdict]));
    let rows = await results_page(page);
    assert.deepEqual(
      [...rows.keys()].sort(),
      [...recordings.keys()].sort(),
      "who sat has a result, and nobody else",
    );
    for (const [id, row] of rows) assert.equal(row.verdict, marks.get(id)!.verdict, id);
    await photo(officer, "results");

    // two of three by two examiners; the third waits
    eva = await desk("Eva Examiner");
    emil = await desk("Emil Examiner");
    await go(eva.page, "Decisions");
    await photo(eva, "decisions");
    for (const [examiner, id, verdict] of [
      [eva, reviews[0], "pass"],
      [emil, reviews[1], "fail"],
    ] as [Desk, string, string][]) {
      await go(examiner.page, "Decisions");
      const card = (await examiner.page.waitForSelector(card_of(codes.get(id)!)))!;
      await (await card.$("select"))!.select(verdict);
      await (await card.$("input"))!.type("the walls were looked at, step by step");
      await (await card.$("button"))!.click();
      await said(examiner.page, "Decided: entry");
      final.set(id, verdict);
    }
    const open = reviews[2];
    rows = await results_page(page); // what is released is what the page shows
    await release(page, "board of November");
    await said(page, "Released: 56.");
    await photo(officer, "results-released");
    let book = await gradebook(page);
    assert.equal(book.size, 56);
    assert.ok(!book.has(open), "what waits for a decision is in no gradebook");

    // an appeal whose result stands, and a result that is taken back and corrected
    const [stands, wrong] = [people[8].id, people[4].id];
    assert.equal(marks.get(wrong)!.verdict, "fail");
    const appeal = async (id: string, words: string): Promise<void> => {
      await go(page, "Appeals");
      await page.select(await control(page, "Result"), rows.get(id)!.session);
      await type(page, "What the candidate objects to", words);
      await press(page, "Enter the appeal");
      await said(page, "The appeal is open");
    };
    await appeal(stands, "the hollow was opened before");
    await photo(officer, "appeals");
    await go(page, "Results");
    await page.click("main details summary");
    await page.select(await control(page, "Released result"), rows.get(wrong)!.session);
    const back = (await page.$("::-p-xpath(//form[.//button[.='Take it back']])"))!;
    const fields = await back.$$("input");
    await fields[0].type("the wrong block was mounted");
    await fields[1].type(await fresh_code());
    await photo(officer, "results-taking-back");
    await fields[1].press("Enter");
    await said(page, "Taken back: entry");
    assert.ok(!(await gradebook(page)).has(wrong), "what was taken back is in no gradebook");
    await appeal(wrong, "the wrong block was mounted");
    await go(eva.page, "Appeals");
    const answer = async (id: string, button: string, words: string): Promise<void> => {
      const card = (await eva.page.waitForSelector(
        `::-p-xpath(//section[@aria-label="Appeal of ${codes.get(id)!}"][.//button[.="${button}"]])`,
      ))!;
      const forms = await card.$$("form");
      await (await forms[forms.length - 1].$("input"))!.type(words);
      await photo(eva, `appeal-${id === wrong ? "changed" : "stands"}`);
      await (await forms[forms.length - 1].$("button"))!.click();
      await said(eva.page, "Answered: entry");
    };
    await answer(stands, "Answer: the result stands", "the replay shows when it was opened");
    const card = (await eva.page.waitForSelector(
      `::-p-xpath(//section[@aria-label="Appeal of ${codes.get(wrong)!}"])`,
    ))!;
    await (await card.$("summary"))!.click();
    await (await card.$("select"))!.select("pass");
    await (await card.$("details input"))!.type("marked by hand on the right block");
    await (await card.$("details button"))!.click();
    await said(eva.page, "Another result was entered since the appeal.");
    await answer(wrong, "Answer: the result was changed", "marked again");
    final.set(wrong, "pass");

    // by the keyboard alone: the last decision, and the release of what is ready then
    await go(emil.page, "Decisions");
    tell(`keyboard: ${await tab_to(emil.page, "Verdict")} Tabs to the verdict`);
    await emil.page.keyboard.press("ArrowDown");
    await tab_to(emil.page, "Reason");
    await emil.page.keyboard.type("complete, as asked");
    await emil.page.keyboard.press("Enter");
    await said(emil.page, "Nothing waits for a decision.");
    final.set(open, "pass");
    await go(page, "Tickets");
    await page.focus("nav a[href='#results']");
    await page.keyboard.press("Enter");
    await page.waitForSelector("nav a[href='#results'][aria-current=page]");
    tell(`keyboard: ${await tab_to(page, "Reason")} Tabs to the release`);
    await write_keys(page, "after the appeal");
    await tab_to(page, "Code of your app");
    await write_keys(page, await fresh_code());
    await page.keyboard.press("Enter");
    await said(page, "Released: 2.");

    // who did not come: a no-show on the board when the time is over; one has a makeup sitting
    const over = Date.now() + 600_000;
    const of_no_shows = (): Promise<string[]> =>
      hall.$$eval("main section tbody tr", (all) =>
        all
          .filter((r) => r.textContent!.includes("no-show"))
          .map((r) => r.children[0].textContent!),
      );
    while ((await of_no_shows()).length < 2 && Date.now() < over) {
      await press(hall, "Look again");
      await new Promise((done) => setTimeout(done, 3000));
    }
    assert.deepEqual((await of_no_shows()).sort(), [absent.id, missed.id]);
    await photo(invigilator, "board-evening");
    await tickets_page(page);
    await photo(officer, "tickets-evening");
    await page.focus(`[aria-label="Makeup sitting for ${codes.get(missed.id)!}"]`);
    await page.keyboard.press("Enter");
    await page.select(await control(page, "The first sitting"), "missed");
    await say_times(page, -60, 60);
    await page.select(await control(page, "Accommodations"), "none");
    await type(page, "Reason", "ill, with a certificate");
    await photo(officer, "makeup");
    await page.keyboard.press("Enter");
    await said(page, "has a makeup sitting, without accommodations.");
    await whole("seat1", missed);
    await said(hall, "58 filed");
    await release(page, "makeup of November");
    await said(page, "Released: 1.");
    await photo(officer, "results-all");
    final.set(missed.id, sealed().get(missed.id)!.verdict);

    // the trail of the day: all of its kinds, page by page to the beginning, and all of one candidate
    await go(page, "Trail");
    const trail = (): Promise<string[][]> =>
      page.$$eval("main table tbody tr", (all) =>
        all.map((tr) => [...tr.cells].map((td) => td.innerText.trim())),
      );
    await page.waitForSelector("main table");
    await photo(officer, "trail");
    const told: string[][] = [];
    for (;;) {
      told.push(...(await trail()));
      if (told[told.length - 1]![0] === "0") break;
      const [last] = await trail();
      await press(page, "Earlier entries");
      await page.waitForFunction(
        (first) => document.querySelector("main table tbody td")?.textContent !== first,
        {},
        last![0],
      );
    }
    assert.deepEqual(
      told.map((r) => Number(r[0])),
      told.map((_, i) => told.length - 1 - i),
      "every entry once, the newest first",
    );
    for (const what of [
      "Ticket cancelled",
      "Exams paused",
      "Pause ended",
      "Announcement",
      "Incident noted",
      "Decided",
      "Appeal entered",
      "Appeal answered",
      "Taken back",
      "Makeup sitting",
    ])
      assert.ok(
        told.some((r) => r[2]!.startsWith(what)),
        what,
      );
    await type(page, "Only of this candidate", wrong);
    await press(page, "Show");
    await page.waitForFunction(() => document.querySelectorAll("main table tbody tr").length < 30);
    const his = (await trail()).map((r) => r[2]);
    tell(`trail of ${wrong}: ${his.join(", ")}`);
    for (const what of ["Ticket issued", "Exam filed", "Appeal entered", "Taken back"])
      assert.ok(his.includes(what), what);
    await photo(officer, "trail-of-one");

    // every one of the 60 once: in the gradebook, cancelled, or absent
    book = await gradebook(page);
    const points = sealed();
    for (const p of people) {
      const row = book.get(p.id);
      if (p === absent || p === ill) {
        assert.equal(row, undefined, `${p.id} sat nothing`);
        continue;
      }
      assert.equal(
        row!["border_cavity verdict"].replace(/ \(critical: [a-z, ]+\)$/, ""),
        `SIMULATED (operator ${p.hand}, no student sat this): ${final.get(p.id)!}`,
        p.id,
      );
      assert.ok(
        Math.abs(Number(row!["border_cavity points"]) - points.get(p.id)!.points) < 1e-9,
        p.id,
      );
      assert.notEqual(final.get(p.id), "review");
    }
    assert.equal(book.size, 58);
    const exported = join(folder, "exported.csv");
    run("school", [
      "ledger",
      "export",
      join(folder, "ledger"),
      "--format",
      "moodle",
      "--with-simulated",
      "--out",
      exported,
    ]);
    assert.equal(
      readFileSync(exported, "utf8"),
      readFileSync(join(folder, "downloads/gradebook.csv"), "utf8"),
    );
    const criteria = csv(
      readFileSync(
        await download(page, "Every criterion (CSV), pseudonyms alone", "criteria.csv"),
        "utf8",
      ),
    );
    tell(`criteria: ${Object.keys(criteria[0]).join()}`);
    assert.deepEqual(
      [...new Set(criteria.map((r) => r.candidate))].sort(),
      [...recordings.keys()].map((id) => codes.get(id)!).sort(),
    );
    for (const one of [officer, invigilator, eva, emil]) assert.deepEqual(one.complaints, []);
    run("school", ["ledger", "verify", join(folder, "ledger")]);
    tell("verified");
  },
);
