// An exam day with its accidents, by clicks and keys: rooms and seats, who is not here, a fire alarm, announcements, a station that dies, one without
// network, a cancelled ticket, a late candidate, a ticket at two stations, incidents. Stations are the program's own.
import assert from "node:assert/strict";
import { readdirSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
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
  refused,
  run,
  said,
  station,
  task,
  type,
} from "./browser.ts";
import { gone, issue, place, text, tickets_of } from "./hall.ts";

const seats = ["seat1", "seat2", "seat3"];
before(async () => {
  if (!k_skip) await open_office(...seats);
});
after(close_office);

test("an exam day with its accidents, by clicks", { skip: k_skip }, async () => {
  const officer = await desk("Anna Officer");
  const { page } = officer;
  for (const [i, home] of seats.entries()) await invite(page, home, `Seat ${i + 1}`);
  for (const [seat, room] of [
    ["Seat 1", "Room 1"],
    ["Seat 2", "Room 1"],
    ["Seat 3", "Room 2"],
  ])
    await place(page, seat, room);

  await issue(
    page,
    "id,name,extra_time_percent\n4711,Anna A.,25\n4712,Bert B.,\n4713,Cleo C.,\n4714,Dora D.,\n4715,Emil E.,\n",
  );
  await go(page, "Tickets");
  await said(page, "Without a station: 5 of 5");
  await page.select(await control(page, "Room"), "Room 1");
  await press(page, "Seat them");
  await said(page, "Seated: 2. Without a station still: 3.");
  await look(officer, "tickets-seats");
  const by_id = new Map([...(await tickets_of(page))].map(([id, t]) => [id, t.code]));
  const chosen = await page.$eval(
    `[aria-label="Station of ${by_id.get("4713")}"]`,
    (s) => [...(s as HTMLSelectElement).options].find((o) => o.text === "Seat 3")!.value,
  );
  await page.select(`[aria-label="Station of ${by_id.get("4713")}"]`, chosen);
  await said(page, "has another station.");
  const pdf = await page.evaluate(async () => {
    const answer = await fetch("/api/cards.pdf");
    return [answer.headers.get("content-type"), (await answer.text()).slice(0, 5)];
  });
  assert.deepEqual(pdf, ["application/pdf", "%PDF-"]);
  await page.$eval(`[aria-label="Cancel the ticket of ${by_id.get("4715")}"]`, (b) =>
    b.scrollIntoView({ block: "center" }),
  ); // not below what was said last
  await page.click(`[aria-label="Cancel the ticket of ${by_id.get("4715")}"]`);
  await type(page, "Reason", "ill");
  await page.keyboard.press("Enter");
  await said(page, "does not count any more");

  // three come, one is late
  const invigilator = await desk("Ian Invigilator");
  const hall = invigilator.page;
  await said(hall, "Not here: 4");
  for (const name of ["Anna A.", "Bert B.", "Cleo C.", "Dora D."]) await said(hall, name);
  assert.ok(!(await text(hall)).includes("Emil E."), "his ticket was cancelled");
  const [anna, bert, cleo, dora] = ["4711", "4712", "4713", "4714"].map((id) => by_id.get(id)!);
  const sits = (home: string, who: string, ...more: string[]): string =>
    station(
      home,
      "report",
      "--state",
      "exam",
      "--candidate",
      who,
      "--step",
      "1/3 outline",
      "--remaining-s",
      "600",
      ...more,
    );
  sits("seat1", anna);
  sits("seat2", bert);
  sits("seat3", cleo);
  await said(hall, "Not here: 1");
  await said(hall, "Dora D.");

  // a fire alarm
  await hall.click("details.pause summary");
  await press(hall, "Pause the exams");
  await said(hall, "Paused: Fire alarm (all stations)");
  await said(page, "does not count any more"); // the officer still looks at tickets
  for (const [home, who] of [
    ["seat1", anna],
    ["seat3", cleo],
  ])
    assert.match(sits(home, who), /Fire alarm/);
  await look(invigilator, "day-paused");
  await press(hall, "Let them go on");
  await type(hall, "Reason", "a false alarm");
  await hall.keyboard.press("Enter");
  await gone(hall, "Paused: Fire alarm");
  assert.equal(sits("seat1", anna), "");

  // to one room only
  await hall.select(
    await control(hall, "What candidates read").then(() =>
      hall.$$eval("section select", (all) => `#${all[all.length - 1].id}`),
    ),
    "room Room 2",
  );
  await type(hall, "What candidates read", "The lamp is being mended.");
  await press(hall, "Announce it");
  await said(hall, "all in Room 2: The lamp is being mended.");
  const told = sits("seat3", cleo);
  assert.match(told, /\d+: The lamp is being mended\./);
  assert.equal(sits("seat1", anna), "");
  await said(hall, "Announcements not read yet: 1");
  sits("seat3", cleo, "--last-announcement", /(\d+): The lamp/.exec(told)![1]);
  await gone(hall, "Announcements not read yet");

  // a copied ticket: noticed at once
  sits("seat3", bert);
  await said(hall, `${bert} is at Seat 2, too: one ticket at two stations`);
  await look(invigilator, "day-twins");
  sits("seat3", cleo);
  await gone(hall, "one ticket at two stations");

  await go(hall, "Incidents");
  await said(hall, "Nothing was noted.");
  const bad = await hall.$eval(
    await control(hall, "Station"),
    (s) => [...(s as HTMLSelectElement).options].find((o) => o.text === "Seat 2")!.value,
  );
  await hall.select(await control(hall, "Station"), bad);
  await hall.select(await control(hall, "Candidate"), bert);
  await type(hall, "What happened", "its screen went dark");
  await press(hall, "Note it");
  await said(hall, "its screen went dark");
  await said(hall, "4712 Bert B.");
  await look(invigilator, "incidents");
  await go(hall, "Exam day");

  // the station died: its ticket is taken back, and another one given
  await go(page, "Tickets");
  await page.click(`[aria-label="Cancel the ticket of ${bert}"]`);
  await type(page, "Reason", "the station died");
  await page.keyboard.press("Enter");
  await refused(page, bert); // since the list was made
  await page.click(`[aria-label="Cancel the ticket of ${bert}"]`);
  await said(page, "This candidate has begun.");
  await type(page, "Reason", "the station died");
  await page.keyboard.press("Enter");
  await said(page, "does not count any more");
  await issue(page, "id,name\n4712,Bert B.\n");
  await go(page, "Tickets");
  await said(page, "4712");
  await said(hall, "Silent for");

  // all sit; one of them without network, which is noticed by nobody until it hands in
  for (const home of ["seat1", "seat3"])
    station(home, "tickets", "--out", join(folder, home, "tickets"));
  const files = readdirSync(join(folder, "seat1/tickets")).filter((f) => f.endsWith(".ticket"));
  assert.equal(files.length, 4);
  const sit = (home: string, who: string, name: string): void =>
    void run(home, [
      "exam",
      task,
      "--ticket",
      join(folder, home, "tickets", `${who}.ticket`),
      "--operator",
      "expert",
      "--seed",
      name.length + "1",
      "--out",
      join(folder, `${name}.cavum`),
    ]);
  sit("seat1", anna, "anna");
  station("seat1", "file", join(folder, "anna.cavum"));
  sit("seat3", dora, "dora"); // late, and at a station that says nothing
  await said(hall, "Dora D.");
  sit("seat3", bert, "bert");
  station("seat3", "file", join(folder, "dora.cavum"), join(folder, "bert.cavum"));
  await said(hall, "3 filed");
  await gone(hall, "Dora D.");
  await look(invigilator, "day-evening");
  for (const one of [officer, invigilator]) assert.deepEqual(one.complaints, []);
  run("school", ["ledger", "verify", join(folder, "ledger")]);
});
