// Bundles the pages into ../static/dist. Everything a browser will ask for is in there; nothing comes from elsewhere.
// Names carry a hash of what is inside, so a browser keeps a file for as long as it is the one that is meant.
import { build } from "esbuild";
import { copyFile, mkdir, readFile, rename, rm, writeFile } from "node:fs/promises";
import { basename, dirname, join, relative } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const served = join(here, "..", "static", "dist");
const dist = `${served}.${process.pid}`;
const swagger = join(here, "node_modules", "swagger-ui-dist");
const ENTRIES = ["src/main.js", "src/pages.js", "src/docs.js", "src/style.css"];

const preload = (name) => `    <link rel="modulepreload" href="/static/${name}" />\n`;

await mkdir(dist, { recursive: true });
const { metafile } = await build({
  absWorkingDir: here,
  entryPoints: ENTRIES,
  outdir: dist,
  entryNames: "[name]-[hash]",
  chunkNames: "chunks/[name]-[hash]",
  bundle: true,
  splitting: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none",
  logLevel: "warning",
  metafile: true,
});

const nameOf = (path) => relative(dist, join(here, path));
const named = new Map();
const early = new Map();
for (const [path, { entryPoint, imports }] of Object.entries(metafile.outputs)) {
  if (!ENTRIES.includes(entryPoint)) continue;
  named.set(basename(entryPoint), nameOf(path));
  // Asked for together with the page, not one after the other.
  const parts = imports.filter(({ kind }) => kind === "import-statement").map((part) => nameOf(part.path));
  early.set(basename(entryPoint), parts);
}
await writeFile(join(dist, "names.json"), JSON.stringify(Object.fromEntries(named), null, 1));
for (const page of ["index.html", "docs.html"]) {
  const text = await readFile(join(here, page), "utf8");
  const preloads = page === "index.html" ? early.get("main.js").map(preload).join("") : "";
  const whole = text.replace(/"\/static\/([\w.]+)"/g, (_, name) => `"/static/${named.get(name) ?? name}"`);
  await writeFile(join(dist, page), whole.replace("  </head>", `${preloads}  </head>`));
}

const copies = [
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

// All at once: whoever opens the page meanwhile gets the old one or the new one.
await rename(served, `${dist}.old`).catch(() => {});
await rename(dist, served);
await rm(`${dist}.old`, { recursive: true, force: true });
