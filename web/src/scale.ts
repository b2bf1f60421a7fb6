// Scales of axes, linear and logarithmic, and their ticks.

import { raised, rounded, short } from "./number";

/** An interval of values, mapped to parts between 0 and 1. */
export interface Scale {
  low: number;
  high: number;
  log: boolean;
}

/** A tick of an axis. Minor ticks have no label. */
export interface Tick {
  value: number;
  label: string;
}

/** Where a value lies on a scale. */
export function part({ low, high, log }: Scale, value: number): number {
  return log ? Math.log(value / low) / Math.log(high / low) : (value - low) / (high - low);
}

/** The value at a part of a scale. */
export function value({ low, high, log }: Scale, at: number): number {
  return log ? low * Math.pow(high / low, at) : low + (high - low) * at;
}

/** The same scale, moved and stretched: its ends are those parts of the old one. */
export function stretched(scale: Scale, from: number, to: number): Scale {
  return { ...scale, low: value(scale, from), high: value(scale, to) };
}

/** The span of a scale in units of its upper end. */
export function spanOf({ low, high, log }: Scale): number {
  return log ? Math.log(high / low) : (high - low) / Math.max(1e-300, Math.abs(high));
}

/** So many digits tell the places of a span apart, and usually so many are enough. */
export function digitsOf(span: number, usual: number): number {
  return Math.max(usual, Math.min(12, 4 - Math.floor(Math.log10(Math.min(1, span)))));
}

/** The value at a part of a scale, or beside its nearer end, with six digits where they do. */
export function pointAt(axis: Scale, at: number): number {
  const inside = Math.max(0.0005, Math.min(0.9995, at));
  return rounded(value(axis, inside), digitsOf(spanOf(axis), 6));
}

/** About `count` ticks. */
export function ticks(scale: Scale, count: number): Tick[] {
  return scale.log && scale.high / scale.low > 5 ? logarithmic(scale, count) : even(scale, count);
}

/** The distance of even ticks: 1, 2 or 5 times a power of ten. */
export function step(span: number, count: number): number {
  const rough = span / Math.max(1, count);
  const power = Math.pow(10, Math.floor(Math.log10(rough)));
  const factor = [1, 2, 5, 10].find((it) => it * power >= rough * 0.999) ?? 10;
  return factor * power;
}

function even(scale: Scale, count: number): Tick[] {
  const { low, high } = scale;
  const by = step(high - low, count);
  const found: Tick[] = [];
  const first = Math.ceil(low / by - 1e-9);
  // Beyond, twelve digits do not tell ticks apart, and at last the next integer is the same one.
  if (Math.abs(first) > 1e11) return found;
  for (let index = first; index * by <= high + by * 1e-9; index++) {
    const value = Number((index * by).toPrecision(12));
    found.push({ value, label: short(value, digits(low, high, by)) });
  }
  // One tick alone does not tell a scale.
  return found.length < 2 && count < 16 ? even(scale, 2 * count) : found;
}

/** The digits that tell neighbouring ticks apart. */
function digits(low: number, high: number, by: number): number {
  const most = Math.max(Math.abs(low), Math.abs(high));
  return Math.min(12, Math.max(3, Math.ceil(Math.log10(most / by)) + 1));
}

function logarithmic({ low, high }: Scale, count: number): Tick[] {
  const decades = Math.log10(high / low);
  const every = Math.max(1, Math.ceil(decades / count));
  // Few decades have room for labels between powers of ten.
  const labelled = decades * 3 <= count * 1.4 ? [1, 2, 5] : [1];
  const found: Tick[] = [];
  for (let power = Math.floor(Math.log10(low)); power <= Math.ceil(Math.log10(high)); power++) {
    for (let digit = 1; digit < 10; digit++) {
      const at = Number(`${digit}e${power}`);
      if (at < low * (1 - 1e-12) || at > high * (1 + 1e-12)) continue;
      const named = labelled.includes(digit) && (power % every === 0 || labelled.length > 1);
      const plain = power >= -3 && power <= 4;
      const label = plain ? short(at, 3) : digit === 1 ? `10${raised(power)}` : short(at, 2);
      if (named || every === 1) found.push({ value: at, label: named ? label : "" });
    }
  }
  return found;
}

/** An interval with round ends that holds the given one, so that axes seldom move. */
export function roomy(low: number, high: number): [number, number] {
  if (!(high > low)) return [low - 1, high + 1];
  const by = step(high - low, 3);
  return [Math.floor(low / by + 1e-9) * by, Math.ceil(high / by - 1e-9) * by];
}
