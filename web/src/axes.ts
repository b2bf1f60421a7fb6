// The axes of the plane: frame, ticks, notches and captions.

import type { Path, Pen } from "./pen";
import type { PlaneModel } from "./plane";
import { part, ticks } from "./scale";
import { theme } from "./theme";

export interface AxisName {
  symbol: string;
  name: string;
  unit: string;
}

/** Room around the map, in pixels. */
export const LEFT = 58;
export const RIGHT = 14;
export const TOP = 12;
export const BOTTOM = 46;

/** Draws the axes around a map of this size. */
export function drawAxes(
  pen: Pen,
  { scene, names, notches }: Pick<PlaneModel, "scene" | "names" | "notches">,
  [across, down]: [number, number],
): void {
  const { ink, faint } = theme();
  const [horizontal, vertical] = names;
  const bottom = TOP + down;
  const frame: Path = [
    [LEFT, TOP],
    [LEFT + across, TOP],
    [LEFT + across, bottom],
    [LEFT, bottom],
    [LEFT, TOP],
  ];
  pen.line(frame, { colour: faint, width: 1 });
  let free = -Infinity;
  for (const { value, label } of ticks(scene.x, across / 75)) {
    const x = LEFT + part(scene.x, value) * across;
    pen.line(
      [
        [x, bottom],
        [x, bottom + (label ? 6 : 3)],
      ],
      { colour: ink },
    );
    const half = label.length * 3.6;
    if (!label || x - half < free || x + half > LEFT + across + RIGHT) continue;
    free = x + half + 6;
    pen.text(label, x, bottom + 19, { colour: ink, align: "center" });
  }
  for (const { value, label } of ticks(scene.y, down / 55)) {
    const y = TOP + (1 - part(scene.y, value)) * down;
    pen.line(
      [
        [LEFT, y],
        [LEFT - (label ? 6 : 3), y],
      ],
      { colour: ink },
    );
    if (label) pen.text(label, LEFT - 9, y + 4, { colour: ink, align: "right" });
  }
  for (const { at, name } of notches) {
    const x = LEFT + part(scene.x, at[0]) * across;
    if (x < LEFT || x > LEFT + across) continue;
    pen.area(
      [
        [x, bottom - 1],
        [x - 4, bottom - 8],
        [x + 4, bottom - 8],
      ],
      "#111",
      { colour: "#fff", width: 1 },
    );
    if (name)
      pen.text(name, x, bottom - 11, { colour: "#111", size: 11, align: "center", halo: "#fff" });
  }
  const caption = ({ symbol, name, unit }: AxisName) =>
    [name === symbol ? "" : name, symbol, unit ? `in ${unit}` : ""].filter(Boolean).join(" ");
  pen.text(caption(horizontal), LEFT + across / 2, bottom + 38, {
    colour: ink,
    align: "center",
    size: 13,
  });
  pen.text(caption(vertical), 14, TOP + down / 2, {
    colour: ink,
    align: "center",
    size: 13,
    up: true,
  });
}
