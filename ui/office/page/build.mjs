// Bundles src/main.ts and src/office.css into office.js and office.css, in the directory it is run from (node_modules and src stand there).
import { buildSync } from "esbuild";
import { copyFileSync } from "node:fs";

const common = { bundle: true, minify: true, legalComments: "none", preserveSymlinks: true, logLevel: "warning" };
const { metafile } = buildSync({ ...common, entryPoints: ["src/main.ts"], outfile: "office.js", format: "iife", target: ["es2020"], metafile: true });
if (Object.keys(metafile.inputs).some((path) => path.includes("node_modules"))) throw new Error("cavum: ui/office/page: a package is bundled without its licence");
buildSync({ ...common, entryPoints: ["src/office.css"], outfile: "office.css" });
copyFileSync("src/office.html", "office.html");
