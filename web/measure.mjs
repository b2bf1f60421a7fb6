// How long the page takes, which hangs on the machine:
//
//   PAGE=target/explorer.html node measure.mjs

import { launch, mapped } from "./tests/browser.mjs";

const OPENINGS = 15;
const drawn = () => performance.getEntriesByName("first contact")[0]?.startTime;

/** A new browser with the page, and when its first contact was drawn. */
async function opened() {
  const browser = await launch();
  const { page } = await browser.open();
  await page.waitForFunction(drawn);
  return { browser, page, first: await page.evaluate(drawn) };
}

const openings = [];
for (let opening = 1; opening < OPENINGS; opening++) {
  const { browser, first } = await opened();
  openings.push(first);
  await browser.close();
}
const { browser, page, first } = await opened();
openings.push(first);
openings.sort((one, other) => one - other);
await mapped(page);
const { frame, worker, map } = await page.evaluate(async () => {
  const { store, contact, plane } = globalThis.explorer;
  const work = [];
  for (let step = 0; step < 60; step++) {
    store.change({ point: [20 + step / 2, 0.5] });
    await new Promise((resolve) => requestAnimationFrame(resolve));
    await new Promise((resolve) => setTimeout(resolve, 15));
    work.push(contact.times);
  }
  const middle = (of) => work.map(of).sort((one, other) => one - other)[30];
  const map = plane.mapping.took;
  return { frame: middle((it) => it.frame), worker: middle((it) => it.worker), map };
});
const places = [0, OPENINGS >> 1, OPENINGS - 1];
const [least, median, most] = places.map((at) => Math.round(openings[at]));
console.log(`first contact drawn after ${median} ms (${least} to ${most})`);
console.log(`map ${Math.round(map)} ms`);
console.log(`script of a frame ${frame.toFixed(1)} ms, worker ${worker.toFixed(1)} ms`);
await browser.close();
