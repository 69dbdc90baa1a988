// Bundles src/main.ts and src/page.css into page.js and page.css, in the directory it is run from (node_modules and src stand there).
// The licences of the bundled packages are appended, as they ask for.
import { build } from "esbuild";
import { existsSync, readdirSync, readFileSync, writeFileSync } from "node:fs";

const common = { bundle: true, minify: true, legalComments: "none", preserveSymlinks: true, logLevel: "warning" };
const script = await build({ ...common, entryPoints: ["src/main.ts"], format: "iife", target: ["es2020"], write: false, metafile: true });
const style = await build({ ...common, entryPoints: ["src/page.css"], write: false, metafile: true });

function licences(...metafiles) {
  const packages = new Set();
  for (const { inputs } of metafiles)
    for (const path of Object.keys(inputs)) {
      const found = path.match(/node_modules\/((?:@[^/]+\/)?[^/]+)\//);
      if (found) packages.add(found[1]);
    }
  return [...packages].sort().map((name) => {
    const folder = `node_modules/${name}`;
    const { version } = JSON.parse(readFileSync(`${folder}/package.json`, "utf8"));
    const file = readdirSync(folder).find((f) => /^licen[cs]e/i.test(f));
    if (!file || !existsSync(`${folder}/${file}`)) throw new Error(`cavum: ui/report/page: ${name} has no licence file; it cannot be bundled`);
    return `${name} ${version}\n${readFileSync(`${folder}/${file}`, "utf8").trim()}`;
  });
}

function write(name, text, texts) {
  const all = `${text.trimEnd()}\n/*\n${texts.join("\n\n").replaceAll("*/", "* /")}\n*/\n`;
  if (/<\/(script|style)/i.test(all) || all.includes("<!--")) throw new Error(`cavum: ui/report/page: ${name} would end the element that it stands in`);
  writeFileSync(name, all);
}
write("page.js", script.outputFiles[0].text, licences(script.metafile));
write("page.css", style.outputFiles[0].text, licences(style.metafile));
