// The course of a contact as arrays, and the chart of it.

import type { Chart, Curve, Panel } from "./chart";
import { roomy } from "./scale";
import { isAdhesive } from "./state";
import { theme } from "./theme";
import type { Contact, Law } from "./types";

const NAMES = [
  "time",
  "compression",
  "normal_velocity",
  "normal_force",
  "spring",
  "tangential_force",
  "velocity",
  "sliding",
  "limit",
] as const;
export type Course = Record<(typeof NAMES)[number], Float64Array>;

/** The columns of a course. */
export function columns({ course, stride }: Contact): Course {
  const count = course.length / stride;
  const column = (place: number) => {
    const values = new Float64Array(count);
    for (let index = 0; index < count; index++) values[index] = course[index * stride + place]!;
    return values;
  };
  return Object.fromEntries(NAMES.map((name, place) => [name, column(place)])) as Course;
}

/** The energies of a contact, as parts of that before it. With adhesion, what is stored counts as
 * lost, and what is stored is not a number. */
export interface Energies {
  normal: Float64Array;
  tangential: Float64Array;
  compression: Float64Array;
  spring: Float64Array;
  lost: Float64Array;
}

type Numbers = Partial<Record<string, number>>;

/** The energies over time: `factor` is μ²/α, which makes the tangential ones comparable. */
export function energies(
  contact: Contact,
  course: Course,
  law: Law | undefined,
  factor: number,
): Energies {
  const { kappa, psi, damping, tangential_damping = 0 } = contact.document.parameters;
  const all = 0.5 * (1 + factor * psi * psi);
  const each = (of: (index: number) => number) => course.time.map((_, index) => of(index) / all);
  const normal = each((index) => 0.5 * course.normal_velocity[index]! ** 2);
  const tangential = each((index) => 0.5 * factor * course.velocity[index]! ** 2);
  const own = law?.law;
  const [greatest, strongest] = [course.compression, course.normal_force].map((all) =>
    all.reduce((most, value) => Math.max(most, value), 0),
  ) as [number, number];
  const overlap = (index: number) => Math.max(0, course.compression[index]!);
  const adheres = isAdhesive(law?.name);
  const compression = each((index) => {
    if (adheres) return NaN;
    const x = overlap(index);
    if (own?.damping === "yielding" && damping > 1) {
      // What would come back from here: the radius is larger by what the force is weaker.
      const force = Math.max(0, course.normal_force[index]!);
      const loads = course.normal_velocity[index]! > 0;
      const radius = loads ? (force > 0 ? x ** 1.5 / force : 1) : greatest ** 1.5 / strongest;
      return 0.4 * force ** (5 / 3) * radius ** (-1 / 3);
    }
    const stiffened: Numbers = { hysteretic: 1 + damping, hardening: 1 + damping * x };
    const stiffening = stiffened[own?.damping ?? ""];
    // A hysteretic force gives back only what it holds where it falls, with a higher stiffness.
    if (stiffening) {
      const stiffness = course.normal_velocity[index]! > 0 ? stiffening : 1 + damping;
      return course.normal_force[index]! ** 2 / (2 * stiffness);
    }
    return own?.normal === "linear" ? 0.5 * x * x : 0.4 * x ** 2.5;
  });
  // The dashpot of a law is proportional to this power of the overlap.
  const powers: Numbers = { linear: 0, viscoelastic: 0.5, tsuji: 0.25 };
  const viscosity = powers[own?.damping ?? ""];
  const spring = each((index) => {
    if (adheres) return NaN;
    if (own?.history === "none") return 0;
    const x = overlap(index);
    // What is left of the force without that of the dashpot.
    const beside = own?.coulomb_test === "spring" && course.sliding[index] !== 0;
    const dashpot =
      viscosity === undefined || beside
        ? 0
        : tangential_damping * damping * x ** viscosity * course.velocity[index]!;
    const force = kappa * course.spring[index]! - dashpot;
    const stiffness = own?.tangential === "mindlin" ? kappa * Math.sqrt(x) : kappa;
    return stiffness > 0 ? (0.5 * factor * force * force) / stiffness : 0;
  });
  const stored = (index: number) => (adheres ? 0 : compression[index]! + spring[index]!);
  const lost = course.time.map(
    (_, index) => 1 - normal[index]! - tangential[index]! - stored(index),
  );
  return { normal, tangential, compression, spring, lost };
}

/** What a chart shows beside the contact itself. */
export interface Beside {
  law: Law | undefined;
  factor: number;
  pinned?: { contact: Contact; law: Law | undefined; factor: number };
}

/** The chart of forces, velocity, spring and energy. */
export function chartOf(contact: Contact, { law, factor, pinned }: Beside): Chart {
  const colours = theme();
  const course = columns(contact);
  const energy = energies(contact, course, law, factor);
  const adheres = isAdhesive(law?.name);
  const other = pinned && { course: columns(pinned.contact) };
  const otherEnergy =
    pinned && other && energies(pinned.contact, other.course, pinned.law, pinned.factor);
  const ghost = (values: Float64Array | undefined): Curve[] =>
    values && other
      ? [
          {
            name: "pinned",
            colour: colours.pinned,
            width: 1.3,
            dash: [5, 3],
            quiet: true,
            times: other.course.time,
            values,
          },
        ]
      : [];
  const { limit, normal_force } = course;
  const negative = limit.map((value) => -value);
  const simple = limit.every((value, index) => value === Math.abs(normal_force[index]!));
  const most = largest([limit, normal_force, ...(other ? [other.course.normal_force] : [])]);
  const forces: Panel = {
    title: "Forces",
    ...symmetric(most),
    curves: [
      ...ghost(other?.course.tangential_force),
      { name: simple ? "limits ±F" : "limits", colour: colours.normal, width: 1.3, dash: [4, 3], values: limit },
      { name: "", colour: colours.normal, width: 1.3, dash: [4, 3], values: negative, quiet: true },
      {
        name: "tangential Fₜ/μ",
        colour: colours.force,
        width: 2.2,
        values: course.tangential_force,
      },
    ],
  };
  const single = (
    title: string,
    name: string,
    colour: string,
    key: "velocity" | "spring",
  ): Panel => ({
    title,
    ...around([course[key], ...(other ? [other.course[key]] : [])]),
    curves: [...ghost(other?.course[key]), { name, colour, values: course[key] }],
  });
  const stored: Curve[] = [
    { name: "compression", colour: colours.faint, width: 1.5, values: energy.compression },
    { name: "spring", colour: colours.spring, width: 1.5, values: energy.spring },
  ];
  const panels: Panel[] = [
    forces,
    single("Tangential velocity", "w", colours.velocity, "velocity"),
    single("Spring", "y", colours.spring, "spring"),
    {
      title: "Energy",
      low: 0,
      high: 1,
      curves: [
        ...ghost(otherEnergy?.lost),
        { name: "normal", colour: colours.normal, width: 1.3, values: energy.normal },
        { name: "tangential", colour: colours.velocity, width: 1.5, values: energy.tangential },
        ...(adheres ? [] : stored),
        {
          name: adheres ? "stored or lost" : "lost",
          colour: colours.force,
          width: 1.8,
          values: energy.lost,
        },
      ],
    },
  ];
  const end = contact.document.contact_time;
  return {
    times: course.time,
    start: 0,
    end: other ? Math.max(end, pinned.contact.document.contact_time) : end,
    panels,
    shades: shades(course),
    marks: contact.document.switches.map((it) => it.time),
    time: "scaled time t",
  };
}

/** The phases of slip, shaded by their side. */
function shades(course: Course): [number, number, string][] {
  const { slipPositive, slipNegative } = theme();
  const found: [number, number, string][] = [];
  let from = 0;
  for (let index = 1; index <= course.time.length; index++) {
    const before = course.sliding[index - 1]!;
    if (index < course.time.length && course.sliding[index] === before) continue;
    const to = course.time[Math.min(index, course.time.length - 1)]!;
    if (before !== 0) found.push([from, to, before > 0 ? slipPositive : slipNegative]);
    from = to;
  }
  return found;
}

function largest(columns: Float64Array[]): number {
  return columns.reduce(
    (most, column) => column.reduce((so, it) => Math.max(so, Math.abs(it)), most),
    0,
  );
}

function symmetric(most: number): { low: number; high: number } {
  const [, high] = roomy(0, most * 1.05);
  return { low: -high, high };
}

function around(columns: Float64Array[]): { low: number; high: number } {
  const low = columns.reduce(
    (so, column) => column.reduce((least, it) => Math.min(least, it), so),
    0,
  );
  const high = columns.reduce(
    (so, column) => column.reduce((most, it) => Math.max(most, it), so),
    0,
  );
  const [from, to] = roomy(low, high);
  return { low: from, high: to };
}
