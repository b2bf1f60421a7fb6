// What a map shows: which value of a point, and its colour.

import { css, NOTHING, ofCode, ofCount, ramp, type Rgb } from "./colours";
import { short } from "./number";
import type { Quantity } from "./state";
import { NO_COUNT, STRIDE, type MapPart } from "./types";

/** A quantity with a name, and how it is coloured. */
export interface Shown {
  id: Quantity;
  name: string;
  kind: "value" | "count" | "code";
  /** The place of the value in those of a point. */
  place: number;
  ramp: "diverging" | "sequential";
  /** The ends of the ramp, unless they are those of the map's values. */
  range?: [number, number];
  /** The difference between usual neighbours of a count. */
  by: number;
}

const plain = { ramp: "sequential" as const, by: 1 };

export const OF_SPHERES: Shown[] = [
  {
    id: "eps_t",
    name: "tangential restitution εₜ",
    kind: "value",
    place: 0,
    ramp: "diverging",
    range: [-1, 1],
    by: 1,
  },
  { id: "count", name: "number of switches", kind: "count", place: 0, ramp: "sequential", by: 1 },
  { id: "time", name: "contact time", kind: "value", place: 1, ...plain },
  { id: "lost", name: "part of the energy lost", kind: "value", place: 2, ...plain },
  { id: "itinerary", name: "itinerary", kind: "code", place: 0, ...plain },
];

/** The quantities of a system with these fields. */
export function ofSystem(fields: string[]): Shown[] {
  const values = fields.flatMap((name, place): Shown[] =>
    name === "" ? [] : [{ id: `v${place}` as Quantity, name, kind: "value", place, ...plain }],
  );
  return [
    { id: "count", name: "number of events", kind: "count", place: 0, ...plain },
    { id: "itinerary", name: "sequence of events", kind: "code", place: 0, ...plain },
    ...values,
  ];
}

/** The values that the colours of a map stand for. */
export interface Legend {
  shown: Shown;
  /** The ends of the ramp. */
  range: [number, number];
  /** The counts that occur, and the step between their colours. */
  counts: number[];
  by: number;
}

/** The legend of a finished part of a map. */
export function legend(shown: Shown, map: MapPart): Legend {
  if (shown.kind === "count") {
    const found = new Set<number>();
    for (const count of map.counts) if (count !== NO_COUNT) found.add(count);
    const counts = [...found].sort((one, other) => one - other);
    const even = counts.every((count) => count % 2 === (counts[0] ?? 0) % 2);
    return { shown, range: [0, 1], counts, by: even && counts.length > 1 ? 2 : 1 };
  }
  if (shown.range || shown.kind === "code")
    return { shown, range: shown.range ?? [0, 1], counts: [], by: 1 };
  let [low, high] = [Infinity, -Infinity];
  for (let index = shown.place; index < map.values.length; index += STRIDE) {
    const value = map.values[index] as number;
    if (value < low && value > -Infinity) low = value;
    if (value > high && value < Infinity) high = value;
  }
  if (low > high) [low, high] = [0, 1];
  return { shown, range: low === high ? [low - 0.5, high + 0.5] : [low, high], counts: [], by: 1 };
}

/** The colour of a point of a map. */
export function colour({ shown, range, by }: Legend, map: MapPart, point: number): Rgb {
  const count = map.counts[point] as number;
  if (count === NO_COUNT) return NOTHING;
  if (shown.kind === "count") return ofCount(count, by);
  if (shown.kind === "code") return ofCode(map.codes[point] as number);
  const value = map.values[point * STRIDE + shown.place] as number;
  return Number.isNaN(value)
    ? NOTHING
    : ramp(shown.ramp, (value - range[0]) / (range[1] - range[0]));
}

/** The value of a point of a map in words. */
export function words({ shown }: Legend, map: MapPart, point: number): string {
  const count = map.counts[point] as number;
  if (count === NO_COUNT) return "no result";
  if (shown.kind === "value") {
    const value = map.values[point * STRIDE + shown.place] as number;
    if (Number.isNaN(value)) return shown.id === "eps_t" ? "the bodies stay together" : "no value";
    return short(value, 4);
  }
  return String(count);
}

/** A colour for CSS. */
export function swatch({ shown, range, by }: Legend, value: number): string {
  if (shown.kind === "count") return css(ofCount(value, by));
  return css(ramp(shown.ramp, (value - range[0]) / (range[1] - range[0])));
}
