// Files of what the page shows.

import type { Course } from "./course";
import { drawChart, type Chart } from "./chart";
import { CanvasPen, SvgPen, type Pen } from "./pen";
import type { Plane } from "./plane";
import { value } from "./scale";
import { theme } from "./theme";
import { NO_COUNT, STRIDE } from "./types";

type Drawing = (pen: Pen, width: number, height: number) => void;

/** A drawing as SVG. */
export function svg(width: number, height: number, draw: Drawing): string {
  const pen = new SvgPen(width, height, theme().paper);
  draw(pen, width, height);
  return pen.document();
}

/** A drawing as PNG, in twice its size. */
export function png(width: number, height: number, draw: Drawing): Promise<Blob> {
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [2 * width, 2 * height];
  const context = canvas.getContext("2d");
  if (!context) throw new Error("no canvas");
  context.scale(2, 2);
  const pen = new CanvasPen(context);
  pen.rectangle(0, 0, width, height, theme().paper);
  draw(pen, width, height);
  return new Promise((resolve, reject) =>
    canvas.toBlob((blob) => (blob ? resolve(blob) : reject(new Error("no picture"))), "image/png"),
  );
}

export const CHART_SIZE = [760, 720] as const;

export function drawing(chart: Chart): Drawing {
  return (pen, width, height) => drawChart(pen, chart, width, height);
}

/** The course of a contact as a table. */
export function courseTable(course: Course): string {
  const names = Object.keys(course) as (keyof Course)[];
  const rows = Array.from(course.time, (_, index) =>
    names.map((name) => course[name][index]).join(","),
  );
  return `${names.join(",")}\n${rows.join("\n")}\n`;
}

/** The finished map as a table: one row for each point. */
export function mapTable(
  plane: Plane,
  names: [string, string],
  fields: string[],
): string | undefined {
  const { computed } = plane.mapping;
  if (!computed) return undefined;
  const { map, size, window } = computed;
  const [columns, rows] = size;
  const lines = [[...names, "count", ...fields.filter(Boolean)].join(",")];
  for (let row = 0; row < rows; row++) {
    const up = value(window[1], 1 - (row + 0.5) / rows);
    for (let column = 0; column < columns; column++) {
      const point = row * columns + column;
      const count = map.counts[point] as number;
      const values = fields.flatMap((name, place) =>
        name ? [map.values[point * STRIDE + place]] : [],
      );
      const across = value(window[0], (column + 0.5) / columns);
      lines.push([across, up, count === NO_COUNT ? "" : count, ...values].join(","));
    }
  }
  return `${lines.join("\n")}\n`;
}

/** A table of named columns. */
export function table(header: string[], rows: (string | number)[][]): string {
  const field = (it: string | number) =>
    /[",\n]/.test(String(it)) ? `"${String(it).replaceAll('"', '""')}"` : String(it);
  return `${[header, ...rows].map((row) => row.map(field).join(",")).join("\n")}\n`;
}
