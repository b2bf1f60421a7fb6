// What passes between the page, its workers and the module.

/** An answer of the module: an object, with `error` if there is no result. */
// eslint-disable-next-line @typescript-eslint/no-explicit-any
export type Answer = { error?: string; line?: number; column?: number } & Record<string, any>;

export interface Axis {
  low: number;
  high: number;
  log: boolean;
}

/** A plane as the module takes it. */
export type SceneRequest = { kind: "spheres" | "system"; x: Axis; y: Axis } & Record<
  string,
  unknown
>;

/** Rows of a map: four values, a count and a code for each point. */
export interface MapPart {
  values: Float32Array;
  counts: Uint16Array;
  codes: Uint32Array;
}

export const STRIDE = 4;
export const NO_COUNT = 65535;

/** What a worker does. */
export type Task =
  | { task: "ask"; request: object; scene?: SceneRequest }
  | ContactTask
  | { task: "map"; scene: SceneRequest; columns: number; rows: number; first: number; end: number };

export interface ContactTask {
  task: "contact";
  scene: SceneRequest;
  x: number;
  y: number;
  intervals: number;
}

export interface Boundary {
  kind: string;
  points: [number, number][];
  sides: [number | null, number | null];
}

export type Stretch =
  { curve: number; back: boolean } | { line: [[number, number], [number, number]] };

export interface Region {
  itinerary: string;
  count: number;
  code: number;
  sample: [number, number];
  share: number;
  doubtful: boolean;
  rings: Stretch[][];
}

export interface Atlas {
  boundaries: Boundary[];
  vertices: { name: string; point: [number, number] }[];
  regions: Region[];
  agrees: boolean;
  objection: string | null;
  low: [number, number];
  high: [number, number];
}

export interface Switch {
  time: number;
  time_left: number;
  to: "slip" | "stick";
  side: number;
  spring: number;
  velocity: number;
}

/** A collision, as `stickslip collide --format json` prints it, and what the page adds. */
export interface Collision {
  parameters: {
    kappa: number;
    psi: number;
    damping: number;
    tangential_damping?: number;
  };
  method: { name: string };
  eps_n: number;
  eps_t: number;
  w_final: number;
  contact_time: number;
  switch_count: number;
  reversals: number;
  itinerary: string;
  switches: Switch[];
  estimate?: { eps_t_error: number; distance: number; certain: boolean };
  energy_lost: number;
  code: number;
  units?: { time_s: number; length_m: number; force_n: number };
}

export interface Contact {
  document: Collision;
  course: Float64Array;
  stride: number;
}

export interface Law {
  name: string;
  code: string;
  equations: string;
  energy: string;
  tangential: boolean;
  law: {
    normal: "linear" | "hertz" | "dmt" | "jkr";
    damping: "none" | "linear" | "viscoelastic" | "tsuji" | "hysteretic" | "hardening" | "yielding";
    tangential: "constant" | "mindlin";
    history: "displacement" | "force" | "none";
    coulomb_test?: "total" | "spring";
  };
  source: string;
  checked: string;
}
