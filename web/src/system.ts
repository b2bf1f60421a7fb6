// A system of one's own: its text, its parameters, its run.

import { described, drawChart, timeAt, type Chart, type Panel } from "./chart";
import type { Hand } from "./crew";
import { byId, fit, make, onceAFrame, put, sizeOf } from "./dom";
import { EXAMPLES } from "./examples";
import { short, typed } from "./number";
import { CanvasPen } from "./pen";
import { roomy } from "./scale";
import type { State, Store } from "./state";
import { theme } from "./theme";
import type { Answer, Axis, SceneRequest } from "./types";

interface Parameter {
  name: string;
  value: number;
  range: [number, number] | null;
}

interface Parsed {
  parameters: Parameter[];
  components: { name: string; discrete: boolean }[];
  modes: string[];
  text: string;
}

interface Run {
  outcome: string;
  accumulation: number | null;
  time: number;
  mode: string;
  state: Record<string, number>;
  decided: boolean;
  events: {
    time: number;
    event: string;
    from: string;
    to: string;
    before: number[];
    after: number[];
  }[];
  stays: [number, number, number][];
  course: number[][];
}

const MOST_PANELS = 4;
const MOST_ROWS = 100;

/** The text of the system of a state. */
export function textOf(state: State): string {
  return state.text ?? EXAMPLES[state.example]?.text ?? "";
}

/** The value that a parameter is set to. An object has other names too, such as `constructor`. */
function given(set: Record<string, number>, name: string): number | undefined {
  return Object.hasOwn(set, name) ? set[name] : undefined;
}

/** The name of the file of the system of a state. */
export function nameOf(state: State): string {
  return state.text === null ? state.example : "system";
}

/** A number of events up to which runs can be told apart. */
export function mostOf(value: number): number {
  return Math.max(1, Math.min(200, Math.round(value)));
}

export class SystemView {
  parsed: Parsed | undefined;
  run: Run | undefined;
  chart: Chart | undefined;
  private readonly editor = byId<HTMLTextAreaElement>("editor");
  private readonly gutter = byId("gutter");
  private readonly problem = byId("problem");
  private readonly canvas = byId<HTMLCanvasElement>("run");
  private shownText = "";
  private runKey = "";
  private cursor: number | undefined;
  private errorLine = 0;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private readonly draw = onceAFrame(() => this.drawNow());

  constructor(
    private readonly hand: Hand,
    private readonly store: Store,
    private readonly changed: () => void,
  ) {
    const choice = byId<HTMLSelectElement>("example");
    choice.append(...Object.keys(EXAMPLES).map((name) => make("option", { value: name }, name)));
    choice.onchange = () => this.choose(choice.value);
    const take = () => {
      clearTimeout(this.timer);
      this.timer = undefined;
      store.change({ text: this.editor.value });
    };
    this.editor.addEventListener("input", () => {
      clearTimeout(this.timer);
      this.drawGutter();
      this.timer = setTimeout(take, 250);
    });
    // What is pressed next is meant for the text as it is.
    this.editor.addEventListener("blur", () => this.timer !== undefined && take());
    this.editor.addEventListener("scroll", () => (this.gutter.scrollTop = this.editor.scrollTop));
    byId("tidy").onclick = () => {
      if (this.parsed && this.shownText === textOf(store.state))
        store.change({ text: this.parsed.text });
    };
    this.canvas.addEventListener("pointermove", (event) => {
      const box = this.canvas.getBoundingClientRect();
      this.cursor = this.chart && timeAt(this.chart, box.width, event.clientX - box.left);
      this.draw();
    });
    this.canvas.addEventListener("pointerleave", () => {
      this.cursor = undefined;
      this.draw();
    });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    for (const [id, key] of [
      ["across", "across"],
      ["up", "up"],
    ] as const) {
      byId<HTMLSelectElement>(id).onchange = (event) =>
        this.axis(key, (event.target as HTMLSelectElement).value);
    }
    const field = (id: "most" | "end", patch: (value: number | undefined) => Partial<State>) => {
      const input = byId<HTMLInputElement>(id);
      input.onchange = () => {
        const value = typed(input.value);
        if (value !== undefined || input.value.trim() === "") store.change(patch(value));
        input.value = String(store.state[id] ?? "");
      };
    };
    field("most", (value) => (value === undefined ? {} : { most: mostOf(value) }));
    field("end", (value) => ({ end: value ?? null }));
  }

  /** Shows an example. */
  private choose(example: string): void {
    const plane = EXAMPLES[example]?.plane;
    this.store.change({
      example,
      text: null,
      set: {},
      end: null,
      ...(plane ?? { across: "", up: "" }),
    });
  }

  /** The window in which the plane of the system is shown first. */
  home(): Pick<State, "sx" | "sy"> {
    const { across, up, example, text } = this.store.state;
    const plane = text === null ? EXAMPLES[example]?.plane : undefined;
    if (plane && plane.across === across && plane.up === up) return { sx: plane.sx, sy: plane.sy };
    const axis = (name: string): Axis => ({
      low: this.rangeOf(name)[0],
      high: this.rangeOf(name)[1],
      log: false,
    });
    return { sx: axis(across), sy: axis(up) };
  }

  private axis(key: "across" | "up", name: string): void {
    const { state } = this.store;
    const other = key === "across" ? state.up : state.across;
    const range = this.rangeOf(name);
    const own: Axis = { low: range[0], high: range[1], log: false };
    const patch: Partial<State> =
      key === "across" ? { across: name, sx: own } : { up: name, sy: own };
    // Both axes are different: the other one takes the old name.
    if (name === other) {
      Object.assign(
        patch,
        key === "across"
          ? { up: state.across, sy: state.sx, sx: state.sy }
          : { across: state.up, sx: state.sy, sy: state.sx },
      );
    }
    this.store.change(patch);
  }

  private rangeOf(name: string): [number, number] {
    const parameter = this.parsed?.parameters.find((it) => it.name === name);
    if (parameter?.range) return parameter.range;
    const value = parameter?.value ?? 1;
    return value === 0 ? [-1, 1] : value > 0 ? [value / 2, value * 2] : [value * 2, value / 2];
  }

  /** The value of a parameter. */
  value(name: string): number {
    const parameter = this.parsed?.parameters.find((it) => it.name === name);
    return given(this.store.state.set, name) ?? parameter?.value ?? 1;
  }

  /** The plane of the system, if it has one. */
  scene({ across, up, set, end, most, sx, sy }: State, text: string): SceneRequest | undefined {
    const names = this.parsed?.parameters.map((it) => it.name) ?? [];
    if (!this.parsed || !names.includes(across) || !names.includes(up) || across === up)
      return undefined;
    const others = Object.fromEntries(
      Object.entries(set).filter(([name]) => name !== across && name !== up),
    );
    return { kind: "system", x: sx, y: sy, text, set: others, end, across, up, most_events: most };
  }

  /** Shows the system of a state. */
  async show(state: State): Promise<void> {
    const text = textOf(state);
    if (document.activeElement !== this.editor && this.editor.value !== text)
      this.editor.value = text;
    put("example", state.example);
    put("most", state.most);
    put("end", state.end ?? "");
    if (text !== this.shownText) {
      this.shownText = text;
      const { answer } = await this.hand.do<Answer & Parsed>(
        { task: "ask", request: { do: "parse", text } },
        5000,
      );
      if (text !== this.shownText) return;
      this.read(answer);
    }
    this.drawControls(this.store.state);
    if (!this.computing) await this.compute();
  }

  private read(answer: Answer & Parsed): void {
    this.errorLine = answer.error ? (answer.line ?? 1) : 0;
    this.parsed = answer.error ? undefined : answer;
    this.editor.setAttribute("aria-invalid", String(answer.error !== undefined));
    this.problem.hidden = answer.error === undefined;
    const place = answer.line ? `line ${answer.line}, column ${answer.column}: ` : "";
    this.problem.textContent = answer.error ? `${place}${answer.error}` : "";
    this.drawGutter();
    if (!this.parsed) return;
    const { state } = this.store;
    const names = this.parsed.parameters.map((it) => it.name);
    const patch: Partial<State> = {};
    const unknown = Object.keys(state.set).filter((name) => !names.includes(name));
    if (unknown.length)
      patch.set = Object.fromEntries(
        Object.entries(state.set).filter(([name]) => names.includes(name)),
      );
    if (
      names.length >= 2 &&
      !(names.includes(state.across) && names.includes(state.up) && state.across !== state.up)
    ) {
      const [across = "", up = ""] = [...this.parsed.parameters]
        .sort((one, other) => Number(!!other.range) - Number(!!one.range))
        .map((it) => it.name);
      const axis = (name: string): Axis => ({
        low: this.rangeOf(name)[0],
        high: this.rangeOf(name)[1],
        log: false,
      });
      Object.assign(patch, { across, up, sx: axis(across), sy: axis(up) });
    }
    if (Object.keys(patch).length) this.store.change(patch);
    this.changed();
  }

  private computing = false;

  /** Computes the run of the present state. While it does, only the last of other states waits. */
  private async compute(): Promise<void> {
    const { state } = this.store;
    const text = this.shownText;
    const key = JSON.stringify([text, state.set, state.end]);
    if (!this.parsed || key === this.runKey) return;
    this.runKey = key;
    this.computing = true;
    const request = { do: "run", text, set: state.set, end: state.end };
    const { answer } = await this.hand.do<Answer & Run>({ task: "ask", request }, 8000);
    this.computing = false;
    if (text === this.shownText) this.take(answer);
    await this.compute();
  }

  private take(answer: Answer & Run): void {
    this.run = answer.error ? undefined : answer;
    this.chart = this.run && this.chartOf(this.run);
    const result = byId("result");
    if (answer.error)
      result.replaceChildren(make("p", { class: "error", role: "alert" }, answer.error));
    else if (this.run) result.replaceChildren(...this.told(this.run));
    if (this.chart)
      this.canvas.setAttribute("aria-label", `Course of the run. ${described(this.chart)}`);
    this.draw();
    this.changed();
  }

  private drawGutter(): void {
    const lines = this.editor.value.split("\n").length;
    this.gutter.replaceChildren(
      ...Array.from({ length: lines }, (_, index) =>
        make("span", index + 1 === this.errorLine ? { class: "wrong" } : {}, String(index + 1)),
      ),
    );
    this.gutter.scrollTop = this.editor.scrollTop;
  }

  /** Sliders and choices for the parameters. */
  private drawControls(state: State): void {
    if (!this.parsed) return;
    const { parameters } = this.parsed;
    for (const [id, name] of [
      ["across", state.across],
      ["up", state.up],
    ] as const) {
      const choice = byId<HTMLSelectElement>(id);
      choice.replaceChildren(
        ...parameters.map((it) => make("option", { value: it.name }, it.name)),
      );
      choice.value = name;
      choice.disabled = parameters.length < 2;
    }
    const box = byId("sliders");
    const names = parameters.map((it) => `${it.name} ${it.range}`).join();
    if (box.dataset.names !== names) {
      box.dataset.names = names;
      box.replaceChildren(...parameters.map((it) => this.slider(it)));
    }
    for (const { name } of parameters) {
      for (const input of box.querySelectorAll<HTMLInputElement>(`[data-parameter="${name}"]`)) {
        const value = String(this.value(name));
        if (input !== document.activeElement || input.type === "range") input.value = value;
      }
    }
  }

  private slider({ name }: Parameter): HTMLElement {
    const [low, high] = this.rangeOf(name);
    const change = (event: Event) => {
      const input = event.target as HTMLInputElement;
      const value = typed(input.value);
      if (value !== undefined)
        this.store.change({ set: { ...this.store.state.set, [name]: value } });
      if (input.type !== "range") input.value = String(this.value(name));
    };
    const step = (high - low) / 500;
    return make(
      "label",
      { class: "slider" },
      make("span", {}, name),
      make("input", {
        type: "range",
        min: low,
        max: high,
        step,
        "data-parameter": name,
        input: change,
        "aria-label": name,
      }),
      make("input", {
        type: "text",
        inputmode: "decimal",
        "data-parameter": name,
        change,
        "aria-label": `${name}, as a number`,
      }),
    );
  }

  private chartOf(run: Run): Chart {
    const colours = theme();
    const lines = [colours.velocity, colours.force, colours.spring, colours.normal];
    const components = (this.parsed?.components ?? []).map((it, place) => ({ ...it, place }));
    const shown = [
      ...components.filter((it) => !it.discrete),
      ...components.filter((it) => it.discrete),
    ].slice(0, MOST_PANELS);
    const times = run.course.map((row) => row[0] as number);
    const panels = shown.map(({ name, place }, index): Panel => {
      const values = run.course.map((row) => row[place + 1] as number);
      const finite = values.filter(Number.isFinite);
      const [low, high] = roomy(
        finite.reduce((so, it) => Math.min(so, it), Infinity),
        finite.reduce((so, it) => Math.max(so, it), -Infinity),
      );
      return {
        title: name,
        low,
        high,
        curves: [{ name, colour: lines[index % lines.length] as string, values }],
      };
    });
    const shades = run.stays.flatMap(([mode, from, to]): [number, number, string][] =>
      mode % 3 === 0
        ? []
        : [[from, to, mode % 3 === 1 ? colours.slipPositive : colours.slipNegative]],
    );
    const marks = run.events.map((event) => event.time);
    return {
      times,
      start: times[0] ?? 0,
      end: Math.max(run.time, (times[0] ?? 0) + 1e-9),
      panels,
      shades,
      marks,
      time: "time t",
    };
  }

  private told(run: Run): Node[] {
    const ends: Record<string, string> = {
      end: "at its end",
      rule: "by a rule",
      event_limit: "after too many events",
      step_limit: "after too many steps",
      stopped: "stopped",
      accumulation: `where events accumulate, at t = ${short(run.accumulation ?? 0, 8)}`,
    };
    const state = Object.entries(run.state)
      .map(([name, value]) => `${name} = ${short(value, 8)}`)
      .join(", ");
    const count = run.events.length;
    const summary = make(
      "p",
      {},
      `${count} ${count === 1 ? "event" : "events"}. The run ended ${ends[run.outcome] ?? run.outcome}, at t = ${short(run.time, 8)} in mode ${run.mode}: ${state}. Guards were ${run.decided ? "decided" : "sampled"}.`,
    );
    const header = ["", "time", "event", "from", "to"].map((name) =>
      make("th", { scope: "col" }, name),
    );
    const rows = run.events
      .slice(0, MOST_ROWS)
      .map((event, index) =>
        make(
          "tr",
          {},
          ...[String(index + 1), short(event.time, 11), event.event, event.from, event.to].map(
            (text) => make("td", {}, text),
          ),
        ),
      );
    const more =
      count > MOST_ROWS
        ? make("p", { class: "hint" }, `and ${count - MOST_ROWS} more; the CSV file has all`)
        : undefined;
    const box = make(
      "div",
      { class: "scroll", tabindex: 0, "aria-label": "events" },
      make(
        "table",
        { class: "switches" },
        make("thead", {}, make("tr", {}, ...header)),
        make("tbody", {}, ...rows),
      ),
    );
    return [summary, ...(count ? [box] : []), ...(more ? [more] : [])];
  }

  redraw(): void {
    this.chart = this.run && this.chartOf(this.run);
    this.draw();
  }

  private drawNow(): void {
    if (sizeOf(this.canvas)[0] === 0) return;
    const [context, width, height] = fit(this.canvas);
    if (this.chart) drawChart(new CanvasPen(context), this.chart, width, height, this.cursor);
  }
}
