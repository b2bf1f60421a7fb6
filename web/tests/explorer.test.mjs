// The page in a browser: its numbers against those of the native program, and all that one can do.

import assert from "node:assert/strict";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";
import { after, before, test } from "node:test";
import { PAGE, downloaded, launch, mapped, settled, traced } from "./browser.mjs";

const data = (name) => JSON.parse(readFileSync(new URL(`data/${name}`, import.meta.url), "utf8"));

/** A window of a ball that is soon traced. */
const BALL = `tab=system&example=ball&across=e&up=g&most=6&${new URLSearchParams({
  sx: '{"low":0.3,"high":0.7,"log":false}',
  sy: '{"low":5,"high":15,"log":false}',
})}`;

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

ofPage("500 contacts are those of the native program", "", async (page) => {
  const contacts = data("contacts.json");
  assert.equal(contacts.length, 500);
  const found = await page.evaluate(async (contacts) => {
    const axis = { low: 1, high: 2, log: false };
    const answers = [];
    for (const { kappa, psi, law, damping } of contacts) {
      const scene = {
        kind: "spheres",
        axes: "kappa-psi",
        x: axis,
        y: axis,
        law,
        damping,
        tangential_damping: 0,
        mu: 0.4,
        alpha: 2 / 7,
      };
      const { answer } = await globalThis.explorer.hand.do({
        task: "contact",
        scene,
        x: kappa,
        y: psi,
        intervals: 10,
      });
      answers.push(answer.document ?? answer);
    }
    return answers;
  }, contacts);
  contacts.forEach((native, index) => {
    const own = found[index];
    const what = JSON.stringify({ native, own });
    assert.equal(own.itinerary, native.itinerary, what);
    const most = native.law === "paper" ? 1e-12 : 1e-11;
    for (const key of ["eps_t", "eps_n", "contact_time"])
      assert.ok(Math.abs(own[key] - native[key]) < most, `${key} ${what}`);
  });
});

ofPage("the regions of ten windows are those of the native program", "", async (page) => {
  for (const { kappa, psi, damping, boundaries, regions } of data("atlases.json")) {
    const atlas = await page.evaluate(
      async ({ kappa, psi, damping }) => {
        const axis = ([low, high]) => ({ low, high, log: true });
        const scene = {
          kind: "spheres",
          axes: "kappa-psi",
          x: axis(kappa),
          y: axis(psi),
          law: "paper",
          damping,
          tangential_damping: 0,
          mu: 0.4,
          alpha: 2 / 7,
        };
        return (await globalThis.explorer.hand.do({ task: "ask", scene, request: { do: "atlas" } }))
          .answer;
      },
      { kappa, psi, damping },
    );
    const what = JSON.stringify({ kappa, psi, damping, objection: atlas.objection });
    assert.deepEqual(atlas.regions.map((it) => it.itinerary).sort(), regions, what);
    assert.equal(atlas.boundaries.length, boundaries, what);
    assert.ok(atlas.agrees, what);
  }
});

ofPage("a dragged point shows its contact, and the link follows", "", async (page) => {
  await settled(page);
  const box = await page.locator("#plane").boundingBox();
  await page.mouse.move(box.x + 200, box.y + 200);
  await page.mouse.down();
  for (let step = 0; step <= 20; step++)
    await page.mouse.move(box.x + 200 + 10 * step, box.y + 200 + 5 * step);
  await page.mouse.up();
  await settled(page);
  const [kappa, psi] = await page.evaluate(() => globalThis.explorer.store.state.point);
  assert.ok(kappa > 5 && kappa < 60 && psi > 0.5 && psi < 1.6, `${kappa} ${psi}`);
  await page.waitForFunction((kappa) => location.hash.includes(String(kappa)), kappa);
  await page.waitForFunction(
    ([kappa, psi]) =>
      document
        .querySelector("#lines")
        .textContent.includes(`--kappa ${kappa} --psi ${psi} --method auto`),
    [kappa, psi],
  );
  assert.match(await page.textContent("#facts"), /itinerary/);
});

ofPage("wheel, Shift and keys change the window, and undo goes back", "", async (page) => {
  await traced(page);
  const window = () => page.evaluate(() => globalThis.explorer.store.state.x);
  const first = await window();
  const box = await page.locator("#plane").boundingBox();
  await page.mouse.move(box.x + 300, box.y + 250);
  await page.mouse.wheel(0, -400);
  await page.waitForFunction((low) => globalThis.explorer.store.state.x.low > low, first.low);
  await traced(page);
  await mapped(page);
  const zoomed = await window();
  assert.ok(zoomed.high < first.high && zoomed.low > first.low);
  await page.keyboard.down("Shift");
  await page.mouse.down();
  await page.mouse.move(box.x + 340, box.y + 250, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  const moved = await window();
  assert.ok(
    moved.low < zoomed.low &&
      Math.abs(Math.log(moved.high / moved.low) - Math.log(zoomed.high / zoomed.low)) < 0.01,
  );
  await page.waitForTimeout(600);
  await page.evaluate(() => globalThis.explorer.store.change({ point: [20, 0.8] }));
  await page.waitForTimeout(600);
  await page.focus("#plane");
  const point = await page.evaluate(() => globalThis.explorer.store.state.point);
  await page.keyboard.press("ArrowRight");
  await page.waitForFunction((at) => globalThis.explorer.store.state.point[0] > at, point[0]);
  await page.keyboard.press("+");
  assert.ok((await window()).high < moved.high);
  for (let step = 0; step < 8; step++) await page.keyboard.press("Control+z");
  assert.deepEqual(await window(), first);
});

ofPage("arrows move between the tabs", "", async (page) => {
  await page.focus("#tab-spheres");
  for (const [key, id] of [
    ["ArrowRight", "tab-system"],
    ["ArrowRight", "tab-spheres"],
    ["ArrowLeft", "tab-system"],
    ["Home", "tab-spheres"],
    ["End", "tab-system"],
  ]) {
    await page.keyboard.press(key);
    await page.waitForFunction((it) => document.activeElement?.id === it, id);
    // The controls follow with the next frame.
    await page.waitForSelector(`#${id}[aria-selected="true"]`);
    assert.equal(await page.locator('[role="tab"][aria-selected="true"]').count(), 1);
    assert.equal(await page.locator('[role="tab"][tabindex="0"]').count(), 1);
  }
});

ofPage("two fingers zoom", "", async (page) => {
  await mapped(page);
  const low = await page.evaluate(() => {
    const canvas = document.querySelector("#plane");
    const box = canvas.getBoundingClientRect();
    canvas.setPointerCapture = () => {};
    const send = (type, pointerId, x) =>
      canvas.dispatchEvent(
        new PointerEvent(type, {
          pointerId,
          clientX: box.left + x,
          clientY: box.top + 200,
          button: 0,
          pointerType: "touch",
          bubbles: true,
        }),
      );
    send("pointerdown", 1, 200);
    send("pointerdown", 2, 300);
    send("pointermove", 2, 400);
    send("pointerup", 1, 200);
    send("pointerup", 2, 400);
    return globalThis.explorer.store.state.x.low;
  });
  assert.ok(low > 1.5, String(low));
});

ofPage("numbers are typed, and mistakes are not taken", "", async (page) => {
  await page.click("summary:has-text('Window and point')");
  await page.fill("#x-low", "5");
  await page.press("#x-low", "Enter");
  await page.fill("#y-high", "abc");
  await page.press("#y-high", "Enter");
  await page.fill("#point-y", "2/7");
  await page.press("#point-y", "Enter");
  const { x, y, point } = await page.evaluate(() => globalThis.explorer.store.state);
  assert.deepEqual([x.low, y.high, point[1]], [5, 2.2, 2 / 7]);
  assert.equal(await page.inputValue("#y-high"), "2.2");
});

ofPage("the region under the pointer is told", "", async (page) => {
  await traced(page);
  const box = await page.locator("#plane").boundingBox();
  await page.mouse.move(box.x + 300, box.y + 30);
  await page.waitForFunction(() => / · \+ · /.test(document.querySelector("#told").textContent));
});

ofPage("every file can be read", "", async (page) => {
  await settled(page);
  await traced(page);
  await mapped(page);
  const file = async (what) => (await downloaded(page, `[data-write="${what}"]`)).bytes;
  for (const what of ["course-svg", "plane-svg"]) {
    const text = String(await file(what));
    const problem = await page.evaluate(
      (text) =>
        new DOMParser().parseFromString(text, "image/svg+xml").querySelector("parsererror")
          ?.textContent,
      text,
    );
    assert.equal(problem, undefined, what);
    assert.ok(text.startsWith("<svg") && text.includes("<path"), what);
  }
  for (const what of ["course-png", "plane-png"])
    assert.equal((await file(what)).subarray(1, 4).toString(), "PNG", what);
  const course = String(await file("course-csv"))
    .trim()
    .split("\n");
  assert.equal(
    course[0],
    "time,compression,normal_velocity,normal_force,spring,tangential_force,velocity,sliding,limit",
  );
  assert.equal(course.length, 1 + 1001 + 6);
  assert.ok(
    course
      .slice(1)
      .every(
        (line) =>
          line.split(",").length === 9 &&
          line.split(",").every((it) => Number.isFinite(Number(it))),
      ),
  );
  assert.equal(
    String(await file("events-csv"))
      .trim()
      .split("\n").length,
    7,
  );
  const found = JSON.parse(await file("course-json"));
  assert.deepEqual([found.schema, found.itinerary], ["stickslip.collision/1", "+o-o+o-"]);
  const map = String(await file("plane-csv"))
    .trim()
    .split("\n");
  assert.match(map[0], /^κ,ψ,count,eps_t,contact_time,energy_lost,eps_n$/);
  const [width, height] = await page.evaluate(() => globalThis.explorer.plane.mapping.data.size);
  assert.equal(map.length, 1 + width * height);
  assert.equal(JSON.parse(await file("plane-json")).regions.length, 31);
});

ofPage("every file of a system can be read", BALL, async (page) => {
  await page.waitForFunction(() => globalThis.explorer.system.run);
  await mapped(page);
  await traced(page);
  const file = async (what) => (await downloaded(page, `[data-write="${what}"]`)).bytes;
  for (const what of ["course-svg", "plane-svg"])
    assert.match(String(await file(what)), /^<svg[^]*<path[^]*<\/svg>\s*$/, what);
  for (const what of ["course-png", "plane-png"])
    assert.equal((await file(what)).subarray(1, 4).toString(), "PNG", what);
  const rows = async (what) =>
    String(await file(what))
      .trim()
      .split("\n")
      .map((line) => line.split(","));
  const run = JSON.parse(await file("course-json"));
  const [course, events, map] = [
    await rows("course-csv"),
    await rows("events-csv"),
    await rows("plane-csv"),
  ];
  assert.equal(course[0][0], "time");
  assert.equal(course.length, 1 + run.course.length);
  assert.equal(events.length, 1 + run.events.length);
  for (const table of [course, events, map])
    assert.ok(table.every((row) => row.length === table[0].length));
  const atlas = JSON.parse(await file("plane-json"));
  assert.deepEqual(atlas.axes, map[0].slice(0, 2));
  assert.ok(atlas.regions.length > 1);
});

test("bodies that adhere may stay together", async () => {
  const { page, said, close } = await browser.open();
  assert.equal(await page.isVisible("#pull"), false);
  const adhere = (damping) =>
    page.evaluate((damping) => {
      const law = "granular/dmt/viscoelastic/mindlin";
      globalThis.explorer.store.change({ law, damping, pull_off: 0.5, boundaries: false });
    }, damping);
  await adhere(0);
  await page.waitForFunction(
    () => globalThis.explorer.contact.contact?.document.parameters.law?.pull_off === 0.5,
  );
  assert.equal(await page.isVisible("#pull"), true);
  await adhere(2);
  await page.waitForFunction(() => /stay together/.test(document.querySelector("#facts").textContent));
  assert.deepEqual(said, []);
  await close();
});

test("a link leads to the same view", async () => {
  const first = await browser.open("preset=figure4");
  await first.page.evaluate(() => {
    const { store } = globalThis.explorer;
    store.change({
      damping: 0.05,
      law: "mfix/LSD",
      quantity: "lost",
      point: [7.5, 0.321],
      boundaries: false,
      x: { low: 2, high: 10, log: true },
    });
    store.change({
      pinned: {
        axes: "axis-ratio",
        point: [3, 1],
        law: "paper",
        damping: 0.2,
        tangential: 0,
        dynamic: 0.5,
        decay: 2,
        pull_off: 0.3,
        mu: 0.3,
        alpha: 0.25,
        bodies: store.state.bodies,
      },
    });
  });
  await first.page.waitForFunction(() => location.hash.includes("pinned"));
  const hash = await first.page.evaluate(() => location.hash.slice(1));
  assert.ok(!hash.includes("alpha=") && hash.includes("damping=0.05"), hash);
  const state = await first.page.evaluate(() => globalThis.explorer.store.state);
  const second = await browser.open(hash);
  assert.deepEqual(await second.page.evaluate(() => globalThis.explorer.store.state), state);
  await second.page.waitForSelector(".facts .pinned");
  // Links of before had one coefficient of friction, and no adhesion.
  const older = hash.replace("%22dynamic%22%3A0.5%2C%22decay%22%3A2%2C%22pull_off%22%3A0.3%2C", "");
  assert.notEqual(older, hash);
  const third = await browser.open(older);
  const pinned = await third.page.evaluate(() => globalThis.explorer.store.state.pinned);
  const { dynamic, decay, pull_off, damping } = pinned;
  assert.deepEqual([dynamic, decay, pull_off, damping], [1, 0, 0.1, 0.2]);
  await third.close();
  assert.deepEqual([...first.said, ...second.said, ...third.said], []);
  await first.close();
  await second.close();
});

ofPage(
  "a broken link is no harm",
  "preset=nothing&x=%7B&point=%5B1%5D&damping=null&law=nonsense",
  async (page) => {
    await page.waitForSelector("#facts .error");
    assert.match(await page.textContent("#facts"), /no law is called nonsense/);
    await page.selectOption("#preset", "plane");
    await page.waitForSelector("table.facts");
  },
);

ofPage(
  "what a link cannot mean is left out",
  `tab=none&axes=toString&mu=%22a%22&${new URLSearchParams({
    x: '{"low":5,"high":2,"log":true}',
    y: '{"low":-1,"high":2,"log":true}',
    point: "[1,null]",
    bodies: '{"other":{}}',
    pinned: '{"axes":"none","point":[1,1],"law":"paper","damping":0}',
    damping: "0.125",
  })}`,
  async (page) => {
    await settled(page);
    const { usual, state } = await page.evaluate(() => {
      const { store } = globalThis.explorer;
      const { state } = store;
      store.change({ damping: 0 });
      return { usual: store.state, state };
    });
    assert.deepEqual(state, { ...usual, damping: 0.125 });
    assert.deepEqual([state.tab, state.axes, state.pinned], ["spheres", "kappa-psi", null]);
    assert.deepEqual([state.x.high, state.bodies.other, state.point], [100, null, [63, 0.5]]);
  },
);

ofPage(
  "an own system is typed, with a mistake that is mended",
  BALL,
  async (page) => {
    await page.waitForFunction(() => globalThis.explorer.system.run?.events.length > 3);
    await traced(page);
    const regions = await page.evaluate(() =>
      globalThis.explorer.plane.atlas.regions.map((it) => it.itinerary).sort(),
    );
    assert.ok(regions.includes("bounce × 3") && regions.length >= 4, JSON.stringify(regions));
    const text = await page.inputValue("#editor");
    await page.fill("#editor", text.replace("v' = -g", "v' = -gg"));
    await page.waitForSelector("#problem:not([hidden])");
    assert.match(
      await page.textContent("#problem"),
      /line \d+, column 7: `gg` is not known; did you mean `g`\?/,
    );
    assert.equal(await page.getAttribute("#editor", "aria-invalid"), "true");
    assert.equal(await page.locator("#gutter .wrong").count(), 1);
    await page.fill("#editor", text.replace("e = 0.5", "e = 0.25"));
    await page.waitForSelector("#problem", { state: "hidden" });
    await page.waitForFunction(() => globalThis.explorer.system.run?.outcome === "accumulation");
    const { events, accumulation } = await page.evaluate(() => globalThis.explorer.system.run);
    // The first bounce is after 1 s, and each flight takes a quarter of the one before.
    assert.ok(
      Math.abs(events[0].time - 1) < 1e-9 && Math.abs(accumulation - 5 / 3) < 1e-6,
      String(accumulation),
    );
    await page.fill('#sliders [data-parameter="e"][type="text"]', "0.5");
    await page.press('#sliders [data-parameter="e"][type="text"]', "Enter");
    await page.waitForFunction(
      () => Math.abs((globalThis.explorer.system.run?.events[1]?.time ?? 0) - 2) < 1e-9,
    );
    await page.waitForFunction(() =>
      document
        .querySelector("#lines")
        .textContent.includes("stickslip run system.slip --set e=0.5"),
    );
    const { name, bytes } = await downloaded(page, '[data-write="text"]');
    assert.deepEqual([name, String(bytes)], ["system.slip", text.replace("e = 0.5", "e = 0.25")]);
  },
);

ofPage("all examples run", "tab=system", async (page) => {
  for (const name of await page.locator("#example option").allTextContents()) {
    await page.selectOption("#example", name);
    await page.waitForFunction((name) => globalThis.explorer.store.state.example === name, name);
    await page.waitForFunction(() => {
      const { system, store } = globalThis.explorer;
      return system.parsed && system.run && (system.shownName = store.state.example);
    });
    assert.equal(await page.locator("#result .error").count(), 0, name);
  }
});

ofPage("a worker that dies is started again, and the map comes", "", async (page) => {
  await settled(page);
  await mapped(page);
  await page.evaluate(() => {
    const { crew, hand } = globalThis.explorer;
    // None knows this task: each ends with an exception.
    [...crew.hands, hand].forEach((it) => void it.do({ task: "none" }));
    globalThis.explorer.store.change({ point: [20, 0.8], x: { low: 2, high: 50, log: true } });
  });
  await settled(page);
  await mapped(page);
  await traced(page);
  const { restarts, holes } = await page.evaluate(() => {
    const { crew, hand, plane } = globalThis.explorer;
    const holes = plane.mapping.data.map.codes.filter((it) => it === 0).length;
    return { restarts: [...crew.hands, hand].map((it) => it.restarts), holes };
  });
  assert.ok(restarts.every((it) => it === 1), String(restarts));
  assert.equal(holes, 0);
  const answer = await page.evaluate(async () => {
    const { hand } = globalThis.explorer;
    return (await hand.do({ task: "none" })).answer;
  });
  assert.match(answer.error, /a worker ended/);
});

ofPage("a task that takes too long is ended", "", async (page) => {
  const answer = await page.evaluate(async () => {
    const text = "state x = 1\nx' = sin(1e5*t)\nend = 1e9";
    return (
      await globalThis.explorer.hand.do(
        { task: "ask", request: { do: "run", text, set: {}, end: null } },
        200,
      )
    ).answer;
  });
  assert.match(answer.error, /longer than 0.2 s|steps/);
});

ofPage("every preset and the tour show something", "", async (page) => {
  for (const id of await page
    .locator("#preset option")
    .evaluateAll((options) => options.map((it) => it.value))) {
    await page.selectOption("#preset", id);
    await page.waitForFunction(() => document.querySelector("table.facts"));
    assert.equal(await page.locator("#facts .error").count(), 0, id);
    assert.ok((await page.textContent("#caption")).length > 30, id);
  }
  await page.click("#start-tour");
  // The view changes beneath the button: a mouse could miss it.
  for (let stop = 2; stop <= 7; stop++) {
    await page.locator("#tour button.primary").press("Enter");
    assert.equal(await page.textContent("#tour .hint"), `${stop} of 7`);
  }
  assert.equal(await page.evaluate(() => document.body.dataset.tab), "system");
  await page.click("#tour button.primary");
  assert.equal(await page.locator("#tour").evaluate((dialog) => dialog.open), false);
});

ofPage("the points of the paper have 0 to 8 switches", "preset=figure4", async (page) => {
  await page.waitForFunction(() => document.querySelectorAll("#letters button").length === 16);
  const counts = [];
  for (let letter = 0; letter < 16; letter++) {
    await page.locator("#letters button").nth(letter).click();
    const ratio = await page.evaluate(() => globalThis.explorer.store.state.point[1]);
    await page.waitForFunction(
      (psi) =>
        Math.abs((globalThis.explorer.contact.contact?.document.parameters.psi ?? 0) / psi - 1) <
        1e-6,
      ratio / 1.4,
    );
    counts.push(
      await page.evaluate(() => globalThis.explorer.contact.contact.document.switch_count),
    );
  }
  assert.deepEqual(counts, [0, 2, 4, 6, 8, 6, 8, 6, 4, 6, 4, 2, 4, 2, 4, 2]);
});

ofPage("velocities of steel spheres", "preset=figure2", async (page) => {
  await page.waitForFunction(() =>
    document.querySelector("#facts")?.textContent.includes("units of time"),
  );
  const { parameters } = await page.evaluate(() => globalThis.explorer.contact.contact.document);
  assert.ok(parameters.kappa > 1000, JSON.stringify(parameters));
});

ofPage(
  "all is in 360 px, in the dark",
  "",
  async (page) => {
    await settled(page);
    const wide = await page.evaluate(() => document.documentElement.scrollWidth);
    assert.equal(wide, 360);
    const dark = await page.evaluate(() => getComputedStyle(document.body).backgroundColor);
    assert.match(dark, /^rgb\((\d|1\d|2\d), /);
    await page.click("#tab-system");
    await page.waitForFunction(() => globalThis.explorer.system.run);
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 360);
  },
  { width: 360, height: 740, scheme: "dark" },
);

ofPage("everything has a name for a screen reader, and the result is told", "", async (page) => {
  await settled(page);
  const nameless = await page.evaluate(() => {
    const named = (it) =>
      it.getAttribute("aria-label") ||
      it.textContent.trim() ||
      it.labels?.[0]?.textContent.trim() ||
      it.title;
    return [...document.querySelectorAll("button, input, select, textarea, canvas, dialog")]
      .filter((it) => !named(it) && !it.closest("[aria-hidden='true']"))
      .map((it) => it.outerHTML);
  });
  assert.deepEqual(nameless, []);
  await page.waitForFunction(() =>
    /6 switches, tangential restitution -0.0417/.test(
      document.querySelector("#spoken").textContent,
    ),
  );
  assert.match(await page.getAttribute("#course", "aria-label"), /Forces from/);
});

ofPage("only what changes is drawn while a point is dragged", "", async (page) => {
  await mapped(page);
  await traced(page);
  const drawn = await page.evaluate(async () => {
    const drawn = {};
    const { clearRect } = CanvasRenderingContext2D.prototype;
    CanvasRenderingContext2D.prototype.clearRect = function (...box) {
      drawn[this.canvas.id] = (drawn[this.canvas.id] ?? 0) + 1;
      return clearRect.apply(this, box);
    };
    const { store, contact } = globalThis.explorer;
    const frame = () => new Promise((resolve) => requestAnimationFrame(resolve));
    for (let step = 0; step < 10; step++) {
      const kappa = 20 + step / 2;
      store.change({ point: [kappa, 0.5] });
      while (contact.contact.document.parameters.kappa !== kappa) await frame();
      await frame();
    }
    return drawn;
  });
  assert.equal(drawn.map, undefined, JSON.stringify(drawn));
  assert.ok(drawn.course >= 9 && drawn.course <= 11, JSON.stringify(drawn));
  const moved = await page.locator("#point").boundingBox();
  const plane = await page.locator("#plane").boundingBox();
  assert.ok(moved.x > plane.x + 200 && moved.x < plane.x + plane.width, JSON.stringify(moved));
});

ofPage("every law is computed, and its energies add up", "", async (page) => {
  const names = await page.locator("#law option").evaluateAll((all) => all.map((it) => it.value));
  for (const name of ["walton-braun", "granular/jkr/viscoelastic/mindlin"])
    assert.ok(names.length > 30 && names.includes(name), String(names));
  let refusals = 0;
  for (const name of [...names, "gran/hooke/history+limit_damping", "granular/jkr"]) {
    for (const tangential of [0.5, 0]) {
      const found = await page.evaluate(
        async ([law, tangential]) => {
          const { store, contact } = globalThis.explorer;
          const soon = () => new Promise((resolve) => requestAnimationFrame(resolve));
          const refusal = () => document.querySelector("#facts .error")?.textContent;
          store.change({ law: "paper", tangential: 0, point: [3, 0.5] });
          while (refusal() || contact.contact?.document.parameters.kappa !== 3) await soon();
          store.change({ law, damping: 0.2, tangential, point: [4, 0.5], boundaries: false });
          while (!refusal() && contact.contact?.document.parameters.kappa !== 4) await soon();
          if (refusal()) return { refused: refusal() };
          const { curves } = contact.chart.panels[3];
          const values = (...names) =>
            Array.from(curves.find((it) => names.includes(it.name))?.values ?? [0]);
          // With adhesion, what is held counts as lost.
          const lost = values("lost", "stored or lost");
          const held = [values("compression"), values("spring")];
          const drops = lost.slice(1).map((it, index) => lost[index] - it);
          return {
            // What is held at the end is lost with the contact.
            end: lost.at(-1) + held[0].at(-1) + held[1].at(-1) - contact.contact.document.energy_lost,
            drop: Math.max(...drops),
          };
        },
        [name, tangential],
      );
      if (found.refused) {
        refusals += 1;
        assert.match(found.refused, /expected|adhesion/, name);
        continue;
      }
      assert.ok(Math.abs(found.end) < 1e-6, `${name} ${JSON.stringify(found)}`);
      const told = await page.textContent("#equations");
      // Other springs may create energy, which the law says.
      if (/conserves energy/.test(told) && !/F_po/.test(told))
        assert.ok(found.drop < 1e-6, `${name} ${tangential} ${JSON.stringify(found)}`);
      break;
    }
  }
  assert.ok(refusals < 12, String(refusals));
});

ofPage(
  "curves of a slow plane come one by one, and dragging goes on meanwhile",
  BALL,
  async (page) => {
    await page.waitForFunction(() => globalThis.explorer.plane.found.length > 0);
    assert.match(await page.textContent("#status"), /tracing boundaries … \d/);
    assert.equal(await page.evaluate(() => globalThis.explorer.plane.atlas), undefined);
    await page.evaluate(() => globalThis.explorer.store.change({ set: { e: 0.5, g: 8 } }));
    // The first bounce is after √(2 height/g).
    await page.waitForFunction(
      () => Math.abs(globalThis.explorer.system.run.events[0].time - Math.sqrt(9.81 / 8)) < 1e-9,
    );
    await traced(page);
    assert.equal(await page.evaluate(() => globalThis.explorer.plane.found.length), 0);
  },
);

ofPage("two different spheres, and without friction", "preset=figure2", async (page) => {
  const kappa = () =>
    page.evaluate(() => globalThis.explorer.contact.contact?.document.parameters.kappa);
  await page.waitForFunction(() => globalThis.explorer.contact.contact);
  const equal = await kappa();
  await page.check("#other");
  await page.fill("#other-radius_m", "0.01");
  await page.press("#other-radius_m", "Enter");
  await page.waitForFunction(
    (equal) => globalThis.explorer.contact.contact?.document.parameters.kappa > equal,
    equal,
  );
  await page.fill("#mu-number", "0");
  await page.press("#mu-number", "Enter");
  await page.waitForFunction(() => globalThis.explorer.contact.contact?.document.eps_t === 1);
  // In scaled numbers there is no friction 0.
  await page.selectOption("#axes", "kappa-psi");
  await page.waitForSelector("#facts .error");
  assert.match(await page.textContent("#facts"), /mu = 0.*expected/);
  await page.fill("#mu-number", "0.4");
  await page.press("#mu-number", "Enter");
  await page.waitForSelector("table.facts");
  await page.click("summary:has-text('Window and point')");
  await page.fill("#point-x", "0");
  await page.press("#point-x", "Enter");
  await page.waitForFunction(() => globalThis.explorer.contact.contact?.document.eps_t === 1);
});

test("a page that was written with a view shows it, and in a frame too", async () => {
  const written = readFileSync(PAGE, "utf8").replace(
    'name="stickslip-view" content=""',
    'name="stickslip-view" content="law=paper&amp;damping=0.125&amp;point=%5B20%2C0.4%5D"',
  );
  const folder = mkdtempSync(join(tmpdir(), "explorer-"));
  const [own, framed] = ["own.html", "framed.html"].map((name) => join(folder, name));
  writeFileSync(own, written);
  const escaped = written.replace(/&/g, "&amp;").replace(/"/g, "&quot;");
  writeFileSync(framed, `<iframe width="1200" height="800" srcdoc="${escaped}"></iframe>`);
  const state = () => [
    globalThis.explorer.store.state.damping,
    ...globalThis.explorer.store.state.point,
  ];
  for (const [file, fragment, expected] of [
    [own, "", [0.125, 20, 0.4]],
    [own, "preset=plane", [0, 63, 0.5]],
    [framed, "", [0.125, 20, 0.4]],
  ]) {
    const { page, said, close } = await browser.openFile(file, fragment);
    const frame = page.frames().at(-1);
    await frame.waitForFunction(() => globalThis.explorer?.contact.contact);
    assert.deepEqual(await frame.evaluate(state), expected, `${file} ${fragment}`);
    await page.waitForTimeout(500);
    assert.deepEqual(said, []);
    await close();
  }
  rmSync(folder, { recursive: true });
});

test("a damaged page says that it cannot compute, and why", async () => {
  const folder = mkdtempSync(join(tmpdir(), "explorer-"));
  const whole = readFileSync(PAGE, "utf8");
  for (const [name, id, place, damage, why] of [
    ["character of the opening", "opening", 1000, '"', /character of it is damaged/],
    ["opening", "opening", 1000, "!!!!".repeat(100), /./],
    ["character", "wasm", 1000, '"', /character of it is damaged/],
    ["head", "wasm", 0, "!!!!", /damaged|do not fit/],
    ["module", "wasm", 1000, "!!!!".repeat(100), /damaged|do not fit/],
  ]) {
    const file = join(folder, `${name}.html`);
    const at = whole.indexOf(">", whole.indexOf(`id="${id}"`)) + 1 + place;
    writeFileSync(file, whole.slice(0, at) + damage + whole.slice(at + damage.length));
    const { page, said, close } = await browser.openFile(file);
    const told = () => document.getElementById("told").textContent;
    await page.waitForFunction(() =>
      /cannot compute/.test(document.getElementById("told").textContent),
    );
    assert.match(await page.evaluate(told), why, name);
    // The first contact needs the opening alone.
    const contacts = await page.locator("table.facts").count();
    assert.equal(contacts, id === "wasm" ? 1 : 0, name);
    assert.deepEqual(said, []);
    await close();
  }
  rmSync(folder, { recursive: true });
});

ofPage("a contact that the opening has not comes with the whole", "preset=hooke", async (page) => {
  await page.waitForFunction(() => globalThis.explorer.contact.contact);
  const { law, restarts } = await page.evaluate(() => ({
    law: globalThis.explorer.contact.contact.document.parameters.law,
    restarts: globalThis.explorer.hand.restarts,
  }));
  assert.equal(law.normal, "linear");
  assert.equal(restarts, 0);
});
