// The controls: what they show of a state, and how they change it.

import { byId, make, put } from "./dom";
import { decoded } from "./link";
import { AXES, LINE, quantitiesOf, units, type Places } from "./models";
import { rounded, typed } from "./number";
import { PRESETS, presetOf } from "./presets";
import { OF_SPHERES } from "./quantities";
import {
  BALL,
  ballOf,
  isAdhesive,
  pin,
  type Axes,
  type Quantity,
  type State,
  type Store,
} from "./state";
import type { SystemView } from "./system";
import { tour } from "./tour";
import type { Axis, Law } from "./types";

/** What the controls need of the page. */
export interface Controlled {
  readonly store: Store;
  readonly laws: Law[];
  readonly places: Places;
  readonly system: SystemView;
  readonly preset: string;
  showNow(): void;
  /** Another state altogether, such as a preset's. */
  go(state: State, preset: string): void;
  movePoint(point: [number, number]): void;
  link(): string;
  copy(words: string, what: string): Promise<void>;
  /** Writes a file by the name of its button. */
  write(what: string): Promise<void>;
}

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

/** The parameters that have a slider and a number. */
const SLIDERS = ["damping", "tangential", "dynamic", "decay", "pull_off", "mu"] as const;
export const HINT = "Drag the point; wheel or pinch to zoom; Shift and drag to move the window.";
const TABS = ["spheres", "system"] as const;

export class Controls {
  /** All that the controls show, but for the point. */
  private shown = "";

  constructor(private readonly page: Controlled) {
    this.wire();
  }

  /** Puts a state into the controls. */
  show(state: State): void {
    const { preset, laws, places, system } = this.page;
    this.point(state);
    const { point: _, ...others } = state;
    const shown = JSON.stringify([others, preset, laws.length, places, system.parsed]);
    if (shown !== this.shown) this.others(state);
    this.shown = shown;
  }

  /** Offers laws, by the code that has them. */
  offer(laws: Law[]): void {
    const option = ({ name }: Law) => make("option", { value: name }, name);
    const codes = [...new Set(laws.map((law) => law.code))].map((code) => {
      const own = laws.filter((law) => law.code === code);
      return make("optgroup", { label: code }, ...own.map(option));
    });
    byId("law").replaceChildren(...codes);
  }

  /** Puts the point into its controls. */
  private point(state: State): void {
    const { page } = this;
    const spheres = state.tab === "spheres";
    put("point-x", spheres ? state.point[0] : page.system.value(state.across));
    put("point-y", spheres ? state.point[1] : page.system.value(state.up));
  }

  /** Puts the state into all other controls. */
  private others(state: State): void {
    const { page } = this;
    document.body.dataset.tab = state.tab;
    const spheres = state.tab === "spheres";
    for (const tab of TABS) {
      const button = byId<HTMLButtonElement>(`tab-${tab}`);
      button.setAttribute("aria-selected", String(tab === state.tab));
      button.tabIndex = tab === state.tab ? 0 : -1;
    }
    put("preset", page.preset);
    byId("caption").textContent = presetOf(page.preset).caption;
    put("axes", state.axes);
    const quantities = spheres ? OF_SPHERES : quantitiesOf(page.system);
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
    const [one, other] = axisNames(state);
    for (const label of document.querySelectorAll("[data-axis]")) {
      label.textContent = (label as HTMLElement).dataset.axis === "x" ? one : other;
    }
    for (const id of ["boundaries", "points", "limits"] as const)
      byId<HTMLInputElement>(id).checked = state[id];
    put("law", state.law);
    // Bodies yield from a = 1 on.
    const yields = page.laws.find((it) => it.name === state.law)?.law.damping === "yielding";
    byId<HTMLInputElement>("damping").max = yields ? "20" : "1";
    for (const id of SLIDERS) {
      put(id, state[id]);
      put(`${id}-number`, state[id]);
    }
    put("alpha", alphaOf(state));
    const { other: second, ...first } = state.bodies;
    for (const [key, value] of Object.entries(first)) put(key, value);
    for (const [key, value] of Object.entries(second ?? {})) put(`other-${key}`, value);
    byId<HTMLInputElement>("other").checked = second !== null;
    const law = page.laws.find((it) => it.name === state.law);
    byId<HTMLInputElement>("tangential").disabled = byId<HTMLInputElement>(
      "tangential-number",
    ).disabled = law?.name === "paper";
    byId("equations").textContent = law ? `${law.equations}. The spring ${law.energy}.` : "";
    document.body.dataset.axes = state.axes;
    byId("pull").hidden = !isAdhesive(state.law);
    byId("pin").textContent = state.pinned ? "Unpin" : "Pin to compare";
    byId("letters").hidden = !(state.points && spheres);
    if (state.points && byId("letters").childElementCount !== page.places.letters.length) {
      byId("letters").replaceChildren(
        ...page.places.letters.map(({ name, ratio }) =>
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
    const { page } = this;
    const [ofX, ofY] = units(page.store.state);
    page.store.change({ point: [rounded(LINE.kappa / ofX), rounded(ratio / LINE.ratio / ofY)] });
  }

  private wire(): void {
    const { page } = this;
    const { store } = page;
    const on = (id: string, type: string, act: (input: HTMLInputElement) => void) =>
      byId(id).addEventListener(type, (event) => act(event.target as HTMLInputElement));
    const choice = byId<HTMLSelectElement>("preset");
    choice.append(...PRESETS.map(({ id, name }) => make("option", { value: id }, name)));
    on("preset", "change", ({ value }) => page.go(presetOf(value).state, value));
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
      on(`${key}-log`, "change", (input) => {
        const { checked } = input;
        const [name, axis] = axisOf(key);
        const low = checked && axis.low <= 0 ? axis.high / 1000 : axis.low;
        if (!checked || low > 0) store.change({ [name]: { ...axis, log: checked, low } });
        input.checked = axisOf(key)[1].log;
      });
    }
    on("point-x", "change", (input) => this.typePoint(0, input));
    on("point-y", "change", (input) => this.typePoint(1, input));
    for (const id of ["boundaries", "points", "limits"] as const)
      on(id, "change", ({ checked }) => store.change({ [id]: checked }));
    on("law", "change", ({ value }) => {
      const law = page.laws.find((it) => it.name === value);
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
      input.value = alphaOf(store.state);
    });
    const { other: _, ...one } = store.state.bodies;
    for (const key of Object.keys(one) as (keyof typeof one)[])
      on(key, "change", (input) => {
        const value = typed(input.value);
        const { bodies } = store.state;
        if (value !== undefined) store.change({ bodies: { ...bodies, [key]: value } });
        input.value = String(store.state.bodies[key]);
      });
    for (const key of BALL)
      on(`other-${key}`, "change", (input) => {
        const value = typed(input.value);
        const { other, ...first } = store.state.bodies;
        const second = other ?? ballOf(first);
        const changed = value === undefined ? second : { ...second, [key]: value };
        if (value !== undefined) store.change({ bodies: { ...first, other: changed } });
        input.value = String(changed[key]);
      });
    on("other", "change", ({ checked }) => {
      const { bodies } = store.state;
      store.change({ bodies: { ...bodies, other: checked ? ballOf(bodies) : null } });
    });
    byId("pin").onclick = () =>
      store.change({ pinned: store.state.pinned ? null : pin(store.state) });
    byId("home").onclick = () => {
      const { x, y, axes, point } = presetOf(page.preset).state;
      // In other axes the point is another one.
      const other = axes === store.state.axes ? {} : { axes, point, pinned: null };
      store.change(store.state.tab === "spheres" ? { x, y, ...other } : page.system.home());
    };
    byId("undo").onclick = () => store.undo();
    byId("redo").onclick = () => store.redo();
    byId("link").onclick = () => void page.copy(page.link(), "link");
    byId("start-tour").onclick = () => tour((state, preset) => page.go(state, preset));
    for (const button of document.querySelectorAll<HTMLElement>("[data-write]")) {
      button.onclick = () => void page.write(button.dataset.write ?? "");
    }
    const help = byId<HTMLDialogElement>("help");
    byId("show-help").onclick = () => help.showModal();
    byId("close-help").onclick = () => help.close();
    window.addEventListener("hashchange", () => {
      const { state, preset } = decoded(location.hash);
      page.go(state, preset);
    });
    window.addEventListener("keydown", (event) => this.key(event));
    byId("told").textContent = HINT;
  }

  private typePoint(place: 0 | 1, input: HTMLInputElement): void {
    const { page } = this;
    const { state } = page.store;
    const value = typed(input.value);
    const now: [number, number] =
      state.tab === "spheres"
        ? [...state.point]
        : [page.system.value(state.across), page.system.value(state.up)];
    if (value !== undefined && (value >= 0 || state.tab === "system")) {
      now[place] = value;
      page.movePoint(now);
    }
    input.value = String(now[place]);
  }

  private key(event: KeyboardEvent): void {
    const { page } = this;
    const { target } = event;
    const typing =
      target instanceof HTMLInputElement ||
      target instanceof HTMLTextAreaElement ||
      target instanceof HTMLSelectElement;
    if (typing) return;
    const key = event.key.toLowerCase();
    if ((event.ctrlKey || event.metaKey) && key === "z") {
      event.shiftKey ? page.store.redo() : page.store.undo();
      event.preventDefault();
      return;
    }
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    // Beside the plane and the contact, Space scrolls and opens what has the focus.
    const free = target === document.body || target instanceof HTMLCanvasElement;
    if ((key === " " && !free) || byId<HTMLDialogElement>("help").open) return;
    const acts: Record<string, () => void> = {
      b: () => page.store.change({ boundaries: !page.store.state.boundaries }),
      p: () => byId("pin").click(),
      h: () => byId("home").click(),
      l: () => byId("link").click(),
      t: () => byId("start-tour").click(),
      "?": () => byId("show-help").click(),
      " ": () => byId("play").click(),
    };
    const act = Object.hasOwn(acts, key) && acts[key];
    if (!act) return;
    act();
    event.preventDefault();
  }
}

function alphaOf({ alpha }: State): string {
  return alpha === 2 / 7 ? "2/7" : String(alpha);
}

/** What the axes of a state are called. */
export function axisNames(state: State): [string, string] {
  if (state.tab === "system") return [state.across, state.up];
  const [one, other] = AXES[state.axes];
  return [one.symbol, other.symbol];
}
