// Links: the fragment of an address, with what differs from a preset.

import { EXAMPLES } from "./examples";
import { AXES } from "./models";
import { PRESETS, presetOf } from "./presets";
import { ballOf, DEFAULT, pin, STEEL, type State } from "./state";
import { mostOf } from "./system";
import type { Axis } from "./types";

type Json = unknown;

/** The fragment of a state. */
export function encoded(state: State, preset: string): string {
  const base = presetOf(preset).state;
  const query = new URLSearchParams();
  if (preset !== PRESETS[0]?.id) query.set("preset", preset);
  for (const key of Object.keys(DEFAULT) as (keyof State)[]) {
    const [one, other] = [JSON.stringify(state[key]), JSON.stringify(base[key])];
    if (one !== other) query.set(key, typeof state[key] === "string" ? String(state[key]) : one);
  }
  return query.toString();
}

/** The state of a fragment. What is not understood is left out. */
export function decoded(fragment: string): { state: State; preset: string } {
  const query = new URLSearchParams(fragment.replace(/^#/, ""));
  const { id, state } = presetOf(query.get("preset"));
  const found: Record<string, Json> = { ...state };
  for (const key of Object.keys(DEFAULT) as (keyof State)[]) {
    const text = query.get(key);
    if (text === null) continue;
    const value = read(key, text);
    if (value !== undefined) found[key] = value;
  }
  return { state: found as unknown as State, preset: id };
}

function read(key: keyof State, text: string): Json {
  const model: Json = DEFAULT[key];
  if (key === "text") return text;
  if (typeof model === "string") return fits(text, model, key) ? text : undefined;
  try {
    const given: Json = JSON.parse(text);
    // A link may leave out what is as usual.
    const usual = { bodies: model as object, pinned: LATER }[key as string];
    const value = usual && isRecord(given) ? { ...usual, ...given } : given;
    return fits(value, model, key) ? value : undefined;
  } catch {
    return undefined;
  }
}

/** Whether a value has the form of the usual one. */
function fits(value: Json, model: Json, key: string): boolean {
  if (typeof value === "string" && FORMS[key] && !FORMS[key].test(value)) return false;
  if (key === "example") return typeof value === "string" && Object.hasOwn(EXAMPLES, value);
  if (key === "tab") return value === "spheres" || value === "system";
  if (key === "axes") return typeof value === "string" && Object.hasOwn(AXES, value);
  if (key === "set")
    return (
      isRecord(value) &&
      Object.entries(value).every(([name, it]) => NAME.test(name) && isNumber(it))
    );
  if (key === "most") return isNumber(value) && value === mostOf(value);
  if (key === "end") return value === null || isNumber(value);
  if (key === "pinned") return value === null || same(value, PINNED);
  if (key === "other") return value === null || same(value, ballOf(STEEL));
  if (["x", "y", "sx", "sy"].includes(key))
    return same(value, model as object) && isAxis(value as Axis);
  if (Array.isArray(model))
    return Array.isArray(value) && value.length === model.length && value.every(isNumber);
  if (isRecord(model)) return same(value, model);
  return typeof value === typeof model && (typeof value !== "number" || isNumber(value));
}

const NAME = /^[\p{Alphabetic}_][\p{Alphabetic}\p{N}_]*$/u;
/** The forms of words that lines to copy are made of: nobody else's commands may be in them. */
const FORMS: Record<string, RegExp> = {
  law: /^[\w/+.-]+$/,
  across: NAME,
  up: NAME,
  quantity: /^(eps_t|count|time|lost|itinerary)$/,
  colour: /^(count|itinerary|v[0-3])$/,
};

const PINNED = pin(DEFAULT);
/** What older links leave out of a pinned contact. */
const LATER = { dynamic: 1, decay: 0, pull_off: DEFAULT.pull_off };

/** Whether a value has all fields of a model, each of its form. */
function same(value: Json, model: object): boolean {
  return isRecord(value) && Object.entries(model).every(([key, it]) => fits(value[key], it, key));
}

function isAxis({ low, high, log }: Axis): boolean {
  return low < high && (low > 0 || !log);
}

function isRecord(value: Json): value is Record<string, Json> {
  return typeof value === "object" && value !== null && !Array.isArray(value);
}

function isNumber(value: Json): value is number {
  return typeof value === "number" && Number.isFinite(value);
}
