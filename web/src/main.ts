// The page: what is where, and what changes what.

import { isTraced, ofContact, ofImpact, ofSystem, ofWindow, type Lines } from "./commands";
import { ContactView, type First } from "./contact";
import { axisNames, Controls, HINT, type Controlled } from "./controls";
import { Crew, Hand } from "./crew";
import { byId, make, onceAFrame } from "./dom";
import { showLegend } from "./legend";
import { decoded, encoded } from "./link";
import { LINE, ofSpheres, ofText, quantitiesOf, type Places } from "./models";
import { compiled } from "./module";
import { write } from "./out";
import { Plane } from "./plane";
import type { Legend } from "./quantities";
import { INTERVALS, Store, taskOf, type State } from "./state";
import { nameOf, SystemView } from "./system";
import { whenSchemeChanges } from "./theme";
import type { Answer, Atlas, Contact, Law } from "./types";

const LETTERS = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "n′", "o"];

class Page implements Controlled {
  readonly store: Store;
  laws: Law[] = [];
  /** Whether a contact was shown. */
  private begun = false;
  readonly places: Places = { letters: [], top: [], small: [] };
  private readonly plane: Plane;
  private readonly contact: ContactView;
  readonly system: SystemView;
  private readonly hand: Hand;
  readonly crew: Crew;
  private hashTimer: ReturnType<typeof setTimeout> | undefined;
  private toastTimer: ReturnType<typeof setTimeout> | undefined;
  private readonly controls: Controls;
  private legend: [Legend, Atlas | undefined] | undefined;
  private linesKey = "";
  private linesTimer: ReturnType<typeof setTimeout> | undefined;
  private readonly show = onceAFrame(() => this.showNow());

  /** `hands` compute contacts and trace boundaries. */
  constructor(
    module: Promise<WebAssembly.Module>,
    [hand, tracer]: readonly [Hand, Hand],
    first: First,
    preset: string,
  ) {
    this.store = new Store(first.state, preset);
    const cores = Math.max(1, Math.min(8, navigator.hardwareConcurrency || 2));
    this.hand = hand;
    this.crew = new Crew(module, cores);
    this.contact = new ContactView(
      this.hand,
      first,
      () => this.laws,
      () => {
        this.showLines();
        // The first curves are shown before the first map is begun.
        if (!this.begun) requestAnimationFrame(() => this.show());
        this.begun = true;
      },
    );
    this.system = new SystemView(new Hand(module), this.store, () => {
      this.show();
      this.showLines();
    });
    this.plane = new Plane(this.crew, tracer, {
      point: (point) => this.movePoint(point),
      window: (x, y) =>
        this.store.change(this.store.state.tab === "spheres" ? { x, y } : { sx: x, sy: y }),
      told: (words) => (byId("told").textContent = words || HINT),
      status: (words) => {
        byId("status").textContent = words;
        this.showLegend();
      },
    });
    this.controls = new Controls(this);
    this.store.listen(() => this.show());
    whenSchemeChanges(() => {
      this.contact.redraw();
      this.system.redraw();
      this.plane.redraw();
    });
    this.showNow();
    // The opening does not have what this needs.
    module.then(
      () => this.learn(),
      () => {},
    );
  }

  /** Asks for what does not change: laws, and places with closed forms. */
  private async learn(): Promise<void> {
    const once = async (request: object) =>
      (await this.hand.do<Answer>({ task: "ask", request })).answer;
    // A worker may end meanwhile.
    const ask = async (request: object) => {
      const answer = await once(request);
      return answer.error ? once(request) : answer;
    };
    const [laws, about] = [await ask({ do: "laws" }), await ask({ do: "about" })];
    this.laws = laws as unknown as Law[];
    byId("version").textContent = `stickslip ${about.version}`;
    this.controls.offer(this.laws);
    this.showNow();
    this.contact.redraw();
    const line = await ask({ do: "line", kappa: LINE.kappa, highest: LINE.highest / LINE.ratio });
    if (!line.error) {
      const intervals = line as unknown as { low: number; high: number }[];
      this.places.letters = intervals.map(({ low, high }, index) => ({
        name: LETTERS[index] ?? "",
        ratio: ((low + high) / 2) * LINE.ratio,
      }));
    }
    const limits = await ask({ do: "limits", kappa: [0.01, 10_000] });
    this.places.top = limits.top as [number, number][];
    this.places.small = (limits.small as number[]).map((kappa, index) => ({ n: index + 1, kappa }));
    this.show();
  }

  movePoint(point: [number, number]): void {
    const { state } = this.store;
    if (state.tab === "spheres") this.store.change({ point });
    else
      this.store.change({ set: { ...state.set, [state.across]: point[0], [state.up]: point[1] } });
  }

  /** Another state altogether, such as a preset's. */
  go(state: State, preset: string): void {
    this.store.change(state, preset);
  }

  get preset(): string {
    return this.store.preset;
  }

  showNow(): void {
    const { state } = this.store;
    this.controls.show(state);
    const model =
      state.tab === "spheres" ? ofSpheres(state, this.places) : ofText(state, this.system);
    byId("no-plane").hidden = model !== undefined;
    if (state.tab === "spheres") this.contact.show(state);
    else void this.system.show(state);
    if (model && (this.begun || state.tab === "system")) this.plane.show(model);
    this.showLegend();
    this.showLines();
    clearTimeout(this.hashTimer);
    this.hashTimer = setTimeout(() => {
      const hash = this.fragment();
      // In a frame without an address there is nothing to change.
      if (location.protocol !== "about:" && hash !== location.hash.slice(1))
        history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
    }, 200);
  }

  private showLegend(): void {
    const {
      mapping: { legend },
      atlas,
    } = this.plane;
    if (!legend || (legend === this.legend?.[0] && atlas === this.legend[1])) return;
    this.legend = [legend, atlas];
    showLegend(byId("legend"), legend, atlas);
  }

  private lines(): [string, Lines][] {
    const { state } = this.store;
    if (state.tab === "system")
      return [
        ["This system", ofSystem(state, nameOf(state), this.system.run?.course[0]?.[0] ?? 0)],
      ];
    const { contact } = this.contact;
    const one: [string, Lines][] = contact
      ? [["This contact", ofContact(state, contact.document)]]
      : [];
    if (state.axes === "velocities") return [...one, ["These spheres", ofImpact(state)]];
    return isTraced(state) ? [...one, ["This window", ofWindow(state)]] : one;
  }

  /** Shows the lines soon: they need not follow each frame of a drag. */
  private showLines(): void {
    clearTimeout(this.linesTimer);
    this.linesTimer = setTimeout(() => this.showLinesNow(), 100);
  }

  private showLinesNow(): void {
    const block = (name: string, words: string) =>
      make(
        "div",
        { class: "code" },
        make(
          "button",
          {
            type: "button",
            click: () => void this.copy(words, name),
            "aria-label": `Copy: ${name}`,
          },
          "Copy",
        ),
        make("pre", { tabindex: 0, "aria-label": name }, words),
      );
    const lines = this.lines();
    const key = JSON.stringify(lines);
    // A button that has the focus keeps it.
    if (key === this.linesKey) return;
    this.linesKey = key;
    const nodes = lines.flatMap(([title, { shell, python }]) => [
      make("h3", {}, title),
      ...(shell ? [block(`${title}, command line`, shell)] : []),
      block(`${title}, Python`, python),
    ]);
    byId("lines").replaceChildren(...nodes);
    const { document: found } = this.contact.contact ?? {};
    if (!found || this.store.state.tab !== "spheres") return;
    const { switch_count, eps_t } = found;
    const words = `${switch_count} switches, tangential restitution ${eps_t.toFixed(4)}`;
    if (byId("spoken").textContent !== words) byId("spoken").textContent = words;
  }

  async copy(words: string, what: string): Promise<void> {
    try {
      await navigator.clipboard.writeText(words);
      this.say(`${what}: copied`);
    } catch {
      const area = make(
        "textarea",
        { readonly: true, class: "copying", "aria-label": what },
        words,
      );
      byId("lines").prepend(area);
      area.select();
      this.say("the browser does not copy; the text is selected");
    }
  }

  private say(words: string): void {
    const box = byId("toast");
    box.textContent = words;
    box.classList.add("shown");
    clearTimeout(this.toastTimer);
    this.toastTimer = setTimeout(() => box.classList.remove("shown"), 2500);
  }

  link(): string {
    return `${location.href.split("#")[0]}#${this.fragment()}`;
  }

  /** What a link to the present view ends with. A page with a view of its own needs more words. */
  private fragment(): string {
    return encoded(this.store.state, this.preset) || (ownView() ? "preset=plane" : "");
  }

  /** Writes a file by the name of its button. */
  async write(what: string): Promise<void> {
    const {
      store: { state },
      plane,
      contact,
      system,
    } = this;
    const spheres = state.tab === "spheres";
    const axes = axisNames(state);
    const fields = spheres
      ? ["eps_t", "contact_time", "energy_lost", "eps_n"]
      : quantitiesOf(system)
          .slice(2)
          .map((it) => it.name);
    const refusal = await write(what, { state, plane, contact, system, axes, fields });
    if (refusal) this.say(refusal);
  }

  /** What tests read. */
  get inside() {
    return {
      store: this.store,
      plane: this.plane,
      contact: this.contact,
      system: this.system,
      crew: this.crew,
      hand: this.hand,
    };
  }
}

/** The view with which the page was written. */
function ownView(): string {
  return document.querySelector<HTMLMetaElement>("meta[name=stickslip-view]")?.content ?? "";
}

/** Starts what computes, before the page is there: the first contact is asked for. */
async function open() {
  const { state, preset } = decoded(location.hash || ownView());
  let ready = (_: Promise<WebAssembly.Module>): void => {};
  const module = new Promise<WebAssembly.Module>((resolve) => (ready = resolve));
  const hands = [new Hand(module), new Hand(module)] as const;
  hands[0].warm();
  const asked = state.tab === "spheres";
  const task = taskOf(state, INTERVALS.screen);
  const found = asked ? hands[0].do<Answer & Contact>(task, 5000) : undefined;
  ready(compiled(hands, asked ? hands[0].tried : Promise.resolve()));
  module.catch(() => {});
  return { module, hands, first: { state, found }, preset };
}

const opened = open();
opened.catch(() => {});

/** Shows the page, whose controls are there. */
async function show(): Promise<void> {
  try {
    const { module, hands, first, preset } = await opened;
    const page = new Page(module, hands, first, preset);
    (globalThis as Record<string, unknown>).explorer = page.inside;
    await module;
    document.body.classList.add("ready");
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    byId("told").textContent = `The page cannot compute here: ${reason}`;
  }
}

(globalThis as Record<string, unknown>).explore = show;
