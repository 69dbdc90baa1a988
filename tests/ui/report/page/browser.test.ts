// The page in a browser, opened from a file: it draws, moves, is read, obeys the keyboard, asks nothing of the network, and says so when there is no
// WebGL. Pictures are left in the build directory (report_*.png).
import assert from "node:assert/strict";
import { readFileSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import {
  different,
  k_skip,
  launch,
  open,
  type Opened,
  pixels,
  scrubber_s,
  settled,
  until,
  violations,
} from "./chromium.ts";
import { document_of, fixture } from "./fixture.ts";

const axe_source = readFileSync(
  createRequire(resolve("package.json")).resolve("axe-core/axe.min.js"),
  "utf8",
);
const skip = k_skip;
const session_file = resolve("report_session.html");
const class_file = resolve("report_class.html");
let browser: Browser;

before(async () => {
  if (skip) return;
  const [script, style] = ["page.js", "page.css"].map((name) => readFileSync(name, "utf8"));
  writeFileSync(session_file, document_of(fixture(), script, style));
  writeFileSync(class_file, document_of(fixture("class"), script, style));
  browser = await launch();
});
after(async () => {
  await browser?.close();
});

function nothing_wrong({ requests, complaints }: Opened): void {
  assert.deepEqual(requests, []);
  assert.deepEqual(complaints, []);
}
async function press_now(page: Page, text: string): Promise<void> {
  await page.evaluate((name) => {
    const found = [...document.querySelectorAll("button")].find(
      (b) => b.textContent === name || b.getAttribute("aria-label") === name,
    );
    if (!found) throw new Error(`no button ${name}`);
    found.click();
  }, text);
}
async function press(page: Page, text: string): Promise<void> {
  await press_now(page, text);
  await settled(page);
}
async function check(page: Page, text: string): Promise<void> {
  await page.evaluate(
    (name) =>
      [...document.querySelectorAll("label")]
        .find((l) => l.textContent === name)!
        .querySelector("input")!
        .click(),
    text,
  );
  await settled(page);
}
async function at(page: Page, t_s: number): Promise<void> {
  await page.evaluate((t) => {
    const range = document.querySelector<HTMLInputElement>(".player input[type=range]")!;
    range.value = String(t);
    range.dispatchEvent(new Event("input"));
  }, t_s);
  await settled(page);
}
/** Where the 3D view is on the screen. */
async function view_box(
  page: Page,
): Promise<{ x: number; y: number; width: number; height: number }> {
  const canvas = (await page.$("#tooth-3d canvas"))!;
  await canvas.evaluate((e) => e.scrollIntoView({ block: "center" }));
  return (await canvas.boundingBox())!;
}
/** Pixels that are not the view's empty background. */
async function drawn(page: Page): Promise<number> {
  const { data } = await pixels(page);
  const empty = { data: new Uint8Array(data.length) };
  for (let i = 0; i < data.length; ++i) empty.data[i] = data[i % 4];
  return different({ data }, empty) / (data.length / 4);
}

test(
  "the tooth is drawn, from a file, without network and without complaint",
  { skip },
  async () => {
    const opened = await open(browser, session_file, "", 1200, 900);
    const { page } = opened;
    assert.equal(await page.evaluate(() => document.querySelector(".fallback")), null);
    const share = await drawn(page);
    assert.ok(share > 0.12 && share < 0.9, `the tooth covers ${share} of the view`);
    await page.screenshot({ path: "report_session.png", fullPage: true });
    nothing_wrong(opened);
    await page.close();
  },
);

test(
  "the scrubber moves the tooth, the instrument, and the charts' cursors",
  { skip },
  async () => {
    const opened = await open(browser, session_file);
    const { page } = opened;
    await check(page, "instrument"); // away, so that what changes is the tooth
    await press(page, "Occlusal");
    const end = await pixels(page);
    await at(page, 3);
    const early = await pixels(page);
    await at(page, 10);
    const middle = await pixels(page);
    assert.ok(
      different(early, end) > 2000 &&
        different(early, middle) > 1000 &&
        different(middle, end) > 1000,
      "each time has a tooth of its own",
    );
    await at(page, 20);
    assert.equal(different(await pixels(page), end), 0, "and the same time the same");
    await at(page, 10);
    await check(page, "instrument");
    assert.ok(different(await pixels(page), middle) > 1000, "the instrument is drawn");
    const said = await page.evaluate(() =>
      [...document.querySelectorAll("#charts .now")].map((e) => e.textContent),
    );
    assert.equal(said.length, 4);
    assert.ok(
      said.every((s) => s!.startsWith("0:10.0: ")),
      said.join(),
    );
    assert.equal(
      said[1],
      `0:10.0: ${(3.4 - (3.6 - 2.7 * 0.5)).toFixed(2)} mm`,
      "the depth halfway down",
    );
    await page.screenshot({ path: "report_session_10s.png" });
    nothing_wrong(opened);
    await page.close();
  },
);

test(
  "a button that jumps sets the time, marks the place, and brings the tooth on screen",
  { skip },
  async () => {
    const opened = await open(browser, session_file, "", 860, 420);
    const { page } = opened;
    await at(page, 12.5);
    const unmarked = await pixels(page);
    await at(page, 0);
    await page.evaluate(() => window.scrollTo(0, 0));
    await page.click(".jump");
    assert.equal(await scrubber_s(page), 12.5);
    await until(
      () =>
        page.evaluate(
          () => Math.abs(document.getElementById("tooth-3d")!.getBoundingClientRect().top) < 20,
        ),
      "the tooth is on screen",
    );
    const marked = await pixels(page);
    assert.ok(different(marked, unmarked) > 200, "the place is marked"); // 297, without smoothed edges
    const magenta = marked.data.filter(
      (_, i) =>
        i % 4 === 0 &&
        Math.abs(marked.data[i] - 0x8a) < 12 &&
        marked.data[i + 1] < 12 &&
        Math.abs(marked.data[i + 2] - 0x64) < 12,
    ).length;
    assert.ok(magenta > 100, `${magenta} pixels of the mark`);
    await page.screenshot({ path: "report_session_jump.png" });
    await at(page, 13);
    nothing_wrong(opened);
    await page.close();
  },
);

test(
  "the address names a moment, and events and points lost are stepped through",
  { skip },
  async () => {
    const opened = await open(browser, session_file, "#t=4.2");
    const { page } = opened;
    assert.equal(await scrubber_s(page), 4.2);
    await press(page, "Next event");
    assert.equal(await scrubber_s(page), 9);
    assert.match(
      await page.evaluate(() => document.querySelector(".player .event")!.textContent!),
      /Pause of 1\.0 s/,
    );
    await press(page, "Next event");
    assert.equal(await scrubber_s(page), 12.5);
    await press(page, "Previous event");
    await press(page, "Previous event");
    assert.equal(await scrubber_s(page), 2);
    await press(page, "Next point lost"); // past the moment that cost nothing, at 9 s
    assert.equal(await scrubber_s(page), 11);
    assert.equal(
      await page.evaluate(() => document.querySelector(".player .event")!.textContent),
      "0:11.0 Overcut, walls: 0.30 mm beyond the distal wall (−28.5 points)",
    );
    const losses = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>(".losses span")].map(
        (e) => `${e.style.left} ${e.style.width}`,
      ),
    );
    assert.deepEqual(losses, ["55% max(3px, 17.5%)", "85% "]);
    await press(page, "Next point lost");
    assert.equal(await scrubber_s(page), 17);
    const ticks = await page.evaluate(() =>
      [...document.querySelectorAll<HTMLElement>(".ticks:not(.losses) span")].map(
        (e) => `${e.style.left} ${e.title}`,
      ),
    );
    assert.deepEqual(ticks, [
      "10% 0:02.0 Outline begun",
      "45% 0:09.0 Pause of 1.0 s",
      "62.5% 0:12.5 Force above 1.5 N",
      "90% 0:18.0 Floor reached",
    ]);
    nothing_wrong(opened);
    await page.close();
  },
);

test(
  "playing moves the time at the chosen speed, and nothing plays by itself",
  { skip },
  async () => {
    const opened = await open(browser, session_file, "#t=1");
    const { page } = opened;
    await new Promise((done) => setTimeout(done, 400));
    assert.equal(await scrubber_s(page), 1);
    await page.select(".player select", "4");
    await press_now(page, "Play"); // nothing settles while it plays
    await until(async () => (await scrubber_s(page)) > 2, "it plays");
    await press_now(page, "Pause");
    const stopped = await scrubber_s(page);
    await new Promise((done) => setTimeout(done, 300));
    assert.equal(await scrubber_s(page), stopped);
    await page.select(".player select", "16");
    await press_now(page, "Play"); // nothing settles while it plays
    await until(async () => (await scrubber_s(page)) === 20, "it plays to the end");
    await until(
      () => page.evaluate(() => document.querySelector(".play")!.textContent === "Play"),
      "and stops there",
    );
    nothing_wrong(opened);
    await page.close();
  },
);

test("colours, outline, cut-away and views change the picture", { skip }, async () => {
  const opened = await open(browser, session_file);
  const { page } = opened;
  const seen = [await pixels(page)];
  const changed = async (what: string, least: number): Promise<void> => {
    const now = await pixels(page);
    for (const before of seen.slice(-1)) assert.ok(different(before, now) > least, what);
    seen.push(now);
  };
  await check(page, "tissue");
  await changed("tissue colours", 500);
  assert.equal(
    await page.evaluate(() => document.querySelector<HTMLElement>(".key")!.hidden),
    true,
  );
  await check(page, "deviation");
  await check(page, "target outline");
  await changed("the target's outline", 500);
  for (const view of ["Occlusal", "Mesial", "Buccal"]) {
    await press(page, view);
    await changed(view, 2000);
  }
  await page.select(".cut select", "buccal");
  await changed("the cut-away", 2000);
  await page.screenshot({ path: "report_session_cut.png" });
  await page.focus(".cut input");
  for (let i = 0; i < 10; ++i) await page.keyboard.press("ArrowLeft");
  await changed("the cut's place", 500);
  await page.select(".cut select", "");
  await changed("whole again", 2000);
  nothing_wrong(opened);
  await page.close();
});

test("the value under the pointer is the distance to the target", { skip }, async () => {
  const opened = await open(browser, session_file);
  const { page } = opened;
  const said = (): Promise<string> =>
    page.evaluate(() => document.querySelector(".readout")!.textContent!);
  await press(page, "Occlusal");
  const box = await view_box(page);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await settled(page);
  const found = /^−(0\.\d\d) mm left standing · dentin · cut at 0:(\d\d\.\d)/.exec(await said());
  assert.ok(found, await said());
  assert.ok(
    Math.abs(Number(found[1]) - 0.25) <= 0.03 && Math.abs(Number(found[2]) - 18) < 0.5,
    found[0],
  );
  await page.mouse.click(box.x + box.width / 2, box.y + box.height / 2, { count: 2 });
  assert.ok(
    Math.abs((await scrubber_s(page)) - 18) < 0.5,
    "a double click goes to when it was cut",
  );
  await page.mouse.move(box.x + 3, box.y + box.height - 3);
  assert.equal(await said(), "");
  nothing_wrong(opened);
  await page.close();
});

test(
  "everything is reached and worked by keyboard alone, with a visible focus",
  { skip },
  async () => {
    const opened = await open(browser, session_file);
    const { page } = opened;
    const expected = await page.evaluate(() => {
      let n = 0;
      for (const e of document.querySelectorAll<HTMLElement>(
        "button, select, input, [tabindex='0']",
      )) {
        if (
          (e as HTMLInputElement).disabled ||
          (e instanceof HTMLInputElement && e.type === "radio" && !e.checked)
        )
          continue;
        e.dataset.wanted = "";
        ++n;
      }
      return n;
    });
    assert.ok(expected > 25, `${expected} controls`);
    const reached = new Set<string>();
    for (let i = 0; i < expected; ++i) {
      await page.keyboard.press("Tab");
      const state = await page.evaluate((index) => {
        const e = document.activeElement as HTMLElement;
        delete e.dataset.wanted;
        e.dataset.order = String(index);
        const style = getComputedStyle(e);
        return {
          name: `${e.tagName} ${e.className} ${e.textContent!.slice(0, 20)} ${index}`,
          outline: style.outlineStyle !== "none" && parseFloat(style.outlineWidth) >= 2,
        };
      }, i);
      assert.ok(state.outline, `${state.name} shows no focus`);
      reached.add(state.name);
    }
    assert.deepEqual(
      await page.evaluate(() =>
        [...document.querySelectorAll<HTMLElement>("[data-wanted]")].map((e) => e.outerHTML),
      ),
      [],
      "not reached by Tab",
    );
    assert.equal(reached.size, expected);

    const focus = (selector: string): Promise<void> => page.focus(selector);
    await focus("#tooth-3d canvas");
    const before = await pixels(page);
    for (const key of ["ArrowLeft", "ArrowUp", "+"]) {
      const then = await pixels(page);
      await page.keyboard.press(key as "ArrowLeft");
      assert.ok(different(then, await pixels(page)) > 300, `${key} moves the view`);
    }
    await page.keyboard.press("Home");
    assert.equal(different(before, await pixels(page)), 0, "Home shows it as in the beginning");
    await page.keyboard.press("Enter");
    assert.match(await page.evaluate(() => document.querySelector(".readout")!.textContent!), /mm/);

    await focus(".player input[type=range]");
    await page.keyboard.press("Home");
    assert.equal(await scrubber_s(page), 0);
    await page.keyboard.press("ArrowRight");
    assert.equal(await scrubber_s(page), 0.1);
    await page.keyboard.press("Space");
    await until(async () => (await scrubber_s(page)) > 0.3, "the space bar plays");
    await page.keyboard.press("Space");

    await focus(".jump");
    await page.keyboard.press("Enter");
    assert.equal(await scrubber_s(page), 12.5);
    await focus("#charts .plot");
    await page.keyboard.press("ArrowRight");
    assert.ok(Math.abs((await scrubber_s(page)) - 12.6) < 0.011);
    nothing_wrong(opened);
    await page.close();
  },
);

test(
  "fingers turn and zoom the tooth, and the wheel zooms only a view that has the focus",
  { skip },
  async () => {
    const opened = await open(browser, session_file);
    const { page } = opened;
    const box = await view_box(page);
    const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
    const still = await pixels(page);
    const top = await page.evaluate(() => window.scrollY);
    await page.mouse.move(x, y);
    await page.mouse.wheel({ deltaY: 120 });
    await until(() => page.evaluate((before) => window.scrollY > before, top), "the page scrolls");
    assert.equal(different(still, await pixels(page)), 0, "and the view stays");
    await page.evaluate((before) => window.scrollTo(0, before), top);
    await page.mouse.click(x, y);
    await page.mouse.wheel({ deltaY: -240 });
    await until(async () => different(still, await pixels(page)) > 1000, "a click, and it zooms");
    assert.equal(await page.evaluate(() => window.scrollY), top);

    const zoomed = await pixels(page);
    const session = await page.createCDPSession();
    const touch = (
      type: "touchStart" | "touchMove" | "touchEnd",
      ...points: number[][]
    ): Promise<unknown> =>
      session.send("Input.dispatchTouchEvent", {
        type,
        touchPoints: points.map(([px, py], id) => ({ x: px, y: py, id })),
      });
    await touch("touchStart", [x, y]);
    await touch("touchMove", [x + 40, y]);
    await touch("touchEnd");
    const turned = await pixels(page);
    assert.ok(different(zoomed, turned) > 1000, "one finger turns");
    await touch("touchStart", [x - 80, y], [x + 80, y]);
    await touch("touchMove", [x - 30, y], [x + 30, y]);
    await touch("touchEnd");
    assert.ok(different(turned, await pixels(page)) > 1000, "two fingers zoom");
    nothing_wrong(opened);
    await page.close();
  },
);

test("whoever asks for less motion gets none that was not asked for", { skip }, async () => {
  const opened = await open(browser, session_file, "#t=3", 860, 420);
  const { page } = opened;
  await page.emulateMediaFeatures([{ name: "prefers-reduced-motion", value: "reduce" }]);
  const top = await page.evaluate(() => {
    window.scrollTo(0, 0);
    document.querySelector<HTMLElement>(".jump")!.click();
    return document.getElementById("tooth-3d")!.getBoundingClientRect().top; // at once, in the same turn
  });
  assert.ok(Math.abs(top) < 20, `${top} px`);
  nothing_wrong(opened);
  await page.close();
});

test("charts zoom by dragging, and a click moves the time", { skip }, async () => {
  const opened = await open(browser, session_file);
  const { page } = opened;
  const over = (await page.$$("#charts .u-over"))[0];
  await over.evaluate((e) => e.scrollIntoView({ block: "center" }));
  const box = (await over.boundingBox())!;
  const y = box.y + box.height / 2;
  await page.mouse.click(box.x + box.width * 0.25, y);
  assert.ok(Math.abs((await scrubber_s(page)) - 5) < 0.15, "a quarter of twenty seconds");
  await page.mouse.move(box.x + box.width * 0.5, y);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width * 0.6, y, { steps: 5 });
  await page.mouse.up();
  await settled(page);
  await page.mouse.click(box.x + box.width * 0.5, y);
  assert.ok(
    Math.abs((await scrubber_s(page)) - 11) < 0.15,
    `the middle of 10 to 12 s, not ${await scrubber_s(page)}`,
  );
  await press(page, "Whole exam");
  await page.mouse.click(box.x + box.width * 0.5, y);
  assert.ok(Math.abs((await scrubber_s(page)) - 10) < 0.15);
  const labels = await page.evaluate(() =>
    [...document.querySelectorAll("#charts .plot")].map((e) => e.getAttribute("aria-label")),
  );
  assert.match(labels[0]!, /^Force over time: 0\.00 to 1\.\d\d N, mean 0\.\d\d N/);
  nothing_wrong(opened);
  await page.close();
});

test(
  "axe-core finds nothing, wide and narrow, and a narrow page does not scroll sideways",
  { skip },
  async () => {
    for (const file of [session_file, class_file])
      for (const width of [1200, 360]) {
        const opened = await open(browser, file, "", width, 800);
        assert.deepEqual(await violations(opened.page, axe_source), []);
        assert.ok(
          (await opened.page.evaluate(() => document.documentElement.scrollWidth)) <= width,
          `${width} px`,
        );
        if (width === 360)
          await opened.page.screenshot({
            path: `report_narrow_${file === class_file ? "class" : "session"}.png`,
            fullPage: true,
          });
        nothing_wrong(opened);
        await opened.page.close();
      }
  },
);

test("a class is drawn with its heat, by how much it deviated", { skip }, async () => {
  const opened = await open(browser, class_file);
  const { page } = opened;
  assert.equal(await page.evaluate(() => document.querySelector(".player")), null);
  const near = await pixels(page);
  await page.select(".panel > label select", "0.5");
  assert.ok(different(near, await pixels(page)) > 500);
  await page.select(".panel > label select", "0.1");
  await page.screenshot({ path: "report_class.png", fullPage: true });
  await press(page, "Occlusal");
  const box = await view_box(page);
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  assert.match(
    await page.evaluate(() => document.querySelector(".readout")!.textContent!),
    /^−\d\d % of the class left it standing · dentin/,
  );
  nothing_wrong(opened);
  await page.close();
});

test("without WebGL the page says so, and scrubber, charts and jumps work", { skip }, async () => {
  const plain = await launch("--disable-3d-apis");
  try {
    const opened = await open(plain, session_file);
    const { page } = opened;
    assert.match(
      await page.evaluate(() => document.querySelector(".fallback")!.textContent!),
      /WebGL/,
    );
    assert.equal(await page.evaluate(() => document.querySelector("#tooth-3d canvas")), null);
    await page.click(".jump");
    assert.equal(await scrubber_s(page), 12.5);
    assert.ok(
      await page.evaluate(() =>
        [...document.querySelectorAll("#charts .now")].every((e) =>
          e.textContent!.startsWith("0:12.5"),
        ),
      ),
    );
    assert.deepEqual(await violations(page, axe_source), []);
    nothing_wrong(opened);
  } finally {
    await plain.close();
  }
});

test("it prints", { skip }, async () => {
  const opened = await open(browser, session_file);
  const pdf = await opened.page.pdf({
    path: "report_session.pdf",
    format: "A4",
    printBackground: true,
  });
  assert.ok(pdf.length > 20_000);
  nothing_wrong(opened);
  await opened.page.close();
});
