// The contact at the point: its spheres, its course, its numbers and its switches.

import { described, drawChart, timeAt, type Chart } from "./chart";
import { chartOf, columns, type Course } from "./course";
import type { Hand, Result } from "./crew";
import { become, byId, fit, frame, make, onceAFrame, sizeOf } from "./dom";
import { fixed, short } from "./number";
import { CanvasPen } from "./pen";
import { Spheres } from "./spheres";
import { INTERVALS, taskOf, type Pinned, type State } from "./state";
import type { Answer, Collision, Contact, Law } from "./types";

/** So many phases of an itinerary are shown. */
const MOST_PHASES = 60;

/** A state and its contact. */
export interface First {
  state: State;
  found: Promise<Result<Answer & Contact>> | undefined;
}

export class ContactView {
  contact: Contact | undefined;
  course: Course | undefined;
  chart: Chart | undefined;
  private pinned: Contact | undefined;
  private pinnedKey = "";
  private wanted = "";
  private latest: State | undefined;
  private readonly canvas = byId<HTMLCanvasElement>("course");
  private readonly spheres: Spheres;
  private cursor: number | undefined;
  private readonly draw = onceAFrame(() => this.drawNow());
  private drawn = false;
  /** Milliseconds of the worker for the last contact, and of the page for the last frame. */
  get times(): { worker: number; frame: number } {
    return { worker: this.worked, frame: frame.work };
  }
  private worked = 0;

  constructor(
    private readonly hand: Hand,
    /** The contact of the first state, which was asked for before the page was there. */
    private readonly first: First,
    private readonly laws: () => Law[],
    private readonly changed: () => void,
  ) {
    this.spheres = new Spheres(byId<HTMLCanvasElement>("spheres"), (time) => {
      this.cursor = time;
      this.draw();
    });
    const move = (event: PointerEvent) => {
      if (!this.chart) return;
      const box = this.canvas.getBoundingClientRect();
      this.cursor = timeAt(this.chart, box.width, event.clientX - box.left);
      if (!this.spheres.playing) this.spheres.seek(this.cursor);
      this.draw();
    };
    this.canvas.addEventListener("pointermove", move);
    this.canvas.addEventListener("pointerdown", move);
    this.canvas.addEventListener("pointerleave", () => {
      this.cursor = undefined;
      this.draw();
    });
    this.canvas.addEventListener("keydown", (event) => {
      const by = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
      if (!by || !this.chart) return;
      const { start, end } = this.chart;
      this.cursor = Math.max(
        start,
        Math.min(end, (this.cursor ?? start) + (by * (end - start)) / 100),
      );
      this.spheres.seek(this.cursor);
      this.draw();
      event.preventDefault();
    });
    new ResizeObserver(() => this.draw()).observe(this.canvas);
    const play = byId<HTMLButtonElement>("play");
    play.onclick = () => {
      this.spheres.toggle();
      play.textContent = this.spheres.playing ? "Pause" : "Play";
      play.setAttribute("aria-pressed", String(this.spheres.playing));
    };
    byId<HTMLSelectElement>("speed").onchange = (event) => {
      this.spheres.speed = Number((event.target as HTMLSelectElement).value);
    };
  }

  /** Shows the contact of a state, as soon as it is computed. */
  show(state: State): void {
    this.latest = state;
    const key = JSON.stringify([taskOf(state, INTERVALS.screen), state.pinned]);
    if (key === this.wanted) return;
    this.wanted = key;
    if (!this.computing) void this.compute(state, key);
  }

  private computing = false;

  private async compute(state: State, key: string): Promise<void> {
    this.computing = true;
    const pinnedKey = JSON.stringify(state.pinned);
    const { pinned } = state;
    if (pinned && pinnedKey !== this.pinnedKey) {
      const { answer } = await this.ask(pinned);
      this.pinned = answer.error ? undefined : answer;
    }
    if (!pinned) this.pinned = undefined;
    this.pinnedKey = pinnedKey;
    const first = state === this.first.state ? this.first.found : undefined;
    const { answer, ms } = await (first ?? this.ask(state));
    if (answer.error) this.refuse(answer.error);
    else this.take(state, answer);
    this.worked = ms;
    this.computing = false;
    if (this.wanted !== key) this.next();
  }

  private ask(of: Pinned): Promise<Result<Answer & Contact>> {
    return this.hand.do<Answer & Contact>(taskOf(of, INTERVALS.screen), 5000);
  }

  /** The course of the contact of a state, as fine as a file has it. */
  async fine(state: State): Promise<Course | undefined> {
    const { answer } = await this.hand.do<Answer & Contact>(taskOf(state, INTERVALS.file));
    return answer.error ? undefined : columns(answer);
  }

  /** Computes what was wanted while another contact was computed. */
  private next(): void {
    const state = this.latest;
    if (state) void this.compute(state, this.wanted);
  }

  private refuse(error: string): void {
    this.contact = this.course = this.chart = undefined;
    this.spheres.clear();
    this.canvas.setAttribute("aria-label", "Course of the contact");
    become(byId("facts"), [make("p", { class: "error", role: "alert" }, error)]);
    become(byId("switches"), []);
    this.draw();
    this.changed();
  }

  private take(state: State, contact: Contact): void {
    this.contact = contact;
    this.course = columns(contact);
    const law = this.law(state);
    const factor = factorOf(state);
    const other = state.pinned;
    const pinned =
      other && this.pinned
        ? {
            contact: this.pinned,
            law: this.law(other),
            factor: factorOf(other),
          }
        : undefined;
    this.chart = chartOf(contact, { law, factor, ...(pinned ? { pinned } : {}) });
    this.spheres.show(contact, this.course, state.mu, state.alpha);
    this.tell();
    this.draw();
    this.changed();
  }

  /** Results and switches in words, and what a screen reader is told: once a frame at the most. */
  private readonly tell = onceAFrame(() => {
    const { contact, chart } = this;
    if (!contact || !chart) return;
    become(byId("facts"), facts(contact.document, this.pinned?.document));
    become(byId("switches"), [switchTable(contact.document)]);
    this.canvas.setAttribute("aria-label", `Course of the contact. ${described(chart)}`);
  });

  private law(of: State | Pinned): Law | undefined {
    const name = of.axes === "velocities" ? "paper" : of.law.replace("+limit_damping", "");
    return this.laws().find((law) => law.name === name);
  }

  redraw(): void {
    const state = this.latest;
    if (this.contact && state) this.take(state, this.contact);
    this.spheres.draw();
  }

  private drawNow(): void {
    if (sizeOf(this.canvas)[0] === 0) return;
    const [context, width, height] = fit(this.canvas);
    if (!this.chart) return;
    drawChart(new CanvasPen(context), this.chart, width, height, this.cursor);
    if (!this.drawn) performance.mark("first contact");
    this.drawn = true;
  }
}

/** The factor that makes tangential energies comparable with normal ones. Without friction, ψ is
 * (gₜ/gₙ)·α. */
function factorOf({ mu, alpha }: State | Pinned): number {
  return (mu || 1) ** 2 / alpha;
}

/** The itinerary with one mark for each phase. */
export function phases(itinerary: string): HTMLElement {
  const more = itinerary.length - MOST_PHASES;
  const shown = itinerary.slice(0, MOST_PHASES);
  const names: Record<string, string> = {
    "+": "slip on side +1",
    "-": "slip on side −1",
    o: "stick",
  };
  const marks = [...shown].map((char) =>
    make(
      "i",
      {
        class: char === "o" ? "stick" : char === "+" ? "positive" : "negative",
        title: names[char] ?? "",
      },
      char === "-" ? "−" : char,
    ),
  );
  const rest = more > 0 ? ` and ${more} more` : "";
  const told = [...shown].map((char) => names[char]).join(", ") + rest;
  return make("span", { class: "itinerary", role: "img", "aria-label": told }, ...marks, rest);
}

function facts(now: Collision, pinned: Collision | undefined): Node[] {
  const error = (it: Collision) => {
    if (!it.estimate) return `tolerance 4·10⁻¹³ of each step`;
    return `${short(it.estimate.eps_t_error, 2)}${it.estimate.certain ? "" : ", itinerary not certain"}`;
  };
  const rows: [string, (it: Collision) => Node | string][] = [
    ["itinerary", (it) => phases(it.itinerary)],
    ["switches, reversals", (it) => `${it.switch_count}, ${it.reversals}`],
    ["εₜ", (it) => fixed(it.eps_t, 10)],
    ["εₙ", (it) => fixed(it.eps_n, 10)],
    ["contact time", (it) => fixed(it.contact_time, 9)],
    ["energy lost", (it) => `${fixed(100 * it.energy_lost, 3)} %`],
    ["error of εₜ", error],
    [
      "distance from another itinerary",
      (it) => (it.estimate ? `${fixed(100 * it.estimate.distance, 3)} % of ψ` : "—"),
    ],
    ["κ, ψ", (it) => `${short(it.parameters.kappa, 7)}, ${short(it.parameters.psi, 7)}`],
    ["damping", (it) => short(it.parameters.damping, 6)],
  ];
  if (now.units) {
    const { time_s, length_m, force_n } = now.units;
    rows.push([
      "units of time, length, force",
      (it) =>
        it === now ? `${short(time_s, 4)} s, ${short(length_m, 4)} m, ${short(force_n, 4)} N` : "",
    ]);
  }
  const head = pinned
    ? [
        make(
          "tr",
          {},
          make("td"),
          make("th", { scope: "col" }, "point"),
          make("th", { scope: "col", class: "pinned" }, "pinned"),
        ),
      ]
    : [];
  const body = rows.map(([name, of]) =>
    make(
      "tr",
      {},
      make("th", { scope: "row" }, name),
      make("td", {}, of(now)),
      pinned ? make("td", { class: "pinned" }, of(pinned)) : undefined,
    ),
  );
  const summary = `${now.switch_count} switches, εₜ ${fixed(now.eps_t, 4)}`;
  return [
    make(
      "table",
      { class: "facts", "aria-label": `Results: ${summary}` },
      make("tbody", {}, ...head, ...body),
    ),
  ];
}

function switchTable({
  switches,
  start_margin,
}: Collision & { start_margin?: number }): HTMLElement {
  if (!switches.length)
    return make(
      "p",
      { class: "hint" },
      "No switch: the contact is sliding from its beginning to its end.",
    );
  const header = ["", "time", "to", "side", "spring y", "velocity w"].map((name) =>
    make("th", { scope: "col" }, name),
  );
  const rows = switches.map((it, index) =>
    make(
      "tr",
      {},
      ...[
        String(index + 1),
        fixed(it.time, 9),
        it.to,
        it.side > 0 ? "+1" : "−1",
        short(it.spring, 9),
        short(it.velocity, 9),
      ].map((text) => make("td", {}, text)),
    ),
  );
  const note =
    start_margin === undefined
      ? undefined
      : make("caption", {}, `margin at the start ${short(start_margin, 4)}`);
  return make(
    "table",
    { class: "switches" },
    note,
    make("thead", {}, make("tr", {}, ...header)),
    make("tbody", {}, ...rows),
  );
}
