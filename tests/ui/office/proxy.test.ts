// Who is signed in at the school is signed in at the office: what a reverse proxy adds is added here by the browser, from the proxy's address.
import assert from "node:assert/strict";
import { writeFileSync } from "node:fs";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { k_skip } from "../report_test/chromium.ts";
import {
  add_account,
  address,
  browser,
  close_office,
  look,
  open_office,
  press,
  refused,
  serve_with,
  type,
} from "./browser.ts";

const secret = "0123456789abcdef0123456789abcdef";
before(async () => {
  if (k_skip) return;
  serve_with((folder) => {
    writeFileSync(join(folder, "proxy.secret"), `${secret}\n`, { mode: 0o600 });
    return ["--proxy-address", "127.0.0.1", "--proxy-secret", join(folder, "proxy.secret")];
  });
  await open_office();
  add_account("Eva Stein", "examiner", false, "--known-as", "eva.stein@uni.example");
});
after(close_office);

test("a sign-in by the school's account", { skip: k_skip }, async () => {
  const context = await browser.createBrowserContext();
  const page = await context.newPage();
  const complaints: string[] = [];
  page.on("pageerror", (e) => complaints.push(String(e)));
  const by_proxy = (who: string) =>
    page.setExtraHTTPHeaders({ "X-Auth-Request-Email": who, "X-Cavum-Proxy-Secret": secret });
  await by_proxy("nobody@uni.example");
  await page.goto(address);
  await page.waitForSelector("form");
  await look({ page, complaints }, "sign-in-by-proxy");
  await press(page, "Sign in with the school's account");
  await refused(page);
  await by_proxy("eva.stein@uni.example");
  await page.focus("main button.main");
  await page.keyboard.press("Enter");
  await page.waitForSelector("nav");
  assert.ok((await page.$eval("header", (h) => h.innerText)).includes("Eva Stein, examiner"));
  await by_proxy("nobody@uni.example"); // another person at this computer
  await page.reload();
  await page.waitForSelector("form");
  assert.equal(await page.$("nav"), null);
  await page.setExtraHTTPHeaders({});
  await page.reload();
  await page.waitForSelector("form");
  await type(page, "Name", "Rita Reader");
  await type(page, "Password", "correct horse trial");
  await page.keyboard.press("Enter");
  await page.waitForSelector("nav");
  assert.deepEqual(complaints, []);
});
