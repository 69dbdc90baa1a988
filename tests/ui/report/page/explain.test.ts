// Pages that `cavum explain` writes, in the browser: no finding by axe-core, light and dark, wide and on a telephone; there nothing but charts and
// tables in boxes of their own goes sideways, and all words can be read. Pictures are left in the build directory (explain_*.png).
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import { k_skip, launch, violations } from "./chromium.ts";

const axe_source = readFileSync(
  createRequire(resolve("package.json")).resolve("axe-core/axe.min.js"),
  "utf8",
);
const skip = k_skip;
const folder = mkdtempSync(join(tmpdir(), "cavum_explain_page_"));
const source = process.env.CAVUM_SOURCE_DIR!;
const k_wide_px = 1280;
const k_narrow_px = 390;
const k_min_text_px = 16;
let browser: Browser;

function cavum(...args: string[]): void {
  const run = spawnSync(process.env.CAVUM_BINARY!, args, {
    encoding: "utf8",
    env: { ...process.env, CAVUM_HOME: folder },
  });
  assert.equal(run.status, 0, `cavum ${args.join(" ")}: ${run.stderr}`);
}
/** Presses of eight sessions of long names, 100 rows a second; `more` is added to k X + c V. */
function recording(
  name: string,
  more: (t_s: number, x_mm: number, v_mm_s: number) => number,
): string {
  const rows = ["session,t_s,x_mm,v_mm_s,f_n"];
  let state = 12345;
  const noise = (): number =>
    [0, 1, 2, 3].reduce(
      (sum) => ((state = (state * 48271) % 2147483647), sum + state / 2147483647 - 0.5),
      0,
    ) * 0.012;
  for (let s = 0; s < 8; ++s)
    for (let i = 0; i < 900; ++i) {
      const t = i / 100;
      const rate = 1.2 + 0.35 * s + 0.25 * Math.floor(t / 3);
      const x = 0.45 * Math.sin(rate * t) - 0.05 + 0.02 * s;
      const v = 0.45 * rate * Math.cos(rate * t);
      const f = x > 0 ? Math.max(0, 0.8 * x + 0.05 * v) : 0;
      rows.push(
        `2026-11-24_bench_left_${s},${t.toFixed(2)},${x.toFixed(5)},${v.toFixed(5)},${(f + more(t, x, v) + noise()).toFixed(4)}`,
      );
    }
  const file = join(folder, `${name}.csv`);
  writeFileSync(file, `${rows.join("\n")}\n`);
  return file;
}
function page_of(name: string, ...args: string[]): string {
  const file = join(folder, `${name}.html`);
  cavum("explain", ...args, "--out", file);
  return file;
}

/** What the browser says of the page as it stands: wider than the window, or words too small. */
async function unread(page: Page): Promise<string[]> {
  return page.evaluate((least_px) => {
    const said: string[] = [];
    const width = document.documentElement.clientWidth;
    if (document.documentElement.scrollWidth > width)
      said.push(`the page is ${document.documentElement.scrollWidth} px wide in ${width}`);
    for (const e of document.querySelectorAll<HTMLElement>("body *"))
      if (
        !e.parentElement!.closest(".scroll, svg") &&
        e.getBoundingClientRect().right > width + 0.5
      )
        said.push(`beyond the edge: ${e.outerHTML.slice(0, 120)}`);
    for (const svg of document.querySelectorAll("svg[role=img]")) {
      const { left, right, top, bottom } = svg.getBoundingClientRect();
      for (const t of svg.querySelectorAll("text")) {
        const box = t.getBoundingClientRect();
        if (
          box.width > 0 &&
          (box.left < left - 0.5 ||
            box.right > right + 0.5 ||
            box.top < top - 0.5 ||
            box.bottom > bottom + 0.5)
        )
          said.push(`cut: ${t.textContent}`);
      }
    }
    const walk = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walk.nextNode()) {
      const owner = walk.currentNode.parentElement!;
      if (walk.currentNode.textContent!.trim() === "") continue;
      const drawing = owner.closest("svg");
      const px =
        parseFloat(getComputedStyle(owner).fontSize) * (drawing ? drawing.getScreenCTM()!.a : 1);
      if (px < least_px - 0.01)
        said.push(`${px.toFixed(1)} px: ${walk.currentNode.textContent!.trim().slice(0, 60)}`);
    }
    return said;
  }, k_min_text_px);
}

/** Opens a page in both widths and colours and tells whatever is wrong with it. */
async function expect_readable(file: string, name: string): Promise<void> {
  const page = await browser.newPage();
  page.setDefaultTimeout(120_000);
  const asked: string[] = [];
  const address = pathToFileURL(file).href;
  page.on("request", (r) => {
    if (r.url() !== address) asked.push(r.url());
  });
  for (const width of [k_wide_px, k_narrow_px])
    for (const scheme of ["light", "dark"]) {
      await page.setViewport({ width, height: 900 });
      await page.emulateMediaFeatures([{ name: "prefers-color-scheme", value: scheme }]);
      await page.goto(address, { waitUntil: "load" });
      await page.evaluate(() => {
        for (const d of document.querySelectorAll("details")) d.open = true;
      });
      const where = `${name}, ${width} px, ${scheme}`;
      assert.deepEqual(await violations(page, axe_source), [], where);
      assert.deepEqual(await unread(page), [], where);
      if (scheme === "light")
        await page.screenshot({ path: `explain_${name}_${width}.png`, fullPage: true });
    }
  assert.deepEqual(asked, []);
  await page.close();
}
async function expect_verdict(file: string, verdict: string): Promise<void> {
  assert.match(readFileSync(file, "utf8"), new RegExp(`class="verdict" data-verdict="${verdict}"`));
}

before(async () => {
  if (!skip) browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

test(
  "a named cause: verdict, cause with picture, gain by session, and what to record next, in this order",
  { skip },
  async () => {
    const file = page_of("named", join(source, "data/measured/hunt/recording.csv"), "--seed", "3");
    await expect_verdict(file, "named");
    const html = readFileSync(file, "utf8");
    const order = [
      'class="verdict"',
      "<h2>",
      "<figcaption>",
      " %: ",
      'class="bars sessions"',
      "<h2>",
      '</h2>\n<p class="next">',
      "<h2>",
      '<div class="scroll"',
      "<h2>",
      '<div class="pair">',
      "<h2>",
      "<details",
      "<h2>",
    ];
    let at = html.indexOf("<main>");
    for (const part of order) assert.notEqual((at = html.indexOf(part, at + 1)), -1, part);
    await expect_readable(file, "named");
  },
);

test("causes under long names of sessions", { skip }, async () => {
  await expect_readable(
    page_of(
      "friction",
      recording("friction", (_t, _x, v) => 0.05 * Math.tanh(v / 0.01)),
    ),
    "friction",
  );
});

test("nothing hidden", { skip }, async () => {
  await expect_readable(
    page_of(
      "clean",
      recording("clean", () => 0),
    ),
    "clean",
  );
});

test("something that no law describes", { skip }, async () => {
  await expect_readable(
    page_of(
      "unexplained",
      recording("unexplained", (_t, x) => 0.06 * Math.sin(40 * x)),
    ),
    "unexplained",
  );
});

test("a table of force over stiffness", { skip }, async () => {
  const file = page_of("table", join(source, "data/measured/fig6/fig6.csv"));
  await expect_verdict(file, "alias");
  await expect_readable(file, "table");
});

test("a recording that counts in another way than it says", { skip }, async () => {
  const file = join(folder, "fault.html");
  const name = recording("fault", () => 0);
  writeFileSync(
    name,
    readFileSync(name, "utf8").replace(
      /,(-?[\d.]+)$/gm,
      (_all, f: string) => `,${(-Number(f)).toFixed(4)}`,
    ),
  );
  spawnSync(process.env.CAVUM_BINARY!, ["explain", name, "--out", file], {
    env: { ...process.env, CAVUM_HOME: folder },
  });
  await expect_verdict(file, "data_fault");
  await expect_readable(file, "fault");
});

test("what was understood, of a dry run", { skip }, async () => {
  await expect_readable(
    page_of(
      "seen",
      recording("seen", () => 0),
      "--dry-run",
    ),
    "seen",
  );
});

test("the protocol", { skip }, async () => {
  const file = join(folder, "protocol.html");
  cavum("explain", "--protocol", file);
  await expect_readable(file, "protocol");
});
