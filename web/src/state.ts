// What the page shows: one object, whose every field can be in a link.

import type { SceneRequest, Axis, ContactTask } from "./types";

export type Tab = "spheres" | "system";
export type Axes = "kappa-psi" | "kappa-ratio" | "axis-ratio" | "velocities";
export type Quantity =
  "eps_t" | "count" | "time" | "lost" | "itinerary" | "v0" | "v1" | "v2" | "v3";

/** A homogeneous sphere. */
export interface Ball {
  radius_m: number;
  young_modulus_pa: number;
  poisson_ratio: number;
  density_kg_per_m3: number;
}

export interface Bodies extends Ball {
  /** The second sphere, if it is another one. */
  other: Ball | null;
  tangential_stiffness_kg_per_s2: number;
  damping_time_s: number;
}

export interface State {
  tab: Tab;
  axes: Axes;
  x: Axis;
  y: Axis;
  point: [number, number];
  /** A second contact, to compare with: its plane and its point. */
  pinned: Pinned | null;
  quantity: Quantity;
  law: string;
  damping: number;
  tangential: number;
  /** The dynamic friction in units of the static one, and how fast it decays with the velocity. */
  dynamic: number;
  decay: number;
  /** The scaled force that separates bodies that adhere. */
  pull_off: number;
  mu: number;
  alpha: number;
  bodies: Bodies;
  boundaries: boolean;
  points: boolean;
  limits: boolean;
  /** The system in the editor: the name of an example, or another text. */
  example: string;
  text: string | null;
  set: Record<string, number>;
  across: string;
  up: string;
  sx: Axis;
  sy: Axis;
  colour: Quantity;
  most: number;
  end: number | null;
}

/** The part of a state that makes a contact. */
export type Pinned = Pick<
  State,
  "axes" | "point" | "law" | "damping" | "tangential" | "dynamic" | "decay" | "pull_off" | "mu" | "alpha" | "bodies"
>;

/** Whether a law has adhesion. */
export function isAdhesive(law: string | undefined): boolean {
  return /^granular\/(dmt|jkr)\//.test(law ?? "");
}

/** The steel spheres of the paper's Figure 2, whose Y is in GPa. */
export const STEEL: Bodies = {
  radius_m: 0.02,
  young_modulus_pa: 210e9,
  poisson_ratio: 0.3,
  density_kg_per_m3: 7850,
  other: null,
  tangential_stiffness_kg_per_s2: 1e9,
  damping_time_s: 0,
};

export const BALL = [
  "radius_m",
  "young_modulus_pa",
  "poisson_ratio",
  "density_kg_per_m3",
] as const;

/** The sphere alone, without what is of both. */
export function ballOf({
  radius_m,
  young_modulus_pa,
  poisson_ratio,
  density_kg_per_m3,
}: Ball): Ball {
  return { radius_m, young_modulus_pa, poisson_ratio, density_kg_per_m3 };
}

export const DEFAULT: State = {
  tab: "spheres",
  axes: "kappa-psi",
  x: { low: 1, high: 100, log: true },
  y: { low: 0.02, high: 2.2, log: false },
  point: [63, 0.5],
  pinned: null,
  quantity: "eps_t",
  law: "paper",
  damping: 0,
  tangential: 0,
  dynamic: 1,
  decay: 0,
  pull_off: 0.1,
  mu: 0.4,
  alpha: 2 / 7,
  bodies: STEEL,
  boundaries: true,
  points: false,
  limits: false,
  example: "belt",
  text: null,
  set: {},
  across: "belt",
  up: "kinetic",
  sx: { low: 0.05, high: 0.8, log: false },
  sy: { low: 0, high: 0.7, log: false },
  colour: "count",
  most: 12,
  end: null,
};

/** The contact of a state. */
export function pin(state: State): Pinned {
  const { axes, point, law, damping, tangential, dynamic, decay, pull_off, mu, alpha } = state;
  const bodies = axes === "velocities" ? state.bodies : STEEL;
  return { axes, point, law, damping, tangential, dynamic, decay, pull_off, mu, alpha, bodies };
}

type Scenery = Omit<Pinned, "point">;

/** The plane of collisions of a state, or of a pinned contact in any window. */
export function scene(of: Scenery, x: Axis, y: Axis): SceneRequest {
  const { axes, law, damping, tangential, dynamic, decay, pull_off, mu, alpha, bodies } = of;
  const friction = { dynamic, decay };
  const common = { kind: "spheres" as const, x, y, axes, mu, alpha };
  return axes === "velocities"
    ? { ...common, law: "paper", damping: 0, tangential_damping: 0, bodies }
    : { ...common, law, damping, tangential_damping: tangential, friction, pull_off };
}

/** So many intervals a course has at least, on the screen and in a file. */
export const INTERVALS = { screen: 300, file: 1000 };
const ANY = { low: 1, high: 2, log: false };

/** A contact and its course as a task, which is the same in any window. */
export function taskOf(of: Pinned, intervals: number): ContactTask {
  const [x, y] = of.point;
  return { task: "contact", scene: scene(of, ANY, ANY), x, y, intervals };
}

/** A state, and the preset that it comes from. */
interface Shown {
  state: State;
  preset: string;
}

/** Listens to changes, and remembers states to go back to. */
export class Store {
  private listeners: ((state: State, before: State) => void)[] = [];
  private past: Shown[] = [];
  private future: Shown[] = [];
  private changed = 0;

  constructor(
    public state: State,
    public preset: string,
  ) {}

  listen(listener: (state: State, before: State) => void): void {
    this.listeners.push(listener);
  }

  /** Changes some fields, or to another preset. Changes within half a second are one step of
   * undoing. */
  change(patch: Partial<State>, preset = this.preset): void {
    const now = performance.now();
    const { state } = this;
    if (now - this.changed > 500)
      this.past = [...this.past.slice(-100), { state, preset: this.preset }];
    this.changed = now;
    this.future = [];
    this.become({ state: { ...state, ...patch }, preset });
  }

  undo(): void {
    this.step(this.past, this.future);
  }

  redo(): void {
    this.step(this.future, this.past);
  }

  private step(from: Shown[], to: Shown[]): void {
    const shown = from.pop();
    if (!shown) return;
    to.push({ state: this.state, preset: this.preset });
    this.changed = 0;
    this.become(shown);
  }

  private become({ state, preset }: Shown): void {
    const before = this.state;
    [this.state, this.preset] = [state, preset];
    this.listeners.forEach((listener) => listener(state, before));
  }
}
