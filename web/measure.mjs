// How long the page takes, which hangs on the machine:
//
//   PAGE=target/explorer.html node measure.mjs

import { launch, mapped, settled } from "./tests/browser.mjs";

const browser = await launch();
const { page } = await browser.open();
await settled(page);
const first = await page.evaluate(
  () => performance.getEntriesByName("first contact")[0].startTime,
);
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
console.log(`first contact drawn after ${Math.round(first)} ms, map ${Math.round(map)} ms`);
console.log(`script of a frame ${frame.toFixed(1)} ms, worker ${worker.toFixed(1)} ms`);
await browser.close();
