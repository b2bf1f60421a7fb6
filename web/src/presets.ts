// Views that tell the story of the paper.

import { DEFAULT, STEEL, type State } from "./state";

export interface Preset {
  id: string;
  name: string;
  caption: string;
  state: State;
}

const figure = { axes: "axis-ratio" as const, mu: 0.4, alpha: 2 / 7 };

function preset(id: string, name: string, caption: string, state: Partial<State>): Preset {
  return { id, name, caption, state: { ...DEFAULT, ...state } };
}

export const PRESETS: Preset[] = [
  preset(
    "plane",
    "The whole plane",
    "Tangential restitution εₜ over stiffness κ and impact ratio ψ. Lines are boundaries on which " +
      "the switching between slip and stick changes.",
    {},
  ),
  preset(
    "figure1",
    "Figure 1: pure Coulomb sliding",
    "With a spring so stiff that it hardly moves, εₜ is that of Coulomb sliding: it depends on " +
      "gₜ/gₙ alone. Either the spheres slide to the end, or their surfaces come to rest.",
    {
      axes: "velocities",
      x: { low: 0, high: 2, log: false },
      y: { low: 0, high: 2, log: false },
      point: [0.5, 1],
      bodies: { ...STEEL, tangential_stiffness_kg_per_s2: 1e12 },
      boundaries: false,
    },
  ),
  preset(
    "figure2",
    "Figure 2: two steel spheres",
    "Steel spheres of 2 cm radius at 20 m/s. The tangential force swings many times while the " +
      "normal force rises and falls.",
    {
      axes: "velocities",
      x: { low: 5, high: 40, log: true },
      y: { low: 0.5, high: 40, log: true },
      point: [20, 4],
      bodies: { ...STEEL, tangential_stiffness_kg_per_s2: 1e12 },
      boundaries: false,
    },
  ),
  preset(
    "figure3",
    "Figure 3: restitution",
    "εₜ over stiffness and impact ratio, as the paper draws it: over ακ. Where it is negative, the " +
      "tangential velocity is reversed.",
    {
      ...figure,
      x: { low: 0, high: 20, log: false },
      y: { low: 0, high: 3.5, log: false },
      point: [6, 1],
      boundaries: false,
    },
  ),
  preset(
    "figure4",
    "Figure 4: number of switches",
    "The number of switches, with the points a to o of the paper on the line ακ = 18.",
    {
      ...figure,
      x: { low: 0, high: 20, log: false },
      y: { low: 0, high: 4, log: false },
      point: [18, 1.55],
      quantity: "count",
      points: true,
    },
  ),
  preset(
    "figure5",
    "Figure 5: forces at a point",
    "One contact of the line ακ = 18, with its tangential force between the Coulomb limits. Drag it " +
      "along the line, or choose a letter.",
    {
      ...figure,
      x: { low: 14, high: 20, log: false },
      y: { low: 0, high: 3.2, log: false },
      point: [18, 1.55],
      quantity: "itinerary",
      points: true,
    },
  ),
  preset(
    "figure6",
    "Figure 6: a stiff spring",
    "At ακ = 100 and gₜ/gₙ = 0.3 the spring swings many times between its limits, and little of " +
      "the tangential motion is left.",
    {
      ...figure,
      x: { low: 10, high: 200, log: true },
      y: { low: 0.05, high: 1.5, log: true },
      point: [100, 0.3],
    },
  ),
  preset(
    "damped",
    "Damped spheres",
    "With damping a contact begins in stick, and every number of switches is odd.",
    { damping: 0.1, point: [40, 0.6], quantity: "count" },
  ),
  preset(
    "hooke",
    "A law of a particle code",
    "LAMMPS’ gran/hooke/history: linear forces, whose boundaries are another pattern.",
    {
      law: "gran/hooke/history",
      damping: 0.2,
      x: { low: 2, high: 6, log: true },
      y: { low: 0.2, high: 1.6, log: false },
      point: [4, 0.5],
    },
  ),
];

export function presetOf(id: string | null): Preset {
  return PRESETS.find((it) => it.id === id) ?? (PRESETS[0] as Preset);
}
