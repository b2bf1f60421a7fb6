// The command lines of the page, run by the native program: they compute what the page shows.

import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { existsSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath } from "node:url";
import { launch, traced } from "./browser.mjs";

const built = ["release", "debug"].map((profile) =>
  fileURLToPath(new URL(`../../target/${profile}/stickslip`, import.meta.url)),
);
const program = process.env.STICKSLIP ?? built.find((path) => existsSync(path));
const skip = program
  ? false
  : "there is no native program; expected target/debug/stickslip, or STICKSLIP";

// A Python with the package, if there is one.
const python = process.env.PYTHON;

let browser;
let folder;
before(async () => {
  browser = await launch();
  folder = mkdtempSync(join(tmpdir(), "commands-"));
});
after(async () => {
  await browser.close();
  rmSync(folder, { recursive: true });
});

const run = (line, ...more) => {
  const [name, ...words] = line.split(" ");
  assert.equal(name, "stickslip");
  return execFileSync(program, [...words, ...more], { cwd: folder, encoding: "utf8" });
};

/** Runs lines of Python and more, and returns the JSON that these print. */
const inPython = (lines, more) =>
  JSON.parse(
    execFileSync(python, ["-c", `${lines}\nimport json\nprint(json.dumps(${more}))`], {
      cwd: folder,
      encoding: "utf8",
    })
      .trimEnd()
      .split("\n")
      .at(-1),
  );

const lines = (page) => page.locator("#lines pre").allTextContents();

for (const [name, change] of [
  ["the usual plane", {}],
  ["damping", { damping: 0.15, point: [33, 0.7] }],
  [
    "another law",
    {
      law: "gran/hertz/history",
      damping: 0.2,
      tangential: 0.5,
      point: [5, 0.3],
      x: { low: 4, high: 5, log: true },
      y: { low: 0.8, high: 0.9, log: false },
    },
  ],
  [
    "a hysteretic law",
    {
      law: "walton-braun",
      damping: 0.2,
      point: [5, 0.3],
      boundaries: false,
    },
  ],
  [
    "decaying friction",
    { law: "paper", dynamic: 0.4, decay: 5, point: [30, 0.55], boundaries: false },
  ],
  [
    "decaying friction in another law",
    {
      law: "gran/hertz/history+limit_damping",
      damping: 0.2,
      tangential: 0.5,
      dynamic: 0.25,
      decay: 2,
      point: [6, 0.35],
      boundaries: false,
    },
  ],
  [
    "adhesion",
    {
      law: "granular/jkr/viscoelastic/mindlin",
      damping: 0.1,
      tangential: 0.5,
      pull_off: 0.07,
      point: [8, 0.65],
      boundaries: false,
    },
  ],
  [
    "impact ratios from 0",
    {
      axes: "axis-ratio",
      x: { low: 0, high: 6, log: false },
      y: { low: 0, high: 4, log: false },
      point: [5, 1.1],
      mu: 0.3,
    },
  ],
]) {
  test(`commands of ${name}`, { skip }, async () => {
    const { page, said, close } = await browser.open();
    await page.evaluate((change) => globalThis.explorer.store.change(change), change);
    const traces = change.boundaries !== false;
    if (traces) await traced(page);
    await page.waitForFunction(
      (point) => document.querySelector("#lines").textContent.includes(String(point ?? "63")),
      change.point?.[1],
    );
    const own = await page.evaluate(() => globalThis.explorer.contact.contact.document);
    const [collide, inPythonToo, trace, traceInPython] = await lines(page);
    const native = JSON.parse(run(collide, "--format", "json"));
    assert.equal(native.itinerary, own.itinerary, collide);
    assert.ok(Math.abs(native.eps_t - own.eps_t) < 1e-11, collide);
    if (python) {
      const found = inPython(inPythonToo, "[collision.itinerary, collision.eps_t]");
      assert.equal(found[0], own.itinerary, inPythonToo);
      assert.ok(Math.abs(found[1] - own.eps_t) < 1e-11, inPythonToo);
    }
    if (traces) {
      const regions = await page.evaluate(() =>
        globalThis.explorer.plane.atlas.regions.map((it) => it.itinerary).sort(),
      );
      run(trace);
      const atlas = JSON.parse(readFileSync(join(folder, "atlas.json"), "utf8"));
      assert.deepEqual(atlas.regions.map((it) => it.itinerary).sort(), regions, trace);
      if (python) {
        const traced = inPython(traceInPython, "sorted(it.itinerary for it in atlas.regions)");
        assert.deepEqual(traced, regions, traceInPython);
      }
    }
    assert.deepEqual(said, []);
    await close();
  });
}

test("commands of two spheres", { skip }, async () => {
  const { page, said, close } = await browser.open("preset=figure2");
  await page.check("#other");
  await page.fill("#other-radius_m", "0.01");
  await page.press("#other-radius_m", "Enter");
  await page.waitForFunction(() => /Sphere\(0.01/.test(document.querySelector("#lines").textContent));
  const own = await page.evaluate(() => globalThis.explorer.contact.contact.document);
  const [collide, , impact] = await lines(page);
  const native = JSON.parse(run(collide, "--format", "json"));
  assert.equal(native.itinerary, own.itinerary, collide);
  if (python) {
    const found = inPython(impact, "float(found.eps_t)");
    assert.ok(Math.abs(found - own.eps_t) < 1e-9, `${impact} ${found} ${own.eps_t}`);
  }
  assert.deepEqual(said, []);
  await close();
});

test("commands of a system", { skip }, async () => {
  const axis = (low, high) => encodeURIComponent(JSON.stringify({ low, high, log: false }));
  const view = `tab=system&example=ball&across=e&up=g&sx=${axis(0.3, 0.7)}&sy=${axis(5, 15)}&most=6&set=${encodeURIComponent('{"height":3}')}&end=2`;
  const { page, said, close } = await browser.open(view);
  await page.waitForFunction(() => globalThis.explorer.system.run);
  await traced(page);
  const [shell, inPythonToo] = await lines(page);
  const [solve, trace] = shell.split("\n");
  writeFileSync(join(folder, "ball.slip"), await page.inputValue("#editor"));
  const native = JSON.parse(run(solve, "--format", "json"));
  const own = await page.evaluate(() => globalThis.explorer.system.run);
  assert.equal(native.events.length, own.events.length);
  native.events.forEach((event, index) =>
    assert.ok(Math.abs(event.time - own.events[index].time) < 1e-9, solve),
  );
  run(trace);
  const atlas = JSON.parse(readFileSync(join(folder, "atlas.json"), "utf8"));
  assert.equal(
    atlas.regions.length,
    await page.evaluate(() => globalThis.explorer.plane.atlas.regions.length),
    trace,
  );
  if (python) {
    const [events, regions] = inPython(inPythonToo, "[len(found.events), len(atlas.regions)]");
    assert.deepEqual([events, regions], [own.events.length, atlas.regions.length], inPythonToo);
  }
  assert.deepEqual(said, []);
  await close();
});
