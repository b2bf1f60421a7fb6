// Records the moving picture of the README: a point that is dragged over the plane.
//
//   node record.mjs [FILE.gif]
//
// It needs Chromium, and a Python with Pillow (PYTHON=), which puts the pictures together.

import { execFileSync } from "node:child_process";
import { mkdtempSync, rmSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { fileURLToPath } from "node:url";
import { launch, mapped, settled, traced } from "./tests/browser.mjs";

const pictures = fileURLToPath(new URL("../docs/pictures/", import.meta.url));
const target = process.argv[2] ?? join(pictures, "explorer.gif");
const FRAMES = 30;

const folder = mkdtempSync(join(tmpdir(), "record-"));
const browser = await launch();
const { page } = await browser.open("", { width: 1120, height: 690 });
await traced(page);
await mapped(page);
await page.locator("main").evaluate((it) => it.scrollIntoView());
const files = [];
for (let frame = 0; frame < FRAMES; frame++) {
  const turn = (2 * Math.PI * frame) / FRAMES;
  const point = [
    Number((25 * Math.exp(0.9 * Math.cos(turn))).toPrecision(4)),
    Number((0.75 + 0.5 * Math.sin(turn)).toPrecision(4)),
  ];
  await page.evaluate((point) => globalThis.explorer.store.change({ point }), point);
  await settled(page);
  await page.waitForTimeout(80);
  files.push(join(folder, `${frame}.png`));
  await page.screenshot({ path: files.at(-1) });
}
await browser.close();
const gif = `
import sys
from PIL import Image
*files, target = sys.argv[1:]
size = (800, 493)
frames = [Image.open(file).convert("RGB").resize(size, Image.LANCZOS) for file in files]
# One palette for all, so that what does not move stays as it is.
palette = frames[0].quantize(64, dither=Image.Dither.NONE)
frames = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
frames[0].save(target, save_all=True, append_images=frames[1:], duration=120, loop=0, optimize=True)
`;
execFileSync(process.env.PYTHON ?? "python3", ["-c", gif, ...files, target], { stdio: "inherit" });
rmSync(folder, { recursive: true });
