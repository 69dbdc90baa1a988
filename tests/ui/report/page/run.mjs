// Checks the tests' types, bundles them, and runs them by Node's test runner. Run in the build directory of the page.
import { spawnSync } from "node:child_process";
import { readdirSync, rmSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";
import { resolve } from "node:path";

const { buildSync } = createRequire(resolve("package.json"))("esbuild");
const run = (...args) => {
  const { status } = spawnSync(process.execPath, args, { stdio: "inherit" });
  if (status !== 0) process.exit(1);
};
writeFileSync("tsconfig.test.json", JSON.stringify({ extends: "./tsconfig.json", include: ["src/*.ts", "test/*.ts"] }));
run("node_modules/typescript/bin/tsc", "--noEmit", "-p", "tsconfig.test.json");
const wanted = process.argv.slice(2);
const files = readdirSync("test").filter((name) => name.endsWith(".test.ts") && (wanted.length === 0 || wanted.some((w) => name.startsWith(w))));
rmSync("tests_bundled", { recursive: true, force: true });
buildSync({
  entryPoints: files.map((name) => `test/${name}`),
  outdir: "tests_bundled",
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
run("--enable-source-maps", "--test", "--test-concurrency=1", ...files.map((name) => `tests_bundled/${name.replace(/\.ts$/, ".mjs")}`));
