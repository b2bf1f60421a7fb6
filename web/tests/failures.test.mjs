// What would make the page fail: changes while it computes, huge numbers, damaged links, keys.

import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { downloaded, launch, mapped, settled, traced } from "./browser.mjs";

/** A window of a ball that is soon traced. */
const BALL = `tab=system&example=ball&across=e&up=g&most=6&${new URLSearchParams({
  sx: '{"low":0.3,"high":0.7,"log":false}',
  sy: '{"low":5,"high":15,"log":false}',
})}`;
/** A page with a small map. */
const SMALL = { width: 360, height: 740 };
const change = (page, patch) =>
  page.evaluate((patch) => globalThis.explorer.store.change(patch), patch);
const query = (fields) => String(new URLSearchParams(fields));

let browser;
before(async () => {
  browser = await launch();
});
after(() => browser.close());

/** A test of one page, which must say nothing on the console. */
function ofPage(name, fragment, act, options) {
  test(name, async () => {
    const { page, said, close } = await browser.open(fragment, options);
    await act(page);
    assert.deepEqual(said, []);
    await close();
  });
}

ofPage("lines to copy follow the window", "", async (page) => {
  await settled(page);
  await change(page, { x: { low: 3, high: 50, log: true } });
  await page.waitForFunction(() =>
    document.querySelector("#lines").textContent.includes("--kappa 3:50 "),
  );
});

ofPage("a button of the lines keeps the focus", "", async (page) => {
  await page.waitForSelector("#lines button");
  await traced(page);
  await page.waitForTimeout(200);
  await page.focus("#lines button");
  await change(page, { quantity: "count" });
  await page.waitForTimeout(300);
  assert.equal(await page.evaluate(() => document.activeElement.textContent), "Copy");
});

test("what fails to be drawn does not stop the page", async () => {
  const { page, said, close } = await browser.open();
  await settled(page);
  await page.evaluate(() => {
    const { contact, store } = globalThis.explorer;
    Object.defineProperty(contact, "chart", { get: () => ({}), set: () => {}, configurable: true });
    store.change({ point: [20, 0.5] });
  });
  await settled(page);
  await page.waitForTimeout(100);
  assert.ok(said.length > 0);
  await page.evaluate(() => {
    const { contact, store } = globalThis.explorer;
    delete contact.chart;
    store.change({ point: [30, 0.5] });
  });
  await page.waitForFunction(() => document.querySelector("#point-x").value === "30");
  await close();
});

for (const [name, fragment] of [
  ["axes", query({ x: '{"low":1e17,"high":1.00000000000001e17,"log":false}' })],
  ["a run", query({ tab: "system", text: "state x = 1e17\nx' = 10\nend = 30" })],
])
  ofPage(`${name} of huge numbers with a small span are drawn`, fragment, async (page) => {
    await page.waitForFunction(() => {
      const { contact, system } = globalThis.explorer;
      return contact.contact || system.chart || document.querySelector("#facts .error");
    });
    // A page that hangs answers no more.
    await page.evaluate(() => new Promise((done) => setTimeout(done, 50)));
  });

ofPage(
  "values beyond single precision have colours",
  query({
    tab: "system",
    text: `parameter a = 2 in 1:9
parameter b = 1 in 1:2
state x = 0
x' = a*b*1e38
end = 1`,
    across: "a",
    up: "b",
    sx: '{"low":1,"high":9,"log":false}',
    sy: '{"low":1,"high":2,"log":false}',
    colour: "v1",
    boundaries: "false",
  }),
  async (page) => {
    await mapped(page);
    const [legend, inf] = await page.evaluate(() => {
      const { legend, data } = globalThis.explorer.plane.mapping;
      return [legend.range, data.map.values.some((it) => it === Infinity)];
    });
    assert.ok(inf && legend.every(Number.isFinite), JSON.stringify([legend, inf]));
  },
  SMALL,
);

ofPage("a plane that is refused shows no map of another one", "", async (page) => {
  await mapped(page);
  await change(page, { mu: 0 });
  await page.waitForFunction(() =>
    /no whole map: mu = 0.*expected/.test(document.querySelector("#status").textContent),
  );
  assert.equal(
    await page.evaluate(() => {
      const { plane, store } = globalThis.explorer;
      return plane.mapping.place(store.state.x, store.state.y);
    }),
    undefined,
  );
  await page.click('[data-write="plane-csv"]');
  await page.waitForFunction(() =>
    /map.csv: not computed/.test(document.querySelector("#toast").textContent),
  );
  // Nor are there spheres of another contact.
  const drawn = await page.evaluate(() => {
    const canvas = document.querySelector("#spheres");
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    return data.some((it) => it !== 0);
  });
  assert.equal(drawn, false);
});

ofPage("a file of an atlas is of the window that is shown", "", async (page) => {
  await traced(page);
  await change(page, { boundaries: false });
  await change(page, { damping: 0.2 });
  await page.click('[data-write="plane-json"]');
  await page.waitForFunction(() =>
    /atlas.json: not computed/.test(document.querySelector("#toast").textContent),
  );
});

ofPage("a map of coarse points lists each point once, at its place", BALL, async (page) => {
  await mapped(page);
  const { bytes } = await downloaded(page, '[data-write="plane-csv"]');
  const rows = String(bytes)
    .trim()
    .split("\n")
    .slice(1)
    .map((line) => line.split(",").map(Number));
  const [width, height] = await page.evaluate(() => globalThis.explorer.plane.mapping.data.size);
  assert.equal(rows.length, Math.ceil(width / 2) * Math.ceil(height / 2));
  // At their own places, runs have these numbers of events.
  for (const row of [rows[0], rows[rows.length >> 1], rows.at(-1)]) {
    const count = await page.evaluate(async ([e, g]) => {
      const { system, crew } = globalThis.explorer;
      const { state } = globalThis.explorer.store;
      const axis = (low) => ({ low, high: low * (1 + 1e-12), log: false });
      const scene = { ...system.scene(state, system.parsed.text), x: axis(e), y: axis(g) };
      const task = { task: "map", scene, columns: 1, rows: 1, first: 0, end: 1 };
      return (await crew.hands[0].do(task)).answer.counts[0];
    }, row);
    assert.equal(row[2], count, String(row));
  }
}, SMALL);

ofPage("what is told of a place is of the present window", "", async (page) => {
  await traced(page);
  await mapped(page);
  const box = await page.locator("#plane").boundingBox();
  const index = await page.evaluate(
    ([x, y]) => globalThis.explorer.plane.mapping.at(x, y),
    [10, 0.5],
  );
  assert.ok(index > 0);
  const during = await page.evaluate(() => {
    const { store, plane } = globalThis.explorer;
    store.change({ damping: 0.1 });
    return new Promise((done) =>
      requestAnimationFrame(() => done(plane.mapping.ready || plane.mapping.at(10, 0.5))),
    );
  });
  assert.equal(during, undefined);
  // Paths of the old boundaries are not those of the new ones, be they as many.
  await traced(page);
  await page.mouse.move(box.x + 300, box.y + 30);
  const paths = await page.evaluate(() => {
    const { plane } = globalThis.explorer;
    plane.regionAt(300, 30);
    const before = plane.paths;
    plane.atlas = structuredClone(plane.atlas);
    plane.regionAt(300, 30);
    return before !== plane.paths;
  });
  assert.ok(paths);
});

ofPage(
  "dragging a slow system computes its newest run, not all of them",
  query({
    tab: "system",
    text: "parameter k = 1 in 1:9\nstate x = 1\nx' = sin(200*k*t)*x\nend = 100",
    boundaries: "false",
  }),
  async (page) => {
    await page.waitForFunction(() => globalThis.explorer.system.run);
    const asked = await page.evaluate(async () => {
      const { system, store } = globalThis.explorer;
      let asked = 0;
      const { hand } = system;
      const { do: usual } = hand;
      hand.do = function (...given) {
        asked += 1;
        return usual.apply(this, given);
      };
      for (let step = 1; step <= 60; step++) {
        store.change({ set: { k: 1 + step / 1000 } });
        await new Promise((done) => requestAnimationFrame(done));
      }
      while (hand.busy) await new Promise((done) => setTimeout(done, 20));
      return [asked, hand.restarts, system.runKey];
    });
    // One is computed, and one waits: others are left out.
    assert.ok(asked[0] < 55 && asked[1] === 0, JSON.stringify(asked));
    assert.match(asked[2], /"k":1.06/);
  },
);

ofPage("mistyped numbers are put back", "preset=figure2", async (page) => {
  const back = async (selector, words, value) => {
    await page.fill(selector, words);
    await page.press(selector, "Enter");
    assert.equal(await page.inputValue(selector), value, selector);
  };
  await settled(page);
  await back("#radius_m", "abc", "0.02");
  await page.check("#other");
  await back("#other-radius_m", "1e999", "0.02");
  await page.selectOption("#axes", "axis-ratio");
  await back("#alpha", "7/0", "2/7");
  await back("#alpha", "/5", "2/7");
  await page.click("summary:has-text('Window and point')");
  await back("#x-high", "NaN", "20");
  await back("#x-low", "1e400", "0");
  await back("#point-x", "−3", "18");
  await page.click("#tab-system");
  await page.waitForFunction(() => globalThis.explorer.system.run);
  await back("#most", "0x", "12");
  await back("#most", "1e9", "200");
  await back("#end", "soon", "");
  await back('#sliders [data-parameter="belt"][type="text"]', "Infinity", "0.5");
});

ofPage("an axis without values above 0 cannot be logarithmic", BALL, async (page) => {
  await mapped(page);
  await change(page, { sx: { low: -2, high: -1, log: false } });
  await page.click("summary:has-text('Window and point')");
  await page.locator("#x-log").click();
  assert.equal(await page.isChecked("#x-log"), false);
}, SMALL);

ofPage(
  "links have no commands of others in them",
  query({
    tab: "system",
    law: "paper; rm -rf ~",
    example: "$(reboot)",
    across: "belt;reboot",
    up: "constructor",
    set: '{"kinetic=1; reboot":1}',
    most: "-3",
    quantity: "toString",
    colour: "v9",
  }),
  async (page) => {
    await page.waitForFunction(() => globalThis.explorer.system.run);
    const state = await page.evaluate(() => globalThis.explorer.store.state);
    assert.deepEqual(
      [state.law, state.example, state.across, state.set, state.most, state.quantity, state.colour],
      ["paper", "belt", "belt", {}, 12, "eps_t", "count"],
    );
    await page.waitForSelector("#lines pre");
    assert.ok(!/reboot|rm -rf/.test(await page.textContent("#lines")));
  },
);

ofPage(
  "a parameter may have any name",
  query({
    tab: "system",
    text: `parameter constructor = 2 in 1:3
parameter valueOf = 1 in 1:2
state x = 1
x' = constructor - valueOf
end = 1`,
    boundaries: "false",
  }),
  async (page) => {
    await page.waitForFunction(() => globalThis.explorer.system.run);
    assert.equal(await page.inputValue("#point-x"), "2");
    await mapped(page);
  },
  SMALL,
);

ofPage("a point is dragged in a narrow window too", "", async (page) => {
  await settled(page);
  await change(page, {
    x: { low: 63, high: 63.0003, log: true },
    y: { low: 0.5, high: 0.500002, log: false },
    boundaries: false,
  });
  await mapped(page);
  const box = await page.locator("#plane").boundingBox();
  await page.mouse.click(box.x + 0.6 * box.width, box.y + 0.4 * box.height);
  await settled(page);
  const { left, top } = await page.locator("#point").evaluate((point) => {
    const { left, top, width, height } = point.getBoundingClientRect();
    return { left: left + width / 2, top: top + height / 2 };
  });
  assert.ok(Math.abs(left - box.x - 0.6 * box.width) < 2, String([left, box.x, box.width]));
  assert.ok(Math.abs(top - box.y - 0.4 * box.height) < 2, String([top, box.y, box.height]));
});

ofPage("Space opens what has the focus, and keys wait for the help", "", async (page) => {
  await settled(page);
  const open = () => page.evaluate(() => document.querySelector("details").open);
  await page.focus("#left summary");
  await page.keyboard.press(" ");
  assert.equal(await open(), true);
  assert.equal(await page.textContent("#play"), "Play");
  await page.focus("#plane");
  await page.keyboard.press(" ");
  assert.equal(await page.textContent("#play"), "Pause");
  await page.keyboard.press(" ");
  await page.keyboard.press("?");
  await page.keyboard.press("b");
  await page.keyboard.press("t");
  assert.equal(await page.isChecked("#boundaries"), true);
  assert.equal(await page.locator("#tour").evaluate((it) => it.open), false);
  await page.keyboard.press("Escape");
  await page.keyboard.press("b");
  await page.waitForSelector("#boundaries:not(:checked)");
});

ofPage("the whole page is passed by Tab", "", async (page) => {
  await settled(page);
  const seen = new Set();
  for (let step = 0; step < 120; step++) {
    await page.keyboard.press("Tab");
    const at = await page.evaluate(() => {
      const all = [...document.querySelectorAll("*")];
      return document.activeElement === document.body ? -1 : all.indexOf(document.activeElement);
    });
    if (at === -1 || seen.has(at)) break;
    seen.add(at);
  }
  const missed = await page.evaluate((seen) => {
    const all = [...document.querySelectorAll("*")];
    return all
      .filter((it) => it.matches("button, select, canvas[tabindex], #lines button"))
      .filter((it) => it.checkVisibility() && it.tabIndex >= 0 && !it.disabled)
      .filter((it) => !seen.includes(all.indexOf(it)))
      .map((it) => it.outerHTML);
  }, [...seen]);
  assert.deepEqual(missed, []);
});

ofPage("undo takes the preset along, and Home the point into its axes", "", async (page) => {
  await settled(page);
  await page.waitForTimeout(600);
  await page.selectOption("#preset", "figure4");
  await page.click("#undo");
  await page.waitForFunction(() => document.querySelector("#preset").value === "plane");
  assert.match(await page.textContent("#caption"), /boundaries on which/);
  await page.selectOption("#axes", "velocities");
  await page.click("#home");
  await settled(page);
  const { axes, point } = await page.evaluate(() => globalThis.explorer.store.state);
  assert.deepEqual([axes, point], ["kappa-psi", [63, 0.5]]);
});

ofPage("a text that is typed is not lost to what is pressed next", BALL, async (page) => {
  await page.waitForFunction(() => globalThis.explorer.system.run);
  const text = await page.inputValue("#editor");
  await page.focus("#editor");
  await page.keyboard.press("Control+Home");
  await page.keyboard.insertText("# mine\n");
  await page.click("#tidy");
  await page.waitForTimeout(600);
  assert.ok((await page.inputValue("#editor")).startsWith("# mine\n"));
  await page.selectOption("#example", "belt");
  await page.waitForTimeout(400);
  const state = await page.evaluate(() => globalThis.explorer.store.state);
  assert.deepEqual([state.example, state.text], ["belt", null]);
  assert.notEqual(await page.inputValue("#editor"), text);
});

ofPage("memory does not grow while a point is dragged", "", async (page) => {
  await mapped(page);
  await traced(page);
  const tools = await page.context().newCDPSession(page);
  const used = async () => {
    await tools.send("HeapProfiler.collectGarbage");
    return (await tools.send("Runtime.getHeapUsage")).usedSize / 1e6;
  };
  const drag = (steps) =>
    page.evaluate(async (steps) => {
      for (let step = 0; step < steps; step++) {
        const angle = step / 20;
        const point = [30 + 20 * Math.sin(angle), 0.5 + 0.3 * Math.cos(angle)];
        globalThis.explorer.store.change({ point });
        await new Promise((done) => requestAnimationFrame(done));
      }
    }, steps);
  await drag(150);
  const before = await used();
  await drag(300);
  const growth = (await used()) - before;
  assert.ok(growth < 2, `${growth} MB`);
});

ofPage(
  "a long word of a mistake is in 360 px",
  query({ tab: "system", text: `state x = 1\nx' = ${"long_".repeat(20)}` }),
  async (page) => {
    await page.waitForSelector("#problem:not([hidden])");
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
  },
  SMALL,
);
