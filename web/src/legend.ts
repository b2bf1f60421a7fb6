// The legend below the plane: a bar with values, or one chip for each count or itinerary.

import { css, isBright, ofCode, ofCount, ramp, type Rgb } from "./colours";
import { make } from "./dom";
import { short } from "./number";
import type { Legend } from "./quantities";
import { part, ticks } from "./scale";
import type { Atlas, Axis } from "./types";

const MOST_COUNTS = 40;
const MOST_ITINERARIES = 24;

/** Fills the box of the legend. */
export function showLegend(box: HTMLElement, legend: Legend, atlas: Atlas | undefined): void {
  const { shown, range, counts, by } = legend;
  if (shown.kind === "value") {
    const { name } = shown;
    box.replaceChildren(...bar(legend));
    const ends = `from ${short(range[0], 3)} to ${short(range[1], 3)}`;
    box.setAttribute("aria-label", `Colours: ${name} ${ends}`);
  } else if (shown.kind === "count") {
    const chips = counts.slice(0, MOST_COUNTS).map((it) => chip(ofCount(it, by), String(it)));
    const more = counts.length > MOST_COUNTS ? ["…"] : [];
    box.replaceChildren(make("div", { class: "chips" }, ...chips, ...more));
    box.setAttribute("aria-label", `Colours: ${shown.name}: ${counts.join(", ")}`);
  } else {
    const regions = [...(atlas?.regions ?? [])].sort((one, other) => other.share - one.share);
    const names = [...new Map(regions.map((it) => [it.code, it.itinerary]))];
    const chips = names
      .slice(0, MOST_ITINERARIES)
      .map(([code, name]) => chip(ofCode(code), name.replaceAll("-", "−")));
    box.replaceChildren(make("div", { class: "chips" }, ...chips));
    box.setAttribute("aria-label", `Colours: ${shown.name}`);
  }
}

function bar({ shown, range }: Legend): HTMLElement[] {
  const axis: Axis = { low: range[0], high: range[1], log: false };
  const stops = Array.from({ length: 17 }, (_, index) => css(ramp(shown.ramp, index / 16)));
  const marks = ticks(axis, 6)
    .filter((it) => it.label)
    .map(({ value, label }) => make("span", { style: `left:${100 * part(axis, value)}%` }, label));
  return [
    make("div", { class: "bar", style: `background:linear-gradient(to right,${stops.join()})` }),
    make("div", { class: "marks" }, ...marks),
  ];
}

function chip(colour: Rgb, words: string): HTMLElement {
  const ink = isBright(colour) ? "#111" : "#fff";
  return make("span", { style: `background:${css(colour)};color:${ink}` }, words);
}
