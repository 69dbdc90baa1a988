// Every HTML page that the program writes, in English and German, on a desk and on a telephone: axe-core finds nothing, folded parts opened, and nothing
// is wider than the window; on a telephone nothing scrolls sideways by itself, either, beside what explain says.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { mkdtempSync, readdirSync, readFileSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { join, resolve } from "node:path";
import { pathToFileURL } from "node:url";
import { after, before, test } from "node:test";
import type { Browser, Page } from "puppeteer-core";
import { k_skip, launch, settled, violations } from "./chromium.ts";

const axe_source = readFileSync(
  createRequire(resolve("package.json")).resolve("axe-core/axe.min.js"),
  "utf8",
);
const folder = mkdtempSync(join(tmpdir(), "cavum_pages_"));
const source = process.env.CAVUM_SOURCE_DIR!;
const session = join(folder, "slot.cavum");
const ledger = join(folder, "ledger");
let browser: Browser;

function cavum(...args: string[]): void {
  const run = spawnSync(process.env.CAVUM_BINARY!, args, {
    encoding: "utf8",
    env: { ...process.env, CAVUM_HOME: folder },
    maxBuffer: 1 << 28,
  });
  assert.equal(run.status, 0, `cavum ${args.join(" ")}: ${run.stderr}`);
}

before(async () => {
  if (k_skip) return;
  const slot = join(source, "data/scenarios/slot.toml");
  cavum("exam", slot, "--candidate", "A17", "--operator", "novice", "--quiet", "--out", session);
  // a scan of a block could lie in more than one way
  cavum(
    "exam",
    join(source, "data/scenarios/class_1.toml"),
    "--candidate",
    "A18",
    "--operator",
    "novice",
    "--quiet",
    "--out",
    join(folder, "class_1.cavum"),
  );
  cavum("session", "export", join(folder, "class_1.cavum"), "--stl", join(folder, "class_1.stl"));
  cavum("ledger", "init", ledger, "--school", "Dentistry");
  cavum(
    "ledger",
    "ticket",
    ledger,
    slot,
    "--candidate",
    "4711",
    "--name",
    "Ann Lee",
    "--from",
    "2020-01-01T00:00Z",
    "--until",
    "2190-01-01T00:00Z",
    "--out",
    join(folder, "ticket"),
  );
  cavum(
    "exam",
    slot,
    "--ticket",
    join(folder, "ticket"),
    "--operator",
    "novice",
    "--quiet",
    "--out",
    join(folder, "filed.cavum"),
  );
  cavum("ledger", "add", ledger, join(folder, "filed.cavum"), "--simulated");
  cavum("ledger", "release", ledger, "--all");
  cavum(
    "cohort",
    "simulate",
    join(source, "tests/replay/block_cavity.toml"),
    "--ledger",
    ledger,
    "--sessions",
    join(folder, "class"),
    "--n",
    "2",
  );
  browser = await launch();
});
after(async () => {
  await browser?.close();
  rmSync(folder, { recursive: true, force: true });
});

/** Elements that scroll sideways: what a reader of a telephone has to push about. */
async function scrolling_sideways(page: Page): Promise<string[]> {
  return page.evaluate(() =>
    [...document.querySelectorAll<HTMLElement>("body, body *")]
      .filter(
        (e) =>
          e.clientWidth > 0 &&
          e.scrollWidth > e.clientWidth + 1 &&
          ["auto", "scroll"].includes(getComputedStyle(e).overflowX),
      )
      .map((e) => `${e.scrollWidth} px in ${e.clientWidth}: ${e.outerHTML.slice(0, 100)}`),
  );
}

/** What is wrong with a page at a width, with everything unfolded. */
async function wrong_with(file: string, width: number): Promise<string[]> {
  const page = await browser.newPage();
  page.setDefaultTimeout(120_000);
  await page.setViewport({ width, height: 900 });
  await page.goto(pathToFileURL(file).href, { waitUntil: "load" });
  await page.evaluate(() => {
    for (const d of document.querySelectorAll("details")) d.open = true;
  });
  await settled(page);
  const said = await violations(page, axe_source);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  if (wide > width) said.push(`${wide} px wide in ${width}`);
  if (width < 600 && !/explain|understood/.test(file))
    said.push(...(await scrolling_sideways(page)));
  await page.close();
  return said;
}

for (const language of ["en", "de"])
  test(`every page is accessible and fits, in ${language}`, { skip: k_skip }, async () => {
    const at = (name: string): string => join(folder, `${name}-${language}.html`);
    const write = (...args: string[]): void => cavum("--language", language, ...args);
    write("report", session, "--out", at("instructor"));
    write("report", session, "--no-replay", "--compare", "expert", "--out", at("beside"));
    write("report", session, "--for", "student", "--no-replay", "--out", at("student"));
    write("ledger", "report", ledger, "--out", join(folder, `released-${language}`));
    write(
      "scan",
      "grade",
      join(folder, "class_1.stl"),
      "--scenario",
      join(source, "data/scenarios/class_1.toml"),
      "--report",
      at("scan"),
    );
    write("cohort", "report", ledger, "--exam", "block_cavity", "--out", at("class"));
    // what explain says of a table is English in every language, and its pages say so
    const english = language === "en" ? ["explain", "understood", "protocol"] : [];
    if (english.length > 0) {
      write(
        "explain",
        join(source, "data/measured/hunt/recording.csv"),
        "--seed",
        "3",
        "--out",
        at("explain"),
      );
      write(
        "explain",
        join(source, "data/measured/hunt/recording.csv"),
        "--dry-run",
        "--out",
        at("understood"),
      );
      write("explain", "--protocol", at("protocol"));
    }
    const pages = ["instructor", "beside", "student", "scan", "class", ...english].map(at);
    for (const name of readdirSync(join(folder, `released-${language}`)))
      pages.push(join(folder, `released-${language}`, name));
    assert.equal(pages.length, 6 + english.length);
    for (const file of pages) {
      assert.match(
        readFileSync(file, "utf8").slice(0, 200),
        new RegExp(`<html lang=['"]${language}['"]`),
        file,
      );
      for (const width of [1280, 390])
        assert.deepEqual(await wrong_with(file, width), [], `${file}, ${width} px`);
    }
  });
