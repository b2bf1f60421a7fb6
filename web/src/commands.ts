// The command line and the Python lines that compute what the page shows.

import { isAdhesive, type Ball, type State } from "./state";
import type { Axis, Collision } from "./types";

/** The least part of an axis' upper end that is traced, where it begins at 0. */
const LEAST = 1e-3;

export interface Lines {
  shell: string;
  python: string;
}

/** A contact. */
export function ofContact(state: State, { parameters }: Collision): Lines {
  const scaled = state.axes === "kappa-psi" || state.axes === "velocities";
  const { kappa, psi, damping } = parameters;
  const place = scaled
    ? [`--kappa ${kappa}`, `--psi ${psi}`]
    : [`--kappa ${kappa}`, `--ratio ${state.point[1]}`, ...reduction(state)];
  const shell = ["stickslip collide", ...place, ...options(state, damping), "--method auto"].join(
    " ",
  );
  const words = [`kappa=${kappa}`, `psi=${psi}`, ...keywords(state, damping)].join(", ");
  return {
    shell,
    python: `import stickslip\ncollision = stickslip.collide(${words})\nprint(collision)`,
  };
}

/** The impact of two spheres, in SI units. */
export function ofImpact(state: State): Lines {
  const { tangential_stiffness_kg_per_s2, damping_time_s, other } = state.bodies;
  const sphere = ({ radius_m, young_modulus_pa, poisson_ratio, density_kg_per_m3 }: Ball) =>
    `Sphere(${radius_m}, Material(young_modulus_pa=${young_modulus_pa}, poisson_ratio=${poisson_ratio}, density_kg_per_m3=${density_kg_per_m3}))`;
  const python = [
    "from stickslip import Bodies, Material, Sphere, Surface, impact",
    `one = ${sphere(state.bodies)}`,
    `other = ${other ? sphere(other) : "one"}`,
    `surface = Surface(${state.mu}, ${tangential_stiffness_kg_per_s2}, ${damping_time_s})`,
    `found = impact(Bodies(one, other, surface), normal_m_per_s=${state.point[0]}, tangential_m_per_s=${state.point[1]})`,
    "print(found.eps_t)",
  ];
  return { shell: "", python: python.join("\n") };
}

/** The boundaries of a window. */
export function ofWindow(state: State): Lines {
  const factor = state.axes === "axis-ratio" ? 1 / state.alpha : 1;
  const [kappa, other] = [ends(state.x).map((it) => it * factor), ends(state.y)];
  const ratio = state.axes !== "kappa-psi";
  const second = ratio
    ? [`--ratio ${other.join(":")}`, ...reduction(state)]
    : [`--psi ${other.join(":")}`];
  const window = [`--kappa ${kappa.join(":")}`, ...second, ...options(state, state.damping)];
  const words = [`kappa=(${kappa.join(", ")})`, `${ratio ? "ratio" : "psi"}=(${other.join(", ")})`];
  if (ratio) words.push(`mu=${state.mu}`, `alpha=${state.alpha}`);
  words.push(...keywords(state, state.damping));
  return {
    shell: `stickslip trace ${window.join(" ")} --out atlas.json --plot atlas.svg`,
    python: `import stickslip\natlas = stickslip.trace(${words.join(", ")})\nprint(atlas)`,
  };
}

/** A system, its run, which starts at a time, and its plane. */
export function ofSystem(state: State, name: string, start: number): Lines {
  const file = `${name}.slip`;
  const given = Object.entries(state.set);
  const others = given.filter(([key]) => key !== state.across && key !== state.up);
  const set = (values: [string, number][]) => values.map(([key, value]) => `--set ${key}=${value}`);
  const end = state.end === null ? [] : [`--end ${state.end}`];
  const [across, up] = [ends(state.sx, 0), ends(state.sy, 0)];
  const axes = [`--x ${state.across}=${across.join(":")}`, `--y ${state.up}=${up.join(":")}`];
  const plane = [...set(others), ...end, `--max-events ${state.most}`];
  const shell = [
    ["stickslip run", file, ...set(given), ...end].join(" "),
    ["stickslip trace", file, ...axes, ...plane, "--out atlas.json --plot atlas.svg"].join(" "),
  ].join("\n");
  const values = (of: [string, number][]) =>
    of.length ? [`parameters={${of.map(([key, value]) => `"${key}": ${value}`).join(", ")}}`] : [];
  const span = state.end === null ? [] : [`(${start}, ${state.end})`];
  const until = state.end === null ? [] : [`end=${state.end}`];
  const family = [
    "system",
    `"${state.across}"`,
    `"${state.up}"`,
    ...values(others),
    ...until,
    `max_switches=${state.most}`,
  ];
  const python = [
    "import stickslip",
    `system = stickslip.read("${file}")`,
    `found = system.solve(${[...span, ...values(given)].join(", ")})`,
    `family = stickslip.HybridFamily.of(${family.join(", ")})`,
    `atlas = stickslip.trace_family(family, (${across.join(", ")}), (${up.join(", ")}))`,
  ].join("\n");
  return { shell, python };
}

function reduction({ mu, alpha }: State): string[] {
  return [`--mu ${mu}`, `--alpha ${alpha}`];
}

function options(state: State, damping: number): string[] {
  const { axes, law, tangential, dynamic, decay, pull_off } = state;
  const given = damping > 0 ? [`--damping ${damping}`] : [];
  if (axes === "velocities") return given;
  if (law !== "paper") given.push(`--law ${law}`);
  if (tangential > 0) given.push(`--tangential-damping ${tangential}`);
  if (isAdhesive(law)) given.push(`--pull-off ${pull_off}`);
  if (decays(state))
    given.push(`--dynamic-friction ${dynamic}`, `--friction-decay ${decay}`);
  return given;
}

function keywords(state: State, damping: number): string[] {
  const { axes, law, tangential, dynamic, decay, pull_off } = state;
  const given = damping > 0 ? [`damping=${damping}`] : [];
  if (axes === "velocities") return given;
  const added = [
    ...(isAdhesive(law) ? [`"pull_off": ${pull_off}`] : []),
    ...(decays(state) ? [`"friction": {"dynamic": ${dynamic}, "decay": ${decay}}`] : []),
  ];
  if (added.length) given.push(`law={${[terms(law), ...added].join(", ")}}`);
  else if (law !== "paper") given.push(`law="${law}"`);
  if (tangential > 0) given.push(`tangential_damping=${tangential}`);
  return given;
}

/** What a named law is, as a part of a mapping. */
function terms(law: string): string {
  const [name, limited] = law.split("+");
  return `**stickslip.laws()["${name}"].law${limited ? `, "${limited}": True` : ""}`;
}

/** Whether boundaries are traced: with decaying friction and with adhesion they are not. */
export function isTraced(state: State): boolean {
  return state.axes === "velocities" || !(decays(state) || isAdhesive(state.law));
}

/** Whether friction decays with the velocity. */
function decays({ dynamic, decay }: State): boolean {
  return dynamic < 1 && decay > 0;
}

function ends({ low, high }: Axis, least = LEAST): number[] {
  return [least > 0 ? Math.max(low, least * high) : low, high];
}
