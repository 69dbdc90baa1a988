// A headless Chromium for the tests, drawing by the processor. Every page reports what it asked of the network and what it complained about.
import { spawnSync } from "node:child_process";
import { readdirSync, readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import puppeteer, { type Browser, type Page } from "puppeteer-core";

/** Path of the browser, null when none is installed; CAVUM_CHROMIUM names another one. */
export function chromium(): string | null {
  if (process.env.CAVUM_CHROMIUM) return process.env.CAVUM_CHROMIUM;
  const found = spawnSync(
    "sh",
    ["-c", "command -v chromium || command -v chromium-browser || command -v google-chrome"],
    { encoding: "utf8" },
  );
  return found.status === 0 ? found.stdout.trim().split("\n")[0] : null;
}

export const k_skip = chromium()
  ? false
  : "chromium is not installed, so no report was opened in a browser (./dev test installs it)";

export async function launch(...more: string[]): Promise<Browser> {
  return puppeteer.launch({
    executablePath: chromium()!,
    headless: true,
    protocolTimeout: 300_000,
    timeout: 120_000,
    // a container has no namespaces for the sandbox, and the only pages opened are our own files
    args: [
      "--no-sandbox",
      "--disable-dev-shm-usage",
      "--disable-background-networking",
      "--use-gl=angle",
      "--use-angle=swiftshader",
      "--enable-unsafe-swiftshader",
      "--ignore-gpu-blocklist",
      "--force-color-profile=srgb",
      ...more,
    ],
  });
}

export interface Opened {
  page: Page;
  /** Addresses asked for, beyond the file itself and what it holds. */
  requests: string[];
  /** Errors and warnings, without the driver's own remarks on how fast it is. */
  complaints: string[];
}

export async function open(
  browser: Browser,
  file: string,
  fragment = "",
  width = 860,
  height = 560,
): Promise<Opened> {
  const page = await browser.newPage();
  page.setDefaultTimeout(120_000);
  await page.setViewport({ width, height });
  const opened: Opened = { page, requests: [], complaints: [] };
  const address = pathToFileURL(file).href;
  page.on("request", (r) => {
    if (
      !r.url().startsWith(address) &&
      !r.url().startsWith("data:") &&
      !r.url().startsWith("blob:")
    )
      opened.requests.push(r.url());
  });
  page.on("console", (m) => {
    if (["error", "warn", "assert"].includes(m.type()) && !/GL Driver Message/.test(m.text()))
      opened.complaints.push(`${m.type()}: ${m.text()}`);
  });
  page.on("pageerror", (e) =>
    opened.complaints.push(`thrown: ${e instanceof Error ? e.message : String(e)}`),
  );
  await page.goto(address + fragment, { waitUntil: "load" });
  await until(
    async () => page.evaluate(() => document.documentElement.classList.contains("scripted")),
    "the page's script ran",
  );
  await settled(page);
  return opened;
}

/** Waits for two pictures, so that what changed is drawn, and until views that were drawn with fewer pixels meanwhile have all of them. */
export async function settled(page: Page): Promise<void> {
  await page.evaluate(async () => {
    const pictures = (): Promise<void> =>
      new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done())));
    await pictures();
    while (document.querySelector("canvas[data-rests=false]")) await pictures();
  });
}

/** Waits until something is true; the page's rules forbid the waiting that evaluates strings. `instead` tells what there was at the end of a wait in vain. */
export async function until(
  what: () => Promise<boolean>,
  said: string,
  instead: () => Promise<string> = async () => "",
): Promise<void> {
  const end = Date.now() + 120_000;
  while (!(await what())) {
    if (Date.now() > end) throw new Error(`waited two minutes for: ${said} ${await instead()}`);
    await new Promise((done) => setTimeout(done, 50));
  }
}

/** The canvas of the 3D view as red green blue alpha bytes, with its width. */
export async function pixels(
  page: Page,
): Promise<{ width: number; height: number; data: Uint8Array }> {
  await settled(page);
  const { width, height, text } = await page.evaluate(() => {
    const canvas = document.querySelector<HTMLCanvasElement>("#tooth-3d canvas")!;
    const copy = document.createElement("canvas");
    copy.width = canvas.width;
    copy.height = canvas.height;
    const context = copy.getContext("2d")!;
    context.drawImage(canvas, 0, 0);
    const bytes = context.getImageData(0, 0, copy.width, copy.height).data;
    let binary = "";
    for (let i = 0; i < bytes.length; i += 8192)
      binary += String.fromCharCode(...bytes.subarray(i, i + 8192));
    return { width: copy.width, height: copy.height, text: btoa(binary) };
  });
  return { width, height, data: new Uint8Array(Buffer.from(text, "base64")) };
}

/** How many pixels of two pictures differ visibly. */
export function different(a: { data: Uint8Array }, b: { data: Uint8Array }): number {
  let n = 0;
  for (let i = 0; i < a.data.length; i += 4)
    if (
      Math.abs(a.data[i] - b.data[i]) +
        Math.abs(a.data[i + 1] - b.data[i + 1]) +
        Math.abs(a.data[i + 2] - b.data[i + 2]) >
      24
    )
      ++n;
  return n;
}

/** Processor time of the browser and all that it began, ms, in steps of 10. */
function processor_ms(browser: Browser): number {
  const all = new Map<string, { parent: string; ms: number }>();
  for (const id of readdirSync("/proc").filter((name) => /^\d+$/.test(name)))
    try {
      const text = readFileSync(`/proc/${id}/stat`, "utf8");
      const fields = text.slice(text.lastIndexOf(")") + 2).split(" ");
      all.set(id, { parent: fields[1], ms: 10 * (Number(fields[11]) + Number(fields[12])) });
    } catch {
      // it ended meanwhile
    }
  const root = String(browser.process()!.pid);
  let sum = 0;
  for (const [id, { ms }] of all) {
    let at: string | undefined = id;
    while (at && at !== root) at = all.get(at)?.parent;
    if (at === root) sum += ms;
  }
  return sum;
}

export interface Seek {
  t_s: number;
  /** By the clock, from the scrubber's input until two pictures later. */
  clock_ms: number;
  /** Of the browser with all its processes meanwhile: what it takes on a quiet machine at most. */
  processor_ms: number;
}

/** Moves the scrubber to `n` moments all over the exam, each time from a picture that rests. */
export async function seeks(browser: Browser, page: Page, n: number): Promise<Seek[]> {
  const duration_s = await page.evaluate(() =>
    Number(document.querySelector<HTMLInputElement>(".player input[type=range]")!.max),
  );
  const all: Seek[] = [];
  for (let i = 0; i < n; ++i) {
    const t_s = (duration_s * ((i * 7) % n)) / n;
    await settled(page);
    const before = processor_ms(browser);
    const clock_ms = await page.evaluate(async (t) => {
      const from = performance.now();
      const range = document.querySelector<HTMLInputElement>(".player input[type=range]")!;
      range.value = String(t);
      range.dispatchEvent(new Event("input"));
      await new Promise<void>((done) =>
        requestAnimationFrame(() => requestAnimationFrame(() => done())),
      );
      return performance.now() - from;
    }, t_s);
    all.push({ t_s, clock_ms, processor_ms: processor_ms(browser) - before });
  }
  return all;
}

/** Seconds that the scrubber stands at. */
export async function scrubber_s(page: Page): Promise<number> {
  return page.evaluate(() =>
    Number(document.querySelector<HTMLInputElement>(".player input[type=range]")!.value),
  );
}

/** Names of axe-core's rules that a page breaks, with the elements. */
export async function violations(page: Page, axe_source: string): Promise<string[]> {
  await page.evaluate(axe_source);
  return page.evaluate(async () => {
    const { axe } = window as unknown as {
      axe: {
        run(): Promise<{
          violations: { id: string; nodes: { html: string; failureSummary: string }[] }[];
        }>;
      };
    };
    return (await axe.run()).violations.flatMap((v) =>
      v.nodes.map((n) => `${v.id}: ${n.html.slice(0, 200)} ${n.failureSummary}`),
    );
  });
}
