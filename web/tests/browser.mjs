// Chromium with the page, opened from the disk. With SLOW=4 its scripts take four times as long.

import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

export const PAGE =
  process.env.PAGE ?? fileURLToPath(new URL("../../crates/page/explorer.html", import.meta.url));

/** A browser; its pages collect what they say, which should be nothing. */
export async function launch() {
  const args = [
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-sync",
    "--disable-background-networking",
    "--disable-component-update",
  ];
  const browser = await chromium.launch({
    executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium",
    args,
  });
  return {
    close: () => browser.close(),
    /** Opens the page at a fragment. */
    async open(fragment = "", options = {}) {
      const opened = await this.openFile(PAGE, fragment, options);
      await opened.page.waitForSelector("body.ready");
      return opened;
    },
    /** Opens another page. */
    async openFile(file, fragment = "", { width = 1300, height = 900, scheme = "light" } = {}) {
      const context = await browser.newContext({
        viewport: { width, height },
        colorScheme: scheme,
        acceptDownloads: true,
      });
      const page = await context.newPage();
      if (process.env.SLOW) {
        const tools = await context.newCDPSession(page);
        await tools.send("Emulation.setCPUThrottlingRate", { rate: Number(process.env.SLOW) });
      }
      const said = [];
      page.on("console", (message) => said.push(message.text()));
      page.on("pageerror", (error) => said.push(error.message));
      page.on("request", (request) => {
        if (!/^(file|blob|data):/.test(request.url())) said.push(`request of ${request.url()}`);
      });
      await page.goto(`file://${file}${fragment ? `#${fragment}` : ""}`);
      return { page, said, close: () => context.close() };
    },
  };
}

/** Waits until the contact of the present state is shown. */
export const settled = (page) =>
  page.waitForFunction(() => {
    const { contact, store } = globalThis.explorer;
    const shown = contact.contact?.document.parameters;
    if (!shown) return false;
    const { axes, point } = store.state;
    return axes !== "kappa-psi" || (shown.kappa === point[0] && shown.psi === point[1]);
  });

/** Waits until the boundaries of the present window are traced. */
export const traced = (page) =>
  page.waitForFunction(
    () => / traced in | no boundaries/.test(document.querySelector("#status").textContent),
    undefined,
    { timeout: 60_000 },
  );

/** Waits until the map is there in its finest form. */
export const mapped = (page) =>
  page.waitForFunction(() => globalThis.explorer.plane.mapping.ready, undefined, {
    timeout: 60_000,
  });

/** Clicks, and returns the text of the file that comes. */
export async function downloaded(page, selector) {
  const [download] = await Promise.all([page.waitForEvent("download"), page.click(selector)]);
  const stream = await download.createReadStream();
  const chunks = [];
  for await (const chunk of stream) chunks.push(chunk);
  return { name: download.suggestedFilename(), bytes: Buffer.concat(chunks) };
}
