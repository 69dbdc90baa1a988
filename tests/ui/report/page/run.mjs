// Checks the tests' types, bundles them, and runs them by Node's test runner: `node test/run.mjs units|browser|real|FILE...` in the build directory
// of the page.
import { spawnSync } from "node:child_process";
import { readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const { buildSync } = createRequire(resolve("package.json"))("esbuild");
const run = (...args) => {
  const { status } = spawnSync(process.execPath, args, { stdio: "inherit" });
  if (status !== 0) process.exit(1);
};
const parts = { units: ["data", "alignment", "surface_nets", "tooth"], browser: ["browser"], real: ["real"] };
const wanted = process.argv.slice(2).flatMap((name) => parts[name] ?? [name]);
const bundled = `tests_bundled_${wanted.join("_")}`;
const files = readdirSync("test").filter((name) => name.endsWith(".test.ts") && (wanted.length === 0 || wanted.some((w) => name.startsWith(w))));
if (["data", "office"].some((part) => wanted.includes(part))) {  // once for all parts of a page
  writeFileSync("tsconfig.test.json", JSON.stringify({ extends: "./tsconfig.json", include: ["src/*.ts", "test/*.ts"] }));
  run("node_modules/typescript/bin/tsc", "--noEmit", "-p", "tsconfig.test.json");
}
rmSync(bundled, { recursive: true, force: true });
buildSync({
  entryPoints: files.map((name) => `test/${name}`),
  outdir: bundled,
  outExtension: { ".js": ".mjs" },
  bundle: true,
  platform: "node",
  format: "esm",
  target: ["node18"],
  packages: "external",
  preserveSymlinks: true,
  sourcemap: "inline",
  logLevel: "warning",
});
run("--enable-source-maps", "--test", "--test-concurrency=1", ...files.map((name) => `${bundled}/${name.replace(/\.ts$/, ".mjs")}`));
