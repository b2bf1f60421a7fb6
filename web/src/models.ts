// What the plane shows of a state: of collisions, and of a system.

import type { AxisName } from "./axes";
import type { Mark, PlaneModel } from "./plane";
import { OF_SPHERES, ofSystem, type Shown } from "./quantities";
import { scene, type Axes, type State } from "./state";
import { textOf, type SystemView } from "./system";

const stiffness = (symbol: string): AxisName => ({ symbol, name: "stiffness", unit: "" });
const ratio = (symbol: string): AxisName => ({ symbol, name: "impact ratio", unit: "" });

export const AXES: Record<Axes, [AxisName, AxisName]> = {
  "kappa-psi": [stiffness("κ"), ratio("ψ")],
  "kappa-ratio": [stiffness("κ"), ratio("gₜ/gₙ")],
  "axis-ratio": [stiffness("ακ"), ratio("gₜ/gₙ")],
  velocities: [
    { symbol: "gₙ", name: "normal velocity", unit: "m/s" },
    { symbol: "gₜ", name: "tangential velocity", unit: "m/s" },
  ],
};

/** The stiffness of the line ακ = 18 of the paper, and its gₜ/gₙ for each ψ. */
export const LINE = { kappa: 63, ratio: 1.4, highest: 4 };
/** Up to so many notches have names. */
const MOST_NAMES = 14;
/** So many components of a state are shown over the plane. */
const MOST_COMPONENTS = 3;

/** Places of the paper, and closed forms. */
export interface Places {
  letters: { name: string; ratio: number }[];
  top: [number, number][];
  small: { n: number; kappa: number }[];
}

/** κ and ψ of a unit along each axis. */
export function units({ axes, alpha, mu }: State): [number, number] {
  const psi = alpha / mu;
  switch (axes) {
    case "kappa-psi":
      return [1, 1];
    case "kappa-ratio":
      return [1, psi];
    case "axis-ratio":
      return [1 / alpha, psi];
    case "velocities":
      return [NaN, NaN];
  }
}

/** The plane of collisions. */
export function ofSpheres(state: State, { letters, top, small }: Places): PlaneModel {
  const [ofX, ofY] = units(state);
  const scaled = state.axes !== "velocities";
  const { pinned } = state;
  const mark = (kappa: number, psi: number): [number, number] => [kappa / ofX, psi / ofY];
  const limits = state.limits && scaled;
  const within = ({ kappa }: { kappa: number }) =>
    kappa / ofX >= state.x.low && kappa / ofX <= state.x.high;
  const few = small.filter(within);
  const name = (n: number) => `κ${[...String(n)].map((it) => "₀₁₂₃₄₅₆₇₈₉"[Number(it)]).join("")}`;
  const notch = ({ n, kappa }: { n: number; kappa: number }): Mark => ({
    name: few.length < MOST_NAMES ? name(n) : "",
    at: mark(kappa, 1),
  });
  const letter = (it: { name: string; ratio: number }): Mark => ({
    name: it.name,
    at: mark(LINE.kappa, it.ratio / LINE.ratio),
  });
  return {
    scene: scene(state, state.x, state.y),
    names: AXES[state.axes],
    shown: OF_SPHERES.find((it) => it.id === state.quantity) ?? (OF_SPHERES[0] as Shown),
    point: state.point,
    pinned: pinned && pinned.axes === state.axes ? pinned.point : undefined,
    boundaries: state.boundaries,
    fast: state.law === "paper" && scaled,
    marks: state.points && scaled ? letters.map(letter) : [],
    curve: limits ? top.map(([kappa, psi]) => mark(kappa, psi)) : [],
    notches: limits ? few.map(notch) : [],
    least: 0,
  };
}

let known: Shown[] = ofSystem([]);

/** The quantities of the plane of a system; the same list for the same components. */
export function quantitiesOf(system: SystemView): Shown[] {
  const components = system.parsed?.components ?? [];
  const fields = ["time", ...components.slice(0, MOST_COMPONENTS).map((it) => it.name)];
  const next = ofSystem(fields.map((it) => `${it} at the end`));
  if (next.map((it) => it.name).join() !== known.map((it) => it.name).join()) known = next;
  return known;
}

/** The plane of a system, if it has one. */
export function ofText(state: State, system: SystemView): PlaneModel | undefined {
  const found = system.scene(state, textOf(state));
  if (!found) return undefined;
  const quantities = quantitiesOf(system);
  const named = (name: string): AxisName => ({ symbol: name, name, unit: "" });
  return {
    scene: found,
    names: [named(state.across), named(state.up)],
    shown: quantities.find((it) => it.id === state.colour) ?? (quantities[0] as Shown),
    point: [system.value(state.across), system.value(state.up)],
    pinned: undefined,
    boundaries: state.boundaries,
    fast: false,
    marks: [],
    curve: [],
    notches: [],
    least: -Infinity,
  };
}
