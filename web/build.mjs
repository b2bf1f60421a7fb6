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

/** The module without its custom sections: names, and by what it was made. */
function stripped(bytes) {
  let at = 8;
  const parts = [bytes.subarray(0, at)];
  const number = () => {
    let [value, shift, byte] = [0, 0, 0];
    do {
      byte = bytes[at++];
      value += (byte & 127) * 2 ** shift;
      shift += 7;
    } while (byte & 128);
    return value;
  };
  while (at < bytes.length) {
    const begin = at;
    const kind = bytes[at++];
    at = number() + at;
    if (kind !== 0) parts.push(bytes.subarray(begin, at));
  }
  return Buffer.concat(parts);
}

/** A module as it is built, without what it need not have. */
function built(...names) {
  return stripped(readFileSync(join(target, TRIPLE, "web", ...names)));
}

/** The module in parts, each a file of LZMA: two workers unpack them. */
function packed(module) {
  const middle = module.length >> 1;
  const parts = [module.subarray(0, middle), module.subarray(middle)];
  const options = ["--format=lzma", "-9e", "--stdout"];
  const pack = (bytes) => execFileSync("xz", options, { input: bytes, maxBuffer: 1e9 });
  return {
    SIZE: parts.map((part) => part.length).join(),
    WASM: parts.map((part) => pack(part).toString("base64")).join("\n"),
  };
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
    UNPACK: gzipSync(built("examples", "unpack.wasm"), { level: 9 }).toString("base64"),
    ...packed(built("stickslip_explorer.wasm")),
    WORKER: await bundle("worker.ts"),
    MAIN: await bundle("main.ts"),
  };
  const frame = readFileSync(join(here, "src/page.html"), "utf8");
  const html = frame.replace(/@(STYLE|UNPACK|SIZE|WASM|WORKER|MAIN)@/g, (_, name) => parts[name]);
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
