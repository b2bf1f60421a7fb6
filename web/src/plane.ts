// The plane: a map as colours, with axes, boundaries, regions, and a point that one drags.

import { BOTTOM, drawAxes, LEFT, RIGHT, TOP, type AxisName } from "./axes";
import { byId, fit, onceAFrame, sizeOf } from "./dom";
import type { Crew, Hand } from "./crew";
import { listen } from "./gestures";
import { Mapping } from "./mapping";
import { rounded, short } from "./number";
import { CanvasPen, type Path, type Pen } from "./pen";
import { words, type Shown } from "./quantities";
import { digitsOf, part, pointAt, spanOf, stretched, value } from "./scale";
import { theme } from "./theme";
import type { Answer, Atlas, Axis, Region, SceneRequest } from "./types";

/** A letter, a curve or a mark that the page adds. */
export interface Mark {
  at: [number, number];
  name: string;
}

/** What a plane shows. */
export interface PlaneModel {
  scene: SceneRequest;
  names: [AxisName, AxisName];
  shown: Shown;
  point: [number, number];
  pinned: [number, number] | undefined;
  boundaries: boolean;
  /** Whether a point takes microseconds. */
  fast: boolean;
  marks: Mark[];
  /** A curve that is dashed, such as a closed form. */
  curve: [number, number][];
  /** Values of the horizontal axis that are marked below it. */
  notches: Mark[];
  /** The least value that an axis may have. */
  least: number;
}

export interface PlaneEvents {
  point(point: [number, number]): void;
  window(x: Axis, y: Axis): void;
  /** The region and the value under the pointer, in words. */
  told(words: string): void;
  /** How far map and boundaries are. */
  status(words: string): void;
}

/** The regions and boundaries of an atlas in pixels. */
interface Paths {
  of: Atlas | undefined;
  /** The window and its size. */
  key: string;
  regions: Path2D[];
  lines: Path2D[];
}

const DASHES: Record<string, number[]> = {
  "stick-graze": [6, 4],
  graze: [6, 4],
  "slip-graze": [2, 3],
  order: [2, 3],
  "start-of-contact": [8, 3, 2, 3],
  "start-of-tail": [2, 5],
  branch: [8, 3, 2, 3],
};

export class Plane {
  readonly mapping: Mapping;
  atlas: Atlas | undefined;
  /** Curves of the atlas that is being traced. */
  found: Float64Array[] = [];
  private atlasKey = "";
  private atlasNote = "";
  /** The scene of the atlas. */
  private tracedKey = "";
  private model: PlaneModel | undefined;
  private hovered: [number, number] | undefined;
  private timer: ReturnType<typeof setTimeout> | undefined;
  private paths: Paths = { of: undefined, key: "", regions: [], lines: [] };
  private readonly draw = onceAFrame(() => this.drawNow());
  /** What is drawn again only when it changes, below what follows the pointer. */
  private readonly ground = byId<HTMLCanvasElement>("map");
  private readonly canvas = byId<HTMLCanvasElement>("plane");
  private grounded = "";
  /** The region that is outlined. */
  private outlined: string | undefined;
  /** The point, which is moved without drawing anything. */
  private readonly mark = byId("point");
  private computed = "";

  constructor(
    crew: Crew,
    private readonly tracer: Hand,
    private readonly events: PlaneEvents,
  ) {
    const { canvas } = this;
    this.mapping = new Mapping(crew, () => {
      this.redraw();
      this.report();
    });
    listen(canvas, {
      grab: (x, y) => this.grab(x, y),
      point: (x, y) => this.events.point(this.valuesAt(x, y)),
      move: (dx, dy, zoom, x, y) => this.move(dx, dy, zoom, x, y),
      hover: (place, dragging) => {
        this.hovered = place;
        this.draw();
        const line = place && !dragging ? this.lineAt(...place) : undefined;
        this.events.told(place ? [this.tellAt(...place), line].filter(Boolean).join(" · ") : "");
      },
      step: (dx, dy, fine) => this.step(dx, dy, fine),
    });
    new ResizeObserver(() => {
      if (this.model) this.show(this.model);
    }).observe(canvas);
  }

  /** The size of the map in pixels. */
  private get size(): [number, number] {
    const [width, height] = sizeOf(this.canvas);
    return [Math.max(40, width - LEFT - RIGHT), Math.max(40, height - TOP - BOTTOM)];
  }

  /** Shows a model; computes what is new in it. */
  show(model: PlaneModel): void {
    const before = this.model;
    this.model = model;
    if (before && subject(model.scene) !== subject(before.scene)) this.mapping.forget();
    if (model.shown !== before?.shown) this.mapping.show(model.shown);
    const [width, height] = this.size.map(Math.round) as [number, number];
    const key = JSON.stringify([model.scene, width, height]);
    if (key !== this.computed && sizeOf(this.canvas)[0] > 0) {
      this.computed = key;
      this.mapping.compute(model.scene, width, height, model.fast ? [6, 1] : [16, 5, 2]);
    }
    this.wantAtlas();
    this.outline();
    this.draw();
  }

  /** Until boundaries are traced, the map shows where itineraries change. */
  private outline(): void {
    this.mapping.outline(this.model?.boundaries === true && !this.atlas);
  }

  private wantAtlas(): void {
    const { model } = this;
    if (!model) return;
    const key = JSON.stringify(model.scene);
    if (!model.boundaries || key === this.atlasKey) return;
    if (sceneWithoutWindow(key) !== sceneWithoutWindow(this.atlasKey)) this.atlas = undefined;
    this.atlasKey = key;
    this.found = [];
    if (this.tracer.busy) this.tracer.restart();
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.trace(key, model.scene), model.fast ? 60 : 300);
    this.atlasNote = "tracing boundaries …";
    this.report();
  }

  private async trace(key: string, scene: SceneRequest): Promise<void> {
    const { answer, ms } = await this.tracer.do<Answer & Atlas>(
      { task: "ask", scene, request: { do: "atlas" } },
      300_000,
      (curve) => this.follow(key, curve),
    );
    if (key !== this.atlasKey) return;
    this.found = [];
    if (answer.error) {
      this.atlas = undefined;
      this.atlasNote = answer.error === "cancelled" ? "" : `no boundaries: ${answer.error}`;
    } else {
      this.atlas = answer;
      this.tracedKey = key;
      const doubts = answer.regions.filter((region) => region.doubtful).length;
      const doubt = doubts ? `, ${doubts} in doubt` : "";
      const { length } = answer.regions;
      this.atlasNote = `${length} ${length === 1 ? "region" : "regions"}${doubt}, ${answer.boundaries.length} boundaries traced in ${Math.round(ms)} ms`;
    }
    this.outline();
    this.report();
    this.redraw();
  }

  /** Shows a curve before the others. */
  private follow(key: string, curve: Float64Array): void {
    if (key !== this.atlasKey) return;
    this.found.push(curve);
    this.atlasNote = `tracing boundaries … ${this.found.length}`;
    this.report();
    this.redraw();
  }

  private report(): void {
    const { model, mapping } = this;
    const [width, height] = mapping.data.size;
    const took = `map ${width} × ${height} in ${Math.round(mapping.took)} ms`;
    const done = mapping.refusal ? `no whole map: ${mapping.refusal}` : took;
    const map = mapping.ready ? done : "computing the map …";
    this.events.status(model?.boundaries ? `${map}; ${this.atlasNote}` : map);
  }

  private valuesAt(x: number, y: number): [number, number] {
    const { model } = this;
    if (!model) return [1, 1];
    const [width, height] = this.size;
    return [
      pointAt(model.scene.x, (x - LEFT) / width),
      pointAt(model.scene.y, 1 - (y - TOP) / height),
    ];
  }

  private toPixels([x, y]: [number, number]): [number, number] {
    const { model } = this;
    if (!model) return [0, 0];
    const [width, height] = this.size;
    return [LEFT + part(model.scene.x, x) * width, TOP + (1 - part(model.scene.y, y)) * height];
  }

  private grab(x: number, y: number): "point" | "window" {
    const [width, height] = this.size;
    const inside = x >= LEFT && x <= LEFT + width && y >= TOP && y <= TOP + height;
    return inside ? "point" : "window";
  }

  private move(dx: number, dy: number, zoom: number, x: number, y: number): void {
    const { model } = this;
    if (!model) return;
    const [width, height] = this.size;
    const about = [(x - LEFT) / width, 1 - (y - TOP) / height] as const;
    const by = [dx / width, -dy / height] as const;
    // Over an axis, the window is zoomed along this axis alone.
    const along = [
      x < LEFT && zoom !== 1 ? 1 : zoom,
      y > TOP + height && zoom !== 1 ? 1 : zoom,
    ] as const;
    const moved = [model.scene.x, model.scene.y].map((axis, index) => {
      const [at, shift, factor] = [
        about[index as 0 | 1],
        by[index as 0 | 1],
        along[index as 0 | 1],
      ];
      const from = at - at / factor - shift / factor;
      return this.allowed(stretched(axis, from, from + 1 / factor), axis);
    }) as [Axis, Axis];
    this.events.window(...moved);
  }

  /** A window within what is possible, with ends that are no longer than they have to be. */
  private allowed(axis: Axis, before: Axis): Axis {
    const least = axis.log
      ? Math.max(1e-6, this.model?.least ?? 1e-6)
      : (this.model?.least ?? -Infinity);
    const span = spanOf(axis);
    if (!(span > 2e-6) || !(axis.high < 1e9) || !Number.isFinite(axis.low)) return before;
    if (axis.log && span > 25) return before;
    const digits = digitsOf(span, 4);
    const low = rounded(Math.max(least, axis.low), digits);
    const high = rounded(axis.high, digits);
    return low < high ? { ...axis, low, high } : before;
  }

  private step(dx: number, dy: number, fine: boolean): void {
    const { model } = this;
    if (!model) return;
    const by = fine ? 0.001 : 0.01;
    const at = [part(model.scene.x, model.point[0]), part(model.scene.y, model.point[1])] as const;
    this.events.point([
      pointAt(model.scene.x, at[0] + dx * by),
      pointAt(model.scene.y, at[1] + dy * by),
    ]);
  }

  /** The region at a place in pixels. */
  private regionAt(x: number, y: number): Region | undefined {
    const { atlas } = this;
    if (!atlas || !this.model?.boundaries) return undefined;
    const context = this.canvas.getContext("2d");
    // Paths are scaled with the canvas, and the place is not.
    const ratio = window.devicePixelRatio || 1;
    const index = this.pathsOf(atlas).regions.findIndex((path) =>
      context?.isPointInPath(path, x * ratio, y * ratio, "evenodd"),
    );
    return atlas.regions[index];
  }

  /** The name of the vertex or boundary at a place in pixels. */
  private lineAt(x: number, y: number): string | undefined {
    const { atlas } = this;
    const context = this.canvas.getContext("2d");
    if (!atlas || !context || !this.model?.boundaries) return undefined;
    const near = ([atX, atY]: [number, number]) => Math.hypot(atX - x, atY - y) < 7;
    const vertex = atlas.vertices.find((it) => near(this.toPixels(it.point)));
    if (vertex) return `vertex: ${vertex.name}`;
    const ratio = window.devicePixelRatio || 1;
    context.lineWidth = 8;
    const index = this.pathsOf(atlas).lines.findIndex((path) =>
      context.isPointInStroke(path, x * ratio, y * ratio),
    );
    const kind = atlas.boundaries[index]?.kind;
    return kind && `boundary: ${kind.replaceAll("-", " ")}`;
  }

  private pathsOf(atlas: Atlas): Paths {
    const { x, y } = this.model?.scene ?? {};
    const key = JSON.stringify([x, y, this.size]);
    if (this.paths.of === atlas && this.paths.key === key) return this.paths;
    const lines = atlas.boundaries.map(({ points }) => {
      const path = new Path2D();
      for (const point of points) path.lineTo(...this.toPixels(point));
      return path;
    });
    const regions = atlas.regions.map((region) => {
      const path = new Path2D();
      for (const ring of region.rings) {
        this.ring(atlas, ring).forEach(([x, y], index) =>
          index ? path.lineTo(x, y) : path.moveTo(x, y),
        );
        path.closePath();
      }
      return path;
    });
    this.paths = { of: atlas, key, regions, lines };
    return this.paths;
  }

  private ring(atlas: Atlas, ring: Region["rings"][number]): Path {
    return ring.flatMap((stretch) => {
      const points =
        "line" in stretch ? stretch.line : (atlas.boundaries[stretch.curve]?.points ?? []);
      const ordered = "back" in stretch && stretch.back ? [...points].reverse() : points;
      return ordered.map((point) => this.toPixels(point));
    });
  }

  /** What is at a place, in words. */
  private tellAt(x: number, y: number): string {
    const { model, mapping } = this;
    if (!model || this.grab(x, y) === "window") return "";
    const [across, up] = this.valuesAt(x, y);
    const [one, other] = model.names;
    const place = `${one.symbol} ${short(across)}, ${other.symbol} ${short(up)}`;
    const region = this.regionAt(x, y);
    const [width, height] = this.size;
    const index = mapping.at(
      value(model.scene.x, (x - LEFT) / width),
      value(model.scene.y, 1 - (y - TOP) / height),
    );
    const { map } = mapping.data;
    const own =
      index !== undefined && mapping.legend ? words(mapping.legend, map, index) : undefined;
    const told =
      own !== undefined && model.shown.kind !== "code" ? `${model.shown.name} ${own}` : undefined;
    const itinerary = region
      ? region.itinerary + (region.doubtful ? " (in doubt)" : "")
      : undefined;
    return [place, itinerary, told].filter((it) => it !== undefined).join(" · ");
  }

  /** Draws everything again. */
  redraw(): void {
    this.grounded = "";
    this.outlined = undefined;
    this.draw();
  }

  private drawNow(): void {
    const { model, canvas, atlas } = this;
    if (!model || sizeOf(canvas)[0] === 0) return;
    const { scene, names, pinned, boundaries, marks, curve, notches } = model;
    const all = [this.size, devicePixelRatio, scene, names, pinned, boundaries, marks, curve, notches];
    const key = JSON.stringify(all);
    if (key !== this.grounded) {
      const [context, width, height] = fit(this.ground);
      this.drawGround(new CanvasPen(context), model, width, height);
      this.grounded = key;
    }
    const region = this.hovered && this.regionAt(...this.hovered);
    const outlined = region && atlas ? `${key}${atlas.regions.indexOf(region)}` : "";
    if (outlined !== this.outlined) {
      this.outlined = outlined;
      const pen = new CanvasPen(fit(canvas)[0]);
      if (region && atlas)
        pen.within(LEFT, TOP, ...this.size, () => this.drawRegion(pen, atlas, region));
    }
    const [x, y] = this.toPixels(model.point);
    this.mark.hidden = this.grab(x, y) === "window";
    this.mark.style.transform = `translate(${x}px, ${y}px)`;
  }

  /** Draws the plane for a file. */
  drawWith(pen: Pen, width: number, height: number): void {
    const { model } = this;
    if (!model) return;
    this.drawGround(pen, model, width, height);
    pen.within(LEFT, TOP, ...this.size, () => this.drawPoint(pen, model));
  }

  /** Draws all but the point. */
  private drawGround(pen: Pen, model: PlaneModel, width: number, height: number): void {
    const { mapping, atlas } = this;
    const colours = theme();
    const [across, down] = [width - LEFT - RIGHT, height - TOP - BOTTOM];
    pen.within(LEFT, TOP, across, down, () => {
      pen.rectangle(LEFT, TOP, across, down, colours.rule);
      const place = mapping.place(model.scene.x, model.scene.y);
      if (place) {
        const [left, top, wide, high] = place;
        pen.picture(
          mapping.canvas,
          LEFT + left * across,
          TOP + top * down,
          wide * across,
          high * down,
        );
      }
      if (model.boundaries && atlas) this.drawBoundaries(pen, atlas);
      if (model.boundaries && !atlas) this.drawFound(pen);
      if (model.curve.length) {
        const path = model.curve.map((point) => this.toPixels(point));
        pen.line(path, { colour: "#fff", width: 3.5 });
        pen.line(path, { colour: "#000", width: 1.5, dash: [10, 5] });
      }
      this.drawMarks(pen, model);
    });
    drawAxes(pen, model, [across, down]);
  }

  private drawBoundaries(pen: Pen, atlas: Atlas): void {
    const many = atlas.boundaries.length > 150;
    for (const { kind, points } of atlas.boundaries) {
      pen.line(points.map((point) => this.toPixels(point)), {
        colour: "#101010",
        width: many ? 0.7 : 1.15,
        dash: many ? [] : (DASHES[kind] ?? []),
      });
    }
    if (many) return;
    for (const { point } of atlas.vertices) {
      pen.disc(...this.toPixels(point), 2.6, "#fff", { colour: "#101010", width: 1.2 });
    }
  }

  private drawFound(pen: Pen): void {
    for (const curve of this.found) {
      const place = (index: number) =>
        this.toPixels([curve[2 * index] as number, curve[2 * index + 1] as number]);
      const length = curve.length / 2;
      const track = { length, x: (at: number) => place(at)[0], y: (at: number) => place(at)[1] };
      pen.curve(track, { colour: "#101010", width: 1.15 });
    }
  }

  private drawRegion(pen: Pen, atlas: Atlas, region: Region): void {
    for (const ring of region.rings) {
      const path = this.ring(atlas, ring);
      const closed: Path = [...path, path[0] ?? [0, 0]];
      pen.line(closed, { colour: "#fff", width: 5 });
      pen.line(closed, { colour: "#111", width: 2.2 });
    }
  }

  private drawMarks(pen: Pen, model: PlaneModel): void {
    const halo = "#fff";
    for (const { at, name } of model.marks) {
      const [x, y] = this.toPixels(at);
      pen.disc(x, y, 3, "#111", { colour: "#fff", width: 1 });
      pen.text(name, x - 8, y + 4, { colour: "#111", size: 13, bold: true, align: "right", halo });
    }
    if (model.pinned) {
      const [x, y] = this.toPixels(model.pinned);
      pen.disc(x, y, 6, "#fff", { colour: "#111", width: 1.5 });
      pen.disc(x, y, 3, theme().pinned);
    }
  }

  private drawPoint(pen: Pen, model: PlaneModel): void {
    const [x, y] = this.toPixels(model.point);
    pen.disc(x, y, 9, "rgba(255,255,255,0.35)", { colour: "#fff", width: 3.5 });
    pen.disc(x, y, 9, "rgba(0,0,0,0)", { colour: "#111", width: 1.6 });
    pen.disc(x, y, 2.2, "#111");
  }

  /** The atlas of the present window, if it is traced. */
  get traced(): Atlas | undefined {
    const { model, atlas } = this;
    return model && this.tracedKey === JSON.stringify(model.scene) ? atlas : undefined;
  }

  /** The size of the canvas, for files. */
  get extent(): [number, number] {
    return sizeOf(this.canvas);
  }
}

/** What the axes of a scene are: a picture of another subject is not shown in the meantime. */
function subject({ kind, axes, across, up, text }: SceneRequest): string {
  return JSON.stringify([kind, axes, across, up, text]);
}

function sceneWithoutWindow(key: string): string {
  return key.replace(/"[xy]":\{[^}]*\},?/g, "");
}
