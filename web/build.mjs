// Builds the page: Rust to WebAssembly, TypeScript to JavaScript, all into one HTML file.
//
//   node build.mjs               builds the module and the page, crates/page/explorer.html
//   node build.mjs --page        builds the page alone, with the module of the last build
//   node build.mjs --out FILE    builds both, and writes the page into a file of its own
//
// With rustup: `rustup target add wasm32-unknown-unknown`. Without that target, Debian's packages
// rustc-web and rust-web-src have a compiler and the sources of its library, which is built too.

import { execFileSync } from "node:child_process";
import { existsSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { gzipSync } from "node:zlib";
import { build } from "esbuild";
import { called, split, stripped } from "./split.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const root = dirname(here);
const target = process.env.CARGO_TARGET_DIR ?? join(root, "target", "web");
const TRIPLE = "wasm32-unknown-unknown";
const MOST_BYTES = 1_500_000;

/** Compiles the module, and the one that unpacks it. */
function compile() {
  const sysroot = execFileSync("rustc", ["--print", "sysroot"], { encoding: "utf8" }).trim();
  const args = [
    "build",
    "--target",
    TRIPLE,
    "--profile",
    "web",
    "-p",
    "stickslip-explorer",
    "--lib",
    "--example",
    "unpack",
    "--locked",
  ];
  const env = { ...process.env, CARGO_TARGET_DIR: target };
  if (!existsSync(join(sysroot, "lib", "rustlib", TRIPLE))) {
    args.push("-Z", "build-std=std,panic_abort");
    env.RUSTC = "/usr/bin/rustc";
    env.RUSTC_BOOTSTRAP = "1";
    env.CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER = join(
      sysroot,
      "lib/rustlib/x86_64-unknown-linux-gnu/bin/rust-lld",
    );
  }
  execFileSync("cargo", args, { cwd: root, env, stdio: "inherit" });
}

/** A module as it is built, without what it need not have. */
function built(...names) {
  return stripped(readFileSync(join(target, TRIPLE, "web", ...names)));
}

/** The module in parts: its opening, which the browser unpacks by itself, and the other functions
 * in files of LZMA, which two workers unpack. */
async function packed(module) {
  const { rehearsed } = await imported("opening.ts");
  const { opening, others } = split(module, await called(module, rehearsed));
  await rehearsed(opening);
  const { joined } = await imported("join.ts");
  if (!module.equals(joined(opening, [others]))) throw new Error("the module is another one");
  const middle = others.length >> 1;
  const parts = [others.subarray(0, middle), others.subarray(middle)];
  const options = ["--format=lzma", "-9e", "--stdout"];
  const pack = (bytes) => execFileSync("xz", options, { input: bytes, maxBuffer: 1e9 });
  return {
    OPENING: zipped(opening),
    SIZE: parts.map((part) => part.length).join(),
    WASM: parts.map((part) => text(pack(part))).join("\n"),
  };
}

function zipped(bytes) {
  return text(gzipSync(bytes, { level: 9 }));
}

/** Bytes as a text: each 13 bits are two characters, and up to 6 bits at the end are one. Of those
 * from ! to ~, a page cannot have ", & and < everywhere; base64 would be a twelfth longer. */
function text(bytes) {
  const codes = Array.from({ length: 94 }, (_, index) => String.fromCharCode(33 + index));
  const digits = codes.filter((it) => !['"', "&", "<"].includes(it));
  const found = [];
  let [held, bits] = [0, 0];
  for (const byte of bytes) {
    held |= byte << bits;
    bits += 8;
    if (bits < 13) continue;
    const value = held & 8191;
    found.push(digits[value % 91], digits[Math.floor(value / 91)]);
    held >>>= 13;
    bits -= 13;
  }
  if (bits > 0) found.push(digits[held % 91]);
  if (bits > 6) found.push(digits[Math.floor(held / 91)]);
  return found.join("");
}

/** What a source of the page exports, for the build itself. */
async function imported(entry) {
  const { outputFiles } = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    write: false,
    format: "esm",
    target: "es2022",
  });
  const base64 = Buffer.from(outputFiles[0].contents).toString("base64");
  return import(`data:text/javascript;base64,${base64}`);
}

async function bundle(entry) {
  const { outputFiles } = await build({
    entryPoints: [join(here, "src", entry)],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "utf8",
    loader: { ".slip": "text", ".css": "text" },
  });
  return outputFiles[0].text.trim();
}

async function css() {
  const { outputFiles } = await build({
    entryPoints: [join(here, "src/style.css")],
    minify: true,
    write: false,
  });
  return outputFiles[0].text.trim();
}

async function page() {
  const parts = {
    STYLE: await css(),
    UNPACK: zipped(built("examples", "unpack.wasm")),
    ...(await packed(built("stickslip_explorer.wasm"))),
    WORKER: await bundle("worker.ts"),
    MAIN: await bundle("main.ts"),
  };
  const frame = readFileSync(join(here, "src/page.html"), "utf8");
  const places = new RegExp(`@(${Object.keys(parts).join("|")})@`, "g");
  const html = frame.replace(places, (_, name) => parts[name]);
  const sizes = Object.entries(parts).map(
    ([name, text]) => `${name.toLowerCase()} ${Math.round(text.length / 1000)} kB`,
  );
  const bytes = Buffer.byteLength(html);
  console.log(`page ${Math.round(bytes / 1000)} kB: ${sizes.join(", ")}`);
  if (bytes > MOST_BYTES) throw new Error(`the page has more than ${MOST_BYTES} bytes`);
  return html;
}

const { values: options } = parseArgs({
  options: { page: { type: "boolean" }, out: { type: "string" } },
});
if (!options.page) compile();
execFileSync(join(here, "node_modules/.bin/tsc"), ["--noEmit"], { cwd: here, stdio: "inherit" });
writeFileSync(options.out ?? join(root, "crates", "page", "explorer.html"), await page());
