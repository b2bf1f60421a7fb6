// The page: what is where, and what changes what.

import { isTraced, ofContact, ofImpact, ofSystem, ofWindow, type Lines } from "./commands";
import { ContactView } from "./contact";
import { Crew, Hand, compiled } from "./crew";
import { byId, make, onceAFrame } from "./dom";
import { showLegend } from "./legend";
import { decoded, encoded } from "./link";
import { AXES, LINE, ofSpheres, ofText, quantitiesOf, units, type Places } from "./models";
import { rounded, typed } from "./number";
import { write } from "./out";
import { Plane } from "./plane";
import { PRESETS, presetOf } from "./presets";
import { OF_SPHERES, type Legend } from "./quantities";
import {
  BALL,
  ballOf,
  isAdhesive,
  pin,
  Store,
  type Axes,
  type Bodies,
  type Quantity,
  type State,
} from "./state";
import { nameOf, SystemView } from "./system";
import { whenSchemeChanges } from "./theme";
import { tour } from "./tour";
import type { Answer, Atlas, Axis, Law } from "./types";

/** The window and the point of axes that were just chosen. */
const WINDOWS: Record<Axes, Partial<State>> = {
  "kappa-psi": presetOf("plane").state,
  "kappa-ratio": {
    x: { low: 1, high: 100, log: true },
    y: { low: 0.02, high: 3.1, log: false },
    point: [63, 0.7],
  },
  "axis-ratio": {
    x: { low: 0, high: 20, log: false },
    y: { low: 0, high: 4, log: false },
    point: [18, 1.55],
  },
  velocities: {
    x: { low: 0.1, high: 40, log: true },
    y: { low: 0.01, high: 60, log: true },
    point: [10, 5],
  },
};
const LETTERS = ["a", "b", "c", "d", "e", "f", "g", "h", "i", "j", "k", "l", "m", "n", "n′", "o"];

/** The parameters that have a slider and a number. */
const SLIDERS = ["damping", "tangential", "dynamic", "decay", "pull_off", "mu"] as const;
const TABS = ["spheres", "system"] as const;

class Page {
  readonly store: Store;
  private preset: string;
  private laws: Law[] = [];
  /** Whether a contact was shown. */
  private begun = false;
  private readonly places: Places = { letters: [], top: [], small: [] };
  private readonly plane: Plane;
  private readonly contact: ContactView;
  private readonly system: SystemView;
  private readonly hand: Hand;
  readonly crew: Crew;
  private hashTimer: ReturnType<typeof setTimeout> | undefined;
  private toastTimer: ReturnType<typeof setTimeout> | undefined;
  /** All that the controls show, but for the point. */
  private controls = "";
  private legend: [Legend, Atlas | undefined] | undefined;
  private linesTimer: ReturnType<typeof setTimeout> | undefined;
  private readonly show = onceAFrame(() => this.showNow());

  /** `hands` compute contacts and trace boundaries. */
  constructor(
    module: Promise<WebAssembly.Module>,
    [hand, tracer]: readonly [Hand, Hand],
    from: { state: State; preset: string },
  ) {
    this.store = new Store(from.state);
    this.preset = from.preset;
    const cores = Math.max(1, Math.min(8, navigator.hardwareConcurrency || 2));
    this.hand = hand;
    this.crew = new Crew(module, cores);
    this.contact = new ContactView(
      this.hand,
      () => this.laws,
      () => {
        this.showLines();
        // The first curves come before the first map, for which all processors work.
        if (!this.begun) this.show();
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
    this.wire();
    this.store.listen(() => this.show());
    whenSchemeChanges(() => {
      this.contact.redraw();
      this.system.redraw();
      this.plane.redraw();
    });
    this.showNow();
    void this.learn();
  }

  /** Asks for what does not change: laws, and places with closed forms. */
  private async learn(): Promise<void> {
    const ask = async (request: object) =>
      (await this.hand.do<Answer>({ task: "ask", request })).answer;
    const [laws, about] = [await ask({ do: "laws" }), await ask({ do: "about" })];
    this.laws = laws as unknown as Law[];
    byId("version").textContent = `stickslip ${about.version}`;
    const choice = byId<HTMLSelectElement>("law");
    const codes = [...new Set(this.laws.map((law) => law.code))];
    choice.replaceChildren(
      ...codes.map((code) =>
        make(
          "optgroup",
          { label: code },
          ...this.laws
            .filter((law) => law.code === code)
            .map((law) => make("option", { value: law.name }, law.name)),
        ),
      ),
    );
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

  private movePoint(point: [number, number]): void {
    const { state } = this.store;
    if (state.tab === "spheres") this.store.change({ point });
    else
      this.store.change({ set: { ...state.set, [state.across]: point[0], [state.up]: point[1] } });
  }

  /** Another state altogether, such as a preset's. */
  go(state: State, preset: string): void {
    this.preset = preset;
    this.store.change(state);
  }

  private showNow(): void {
    const { state } = this.store;
    this.showPoint(state);
    const { point: _, ...others } = state;
    const controls = JSON.stringify([others, this.preset, this.laws.length, this.places, this.system.parsed]);
    if (controls !== this.controls) this.showControls(state);
    this.controls = controls;
    const model =
      state.tab === "spheres" ? ofSpheres(state, this.places) : ofText(state, this.system);
    byId("no-plane").hidden = model !== undefined;
    if (state.tab === "spheres") this.contact.show(state);
    else void this.system.show(state);
    if (model && (this.begun || state.tab === "system")) this.plane.show(model);
    this.showLegend();
    clearTimeout(this.hashTimer);
    this.hashTimer = setTimeout(() => {
      const hash = this.fragment();
      // In a frame without an address there is nothing to change.
      if (location.protocol !== "about:" && hash !== location.hash.slice(1))
        history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
    }, 200);
  }

  /** Puts the point into its controls. */
  private showPoint(state: State): void {
    const spheres = state.tab === "spheres";
    put("point-x", spheres ? state.point[0] : this.system.value(state.across));
    put("point-y", spheres ? state.point[1] : this.system.value(state.up));
  }

  /** Puts the state into all other controls. */
  private showControls(state: State): void {
    document.body.dataset.tab = state.tab;
    const spheres = state.tab === "spheres";
    for (const tab of TABS) {
      const button = byId<HTMLButtonElement>(`tab-${tab}`);
      button.setAttribute("aria-selected", String(tab === state.tab));
      button.tabIndex = tab === state.tab ? 0 : -1;
    }
    put("preset", this.preset);
    byId("caption").textContent = presetOf(this.preset).caption;
    put("axes", state.axes);
    const quantities = spheres ? OF_SPHERES : quantitiesOf(this.system);
    const choice = byId<HTMLSelectElement>("quantity");
    const names = quantities.map((it) => it.name).join();
    if (choice.dataset.names !== names) {
      choice.dataset.names = names;
      choice.replaceChildren(...quantities.map((it) => make("option", { value: it.id }, it.name)));
    }
    put("quantity", spheres ? state.quantity : state.colour);
    const [x, y] = spheres ? [state.x, state.y] : [state.sx, state.sy];
    for (const [id, value] of [
      ["x-low", x.low],
      ["x-high", x.high],
      ["y-low", y.low],
      ["y-high", y.high],
    ] as const)
      put(id, value);
    byId<HTMLInputElement>("x-log").checked = x.log;
    byId<HTMLInputElement>("y-log").checked = y.log;
    const [one, other] = this.axisNames(state);
    for (const label of document.querySelectorAll("[data-axis]")) {
      label.textContent = (label as HTMLElement).dataset.axis === "x" ? one : other;
    }
    for (const id of ["boundaries", "points", "limits"] as const)
      byId<HTMLInputElement>(id).checked = state[id];
    put("law", state.law);
    // Bodies yield from a = 1 on.
    const yields = this.laws.find((it) => it.name === state.law)?.law.damping === "yielding";
    byId<HTMLInputElement>("damping").max = yields ? "20" : "1";
    for (const id of SLIDERS) {
      put(id, state[id]);
      put(`${id}-number`, state[id]);
    }
    put("alpha", state.alpha === 2 / 7 ? "2/7" : state.alpha);
    const { other: second, ...first } = state.bodies;
    for (const [key, value] of Object.entries(first)) put(key, value);
    for (const [key, value] of Object.entries(second ?? {})) put(`other-${key}`, value);
    byId<HTMLInputElement>("other").checked = second !== null;
    const law = this.laws.find((it) => it.name === state.law);
    byId<HTMLInputElement>("tangential").disabled = byId<HTMLInputElement>(
      "tangential-number",
    ).disabled = law?.name === "paper";
    byId("equations").textContent = law ? `${law.equations}. The spring ${law.energy}.` : "";
    document.body.dataset.axes = state.axes;
    byId("pull").hidden = !isAdhesive(state.law);
    byId("pin").textContent = state.pinned ? "Unpin" : "Pin to compare";
    byId("letters").hidden = !(state.points && spheres);
    if (state.points && byId("letters").childElementCount !== this.places.letters.length) {
      byId("letters").replaceChildren(
        ...this.places.letters.map(({ name, ratio }) =>
          make(
            "button",
            { type: "button", click: () => this.toLetter(ratio), "aria-label": `point ${name}` },
            name,
          ),
        ),
      );
    }
  }

  private toLetter(ratio: number): void {
    const [ofX, ofY] = units(this.store.state);
    this.store.change({ point: [rounded(LINE.kappa / ofX), rounded(ratio / LINE.ratio / ofY)] });
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
    const nodes = this.lines().flatMap(([title, { shell, python }]) => [
      make("h3", {}, title),
      ...(shell ? [block(`${title}, command line`, shell)] : []),
      block(`${title}, Python`, python),
    ]);
    byId("lines").replaceChildren(...nodes);
    const { document: found } = this.contact.contact ?? {};
    if (found && this.store.state.tab === "spheres")
      byId("spoken").textContent =
        `${found.switch_count} switches, tangential restitution ${found.eps_t.toFixed(4)}`;
  }

  private async copy(words: string, what: string): Promise<void> {
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
  private write(what: string): Promise<void> {
    const {
      store: { state },
      plane,
      contact,
      system,
    } = this;
    const spheres = state.tab === "spheres";
    const axes = this.axisNames(state);
    const fields = spheres
      ? ["eps_t", "contact_time", "energy_lost", "eps_n"]
      : quantitiesOf(system)
          .slice(2)
          .map((it) => it.name);
    return write(what, { state, plane, contact, system, axes, fields });
  }

  private axisNames(state: State): [string, string] {
    if (state.tab === "system") return [state.across, state.up];
    const [one, other] = AXES[state.axes];
    return [one.symbol, other.symbol];
  }

  private wire(): void {
    const { store } = this;
    const on = (id: string, type: string, act: (input: HTMLInputElement) => void) =>
      byId(id).addEventListener(type, (event) => act(event.target as HTMLInputElement));
    const choice = byId<HTMLSelectElement>("preset");
    choice.append(...PRESETS.map(({ id, name }) => make("option", { value: id }, name)));
    on("preset", "change", ({ value }) => this.go(presetOf(value).state, value));
    TABS.forEach((tab, place) => {
      const button = byId(`tab-${tab}`);
      button.onclick = () => store.change({ tab });
      button.onkeydown = ({ key }) => {
        const to = { ArrowLeft: place - 1, ArrowRight: place + 1, Home: 0, End: -1 };
        const next = key in to && TABS.at(to[key as keyof typeof to] % TABS.length);
        if (!next) return;
        store.change({ tab: next });
        byId(`tab-${next}`).focus();
      };
    });
    on("axes", "change", ({ value }) => {
      const axes = value as Axes;
      const { x, y, point } = WINDOWS[axes];
      store.change({ axes, pinned: null, ...(x && y && point ? { x, y, point } : {}) });
    });
    on("quantity", "change", ({ value }) =>
      store.change(
        store.state.tab === "spheres"
          ? { quantity: value as Quantity }
          : { colour: value as Quantity },
      ),
    );
    const axisOf = (key: "x" | "y"): [keyof State, Axis] => {
      const { tab } = store.state;
      const name = tab === "spheres" ? key : (`s${key}` as "sx" | "sy");
      return [name, store.state[name]];
    };
    for (const key of ["x", "y"] as const) {
      for (const end of ["low", "high"] as const) {
        on(`${key}-${end}`, "change", (input) => {
          const [name, axis] = axisOf(key);
          const value = typed(input.value);
          const next = { ...axis, [end]: value };
          if (
            value !== undefined &&
            next.low < next.high &&
            (next.low > 0 || !axis.log) &&
            (next.low >= 0 || store.state.tab === "system")
          )
            store.change({ [name]: next });
          input.value = String(axisOf(key)[1][end]);
        });
      }
      on(`${key}-log`, "change", ({ checked }) => {
        const [name, axis] = axisOf(key);
        if (checked && axis.high <= 0) return this.showNow();
        store.change({
          [name]: {
            ...axis,
            log: checked,
            low: checked && axis.low <= 0 ? axis.high / 1000 : axis.low,
          },
        });
      });
    }
    on("point-x", "change", (input) => this.typePoint(0, input));
    on("point-y", "change", (input) => this.typePoint(1, input));
    for (const id of ["boundaries", "points", "limits"] as const)
      on(id, "change", ({ checked }) => store.change({ [id]: checked }));
    on("law", "change", ({ value }) => {
      const law = this.laws.find((it) => it.name === value);
      const patch: Partial<State> = { law: value };
      if (value === "paper") patch.tangential = 0;
      if (law?.law.damping === "none") patch.damping = 0;
      store.change(patch);
    });
    for (const id of SLIDERS) {
      on(id, "input", ({ value }) => store.change({ [id]: Number(value) }));
      on(`${id}-number`, "change", (input) => {
        const value = typed(input.value);
        if (value !== undefined && value >= 0 && (id !== "dynamic" || value <= 1))
          store.change({ [id]: value });
        input.value = String(store.state[id]);
      });
    }
    on("alpha", "change", (input) => {
      const value = typed(input.value);
      if (value !== undefined && value > 0 && value <= 1) store.change({ alpha: value });
      this.showNow();
    });
    const body = (id: string, change: (bodies: Bodies, value: number) => Bodies) =>
      on(id, "change", (input) => {
        const value = typed(input.value);
        if (value !== undefined) store.change({ bodies: change(store.state.bodies, value) });
      });
    const { other: _, ...one } = store.state.bodies;
    for (const key of Object.keys(one)) body(key, (bodies, value) => ({ ...bodies, [key]: value }));
    for (const key of BALL)
      body(`other-${key}`, ({ other, ...one }, value) => ({
        ...one,
        other: { ...(other ?? ballOf(one)), [key]: value },
      }));
    on("other", "change", ({ checked }) => {
      const { bodies } = store.state;
      store.change({ bodies: { ...bodies, other: checked ? ballOf(bodies) : null } });
    });
    byId("pin").onclick = () =>
      store.change({ pinned: store.state.pinned ? null : pin(store.state) });
    byId("home").onclick = () => {
      const { x, y, axes } = presetOf(this.preset).state;
      store.change(store.state.tab === "spheres" ? { x, y, axes } : this.system.home());
    };
    byId("undo").onclick = () => store.undo();
    byId("redo").onclick = () => store.redo();
    byId("link").onclick = () => void this.copy(this.link(), "link");
    byId("start-tour").onclick = () => tour((state, preset) => this.go(state, preset));
    for (const button of document.querySelectorAll<HTMLElement>("[data-write]")) {
      button.onclick = () => void this.write(button.dataset.write ?? "");
    }
    const help = byId<HTMLDialogElement>("help");
    byId("show-help").onclick = () => help.showModal();
    byId("close-help").onclick = () => help.close();
    window.addEventListener("hashchange", () => {
      const { state, preset } = decoded(location.hash);
      this.go(state, preset);
    });
    window.addEventListener("keydown", (event) => this.key(event));
    byId("told").textContent = HINT;
  }

  private typePoint(place: 0 | 1, input: HTMLInputElement): void {
    const { state } = this.store;
    const value = typed(input.value);
    const now: [number, number] =
      state.tab === "spheres"
        ? [...state.point]
        : [this.system.value(state.across), this.system.value(state.up)];
    if (value !== undefined && (value >= 0 || state.tab === "system")) {
      now[place] = value;
      this.movePoint(now);
    }
    input.value = String(now[place]);
  }

  private key(event: KeyboardEvent): void {
    const { target } = event;
    const typing =
      target instanceof HTMLInputElement ||
      target instanceof HTMLTextAreaElement ||
      target instanceof HTMLSelectElement;
    if (typing) return;
    const key = event.key.toLowerCase();
    if ((event.ctrlKey || event.metaKey) && key === "z") {
      event.shiftKey ? this.store.redo() : this.store.undo();
      event.preventDefault();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const acts: Record<string, () => void> = {
      b: () => this.store.change({ boundaries: !this.store.state.boundaries }),
      p: () => byId("pin").click(),
      h: () => byId("home").click(),
      l: () => byId("link").click(),
      t: () => byId("start-tour").click(),
      "?": () => byId("show-help").click(),
      " ": () => byId("play").click(),
    };
    const act = acts[key];
    if (!act || (key === " " && target instanceof HTMLButtonElement)) return;
    act();
    event.preventDefault();
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

/** Puts a value into a control, unless it is being typed. */
function put(id: string, value: string | number): void {
  const input = byId<HTMLInputElement | HTMLSelectElement>(id);
  if (input !== document.activeElement || input.type === "range") input.value = String(value);
}

/** The view with which the page was written. */
function ownView(): string {
  return document.querySelector<HTMLMetaElement>("meta[name=stickslip-view]")?.content ?? "";
}

const HINT = "Drag the point; wheel or pinch to zoom; Shift and drag to move the window.";

async function start(): Promise<void> {
  try {
    // Controls are drawn while workers unpack the module.
    let ready = (_: Promise<WebAssembly.Module>): void => {};
    const module = new Promise<WebAssembly.Module>((resolve) => (ready = resolve));
    const hands = [new Hand(module), new Hand(module)] as const;
    ready(compiled([...hands]));
    const page = new Page(module, hands, decoded(location.hash || ownView()));
    (globalThis as Record<string, unknown>).explorer = page.inside;
    await module;
    document.body.classList.add("ready");
  } catch (error) {
    const reason = error instanceof Error ? error.message : String(error);
    byId("told").textContent = `The page cannot compute here: ${reason}`;
  }
}

void start();
