// Bundles the pages into ../static/dist. Everything a browser will ask for is in there; nothing comes from elsewhere.
import { build } from "esbuild";
import { copyFile, mkdir, readFile, rm, writeFile } from "node:fs/promises";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const dist = join(here, "..", "static", "dist");
const swagger = join(here, "node_modules", "swagger-ui-dist");

await rm(dist, { recursive: true, force: true });
await mkdir(dist, { recursive: true });
await build({
  absWorkingDir: here,
  entryPoints: ["src/main.js", "src/docs.js", "src/style.css"],
  outdir: dist,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  logLevel: "warning",
});

const copies = [
  [join(here, "index.html"), "index.html"],
  [join(here, "docs.html"), "docs.html"],
  [join(here, "src", "favicon.svg"), "favicon.svg"],
  [join(swagger, "swagger-ui-bundle.js"), "swagger-ui-bundle.js"],
  [join(swagger, "swagger-ui.css"), "swagger-ui.css"],
];
await Promise.all(copies.map(([from, name]) => copyFile(from, join(dist, name))));

const licences = [];
for (const name of ["three", "uplot", "swagger-ui-dist"]) {
  const folder = join(here, "node_modules", name);
  const { version } = JSON.parse(await readFile(join(folder, "package.json"), "utf8"));
  licences.push(`${name} ${version}\n\n${await readFile(join(folder, "LICENSE"), "utf8")}`);
}
await writeFile(join(dist, "LICENSES.txt"), licences.join("\n\n----\n\n"));
