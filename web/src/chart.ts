// Panels of curves over time, one above the other, with one axis of time.

import { fixed, short } from "./number";
import type { Pen, Track } from "./pen";
import { part, ticks } from "./scale";
import { theme } from "./theme";
import type { Axis } from "./types";

export interface Curve {
  name: string;
  colour: string;
  width?: number;
  dash?: number[];
  /** Values at the times of the chart, or at own times. */
  values: ArrayLike<number>;
  times?: ArrayLike<number>;
  /** Whether its value is told under the pointer. */
  quiet?: boolean;
}

export interface Panel {
  title: string;
  low: number;
  high: number;
  curves: Curve[];
}

export interface Chart {
  times: ArrayLike<number>;
  end: number;
  start: number;
  panels: Panel[];
  /** Shaded times: from, to, colour. */
  shades: [number, number, string][];
  /** Marked times. */
  marks: number[];
  /** The axis of time in words. */
  time: string;
}

const LEFT = 54;
const RIGHT = 10;
const GAP = 24;
const BOTTOM = 34;
/** More marks would hide the curves. */
const MOST_MARKS = 60;

/** Draws a chart; `cursor` is a time that is marked and told. */
export function drawChart(
  pen: Pen,
  chart: Chart,
  width: number,
  height: number,
  cursor?: number,
): void {
  const { panels } = chart;
  const { ink, faint } = theme();
  const across = width - LEFT - RIGHT;
  const each = (height - BOTTOM) / panels.length;
  const time: Axis = { low: chart.start, high: chart.end, log: false };
  const x = (at: number) => LEFT + part(time, at) * across;
  panels.forEach((panel, index) => {
    const top = index * each + GAP;
    const down = each - GAP - 2;
    const axis: Axis = { low: panel.low, high: panel.high, log: false };
    const y = (value: number) => top + (1 - part(axis, value)) * down;
    pen.within(LEFT, top, across, down, () => {
      for (const [from, to, colour] of chart.shades) {
        pen.rectangle(x(from), top, Math.max(0.5, x(to) - x(from)), down, colour);
      }
      for (const mark of chart.marks.length > MOST_MARKS ? [] : chart.marks)
        pen.line(
          [
            [x(mark), top],
            [x(mark), top + down],
          ],
          { colour: faint, width: 0.7 },
        );
      if (panel.low < 0 && panel.high > 0)
        pen.line(
          [
            [LEFT, y(0)],
            [LEFT + across, y(0)],
          ],
          { colour: faint, width: 1 },
        );
      for (const curve of panel.curves) {
        const stroke = { colour: curve.colour, width: curve.width ?? 1.8, dash: curve.dash ?? [] };
        pen.curve(trackOf(curve, chart, x, y), stroke);
      }
    });
    pen.line(
      [
        [LEFT, top],
        [LEFT, top + down],
        [LEFT + across, top + down],
      ],
      { colour: faint, width: 1 },
    );
    for (const { value, label } of ticks(axis, down / 30)) {
      pen.line(
        [
          [LEFT - 4, y(value)],
          [LEFT, y(value)],
        ],
        { colour: faint },
      );
      pen.text(label, LEFT - 7, y(value) + 4, { colour: ink, size: 11, align: "right" });
    }
    caption(pen, chart, panel, top - 7, width - RIGHT, cursor);
  });
  const bottom = height - BOTTOM;
  for (const { value, label } of ticks(time, across / 70)) {
    pen.text(label, x(value), bottom + 15, { colour: ink, size: 11, align: "center" });
    pen.line(
      [
        [x(value), bottom - 2],
        [x(value), bottom + 3],
      ],
      { colour: faint },
    );
  }
  pen.text(chart.time, LEFT + across / 2, bottom + 30, { colour: ink, size: 12, align: "center" });
  if (cursor !== undefined)
    pen.line(
      [
        [x(cursor), GAP],
        [x(cursor), bottom],
      ],
      { colour: ink, width: 1 },
    );
}

/** The time at a place in pixels. */
export function timeAt(chart: Chart, width: number, at: number): number {
  const share = Math.max(0, Math.min(1, (at - LEFT) / (width - LEFT - RIGHT)));
  return chart.start + share * (chart.end - chart.start);
}

function trackOf(
  { times = [], values }: Curve,
  chart: Chart,
  x: (at: number) => number,
  y: (at: number) => number,
): Track {
  const own = times.length ? times : chart.times;
  return {
    length: own.length,
    x: (index) => x(own[index] as number),
    y: (index) => y(values[index] ?? NaN),
  };
}

/** The title of a panel, and the names of its curves, with values under the pointer. */
function caption(
  pen: Pen,
  chart: Chart,
  panel: Panel,
  y: number,
  right: number,
  cursor?: number,
): void {
  const { ink } = theme();
  pen.text(panel.title, LEFT, y, { colour: ink, size: 12, bold: true });
  const room = right - LEFT - panel.title.length * 7 - 16;
  const told = panel.curves.filter((curve) => !curve.quiet);
  const names = told.map((curve) =>
    cursor === undefined ? curve.name : `${curve.name} ${fixed(valueAt(curve, chart, cursor), 4)}`,
  );
  let end = right;
  const widths = names.map((name) => name.length * 6.7 + 24);
  const shown = told.map(
    (_, index) => widths.slice(index).reduce((sum, it) => sum + it, 0) <= room,
  );
  for (let index = told.length - 1; index >= 0; index--) {
    const curve = told[index] as Curve;
    if (!shown[index]) continue;
    pen.text(names[index] as string, end, y, { colour: ink, size: 11, align: "right" });
    const left = end - (widths[index] as number) + 8;
    pen.line(
      [
        [left, y - 4],
        [left + 10, y - 4],
      ],
      { colour: curve.colour, width: 2.4, dash: curve.dash ? [3, 2] : [] },
    );
    end = left - 8;
  }
}

/** The value of a curve at a time. */
export function valueAt(curve: Curve, chart: Chart, time: number): number {
  const { times = chart.times, values } = curve;
  let [low, high] = [0, times.length - 1];
  if (high < 0 || time < (times[0] as number) || time > (times[high] as number)) return NaN;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if ((times[middle] as number) <= time) low = middle;
    else high = middle;
  }
  const [from, to] = [times[low] as number, times[high] as number];
  const share = to > from ? (time - from) / (to - from) : 0;
  return (values[low] as number) + share * ((values[high] as number) - (values[low] as number));
}

/** A chart in one sentence, for those who do not see it. */
export function described(chart: Chart): string {
  const parts = chart.panels.map(
    ({ title, low, high }) => `${title} from ${short(low, 3)} to ${short(high, 3)}`,
  );
  return `${chart.time} from ${short(chart.start, 3)} to ${short(chart.end, 4)}: ${parts.join("; ")}.`;
}
