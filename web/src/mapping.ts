// The picture of a map, as fine as has arrived, and moved with its window until a new one comes.

import type { Band, Crew } from "./crew";
import { colour, legend, type Legend, type Shown } from "./quantities";
import { part } from "./scale";
import { NO_COUNT, STRIDE, type Axis, type MapPart, type SceneRequest } from "./types";

/** Rows of a band are so many that a band takes some ten milliseconds. */
const POINTS_OF_A_BAND = 6_000;
/** Nearly black. */
const EDGE = 0xff202020;

export class Mapping {
  /** The picture that is shown, and its window. */
  readonly canvas = document.createElement("canvas");
  private window: [Axis, Axis] | undefined;
  private map: MapPart = empty(0);
  private size: [number, number] = [0, 0];
  /** The size of its finest points in those of the picture. */
  private block = 1;
  /** What is computed now, and shown once all of its coarse points are there. */
  private next:
    | { map: MapPart; size: [number, number]; window: [Axis, Axis]; block: number; coarse: number }
    | undefined;
  legend: Legend | undefined;
  private wanted: Shown | undefined;
  private edges = false;
  /** When the last map was asked for, and how long it took. */
  begun = 0;
  took = 0;
  ready = false;
  /** Why there is no whole map. */
  refusal: string | undefined;

  constructor(
    private readonly crew: Crew,
    private readonly redraw: () => void,
  ) {}

  /** Computes another map. `blocks` are the sizes of its points, from coarse to 1. */
  compute(scene: SceneRequest, width: number, height: number, blocks: number[]): void {
    const bands = blocks.flatMap((block) => bandsOf(scene, width, height, block));
    const coarse = bands.filter((band) => band.block === blocks[0]).length;
    this.next = {
      map: empty(width * height),
      size: [width, height],
      window: [scene.x, scene.y],
      block: blocks.at(-1) ?? 1,
      coarse,
    };
    this.refusal = undefined;
    this.begun = performance.now();
    this.ready = false;
    this.crew.compute(
      bands,
      (band, found) => this.take(band, found),
      (error) => {
        this.refusal = error;
        // The picture of another map would be taken for this one.
        if (this.next) this.forget();
        this.next = undefined;
        this.took = performance.now() - this.begun;
        this.ready = true;
        this.paint(this.wanted);
        this.redraw();
      },
    );
  }

  private take({ task, block }: Band, found: MapPart): void {
    const into = this.next;
    const target = into?.map ?? this.map;
    const [width, height] = into?.size ?? this.size;
    spread(found, task, block, target, width, height);
    if (into) {
      into.coarse -= 1;
      if (into.coarse > 0) return;
      [this.map, this.size, this.window] = [into.map, into.size, into.window];
      [this.block, this.next] = [into.block, undefined];
      this.paint(this.wanted);
    } else {
      this.paintRows(task.first * block, Math.min(height, task.end * block));
    }
    this.redraw();
  }

  /** Draws edges between itineraries, for as long as there are no boundaries. */
  outline(edges: boolean): void {
    if (edges === this.edges) return;
    this.edges = edges;
    this.paint(this.wanted);
  }

  /** Shows nothing until another map comes. */
  forget(): void {
    this.window = undefined;
  }

  /** Shows another quantity. */
  show(shown: Shown): void {
    this.wanted = shown;
    this.paint(shown);
  }

  private paint(shown: Shown | undefined): void {
    const [width, height] = this.size;
    if (!shown || width === 0) return;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
    }
    this.legend = legend(shown, this.map);
    this.paintRows(0, height);
  }

  private paintRows(first: number, end: number): void {
    const [width] = this.size;
    const context = this.canvas.getContext("2d");
    if (!context || !this.legend || end <= first) return;
    const image = context.createImageData(width, end - first);
    const pixels = new Uint32Array(image.data.buffer);
    const { codes } = this.map;
    for (let index = 0; index < pixels.length; index++) {
      const point = first * width + index;
      if (
        this.edges &&
        point % width > 0 &&
        point >= width &&
        (codes[point] !== codes[point - 1] || codes[point] !== codes[point - width])
      ) {
        pixels[index] = EDGE;
        continue;
      }
      const [red, green, blue] = colour(this.legend, this.map, point);
      pixels[index] = 0xff000000 | (blue << 16) | (green << 8) | red;
    }
    context.putImageData(image, 0, first);
  }

  /** Where the picture lies in another window: its left, top, width and height, in parts. */
  place(x: Axis, y: Axis): [number, number, number, number] | undefined {
    if (!this.window) return undefined;
    const [own, ownUp] = this.window;
    if (own.log !== x.log || ownUp.log !== y.log) return undefined;
    const [left, right] = [part(x, own.low), part(x, own.high)];
    const [bottom, top] = [part(y, ownUp.low), part(y, ownUp.high)];
    return [left, 1 - top, right - left, top - bottom];
  }

  /** The index of the point with these values, unless the picture is of an earlier map. */
  at(x: number, y: number): number | undefined {
    if (!this.window || this.next) return undefined;
    const [width, height] = this.size;
    const [column, row] = [
      Math.floor(part(this.window[0], x) * width),
      Math.floor((1 - part(this.window[1], y)) * height),
    ];
    const inside = column >= 0 && column < width && row >= 0 && row < height;
    return inside ? row * width + column : undefined;
  }

  /** The points of the map. */
  get data(): { map: MapPart; size: [number, number] } {
    return { map: this.map, size: this.size };
  }

  /** What was computed of the finished map, in columns and rows from the top: where it is coarser
   * than the picture, each point once. */
  get computed(): { map: MapPart; size: [number, number]; window: [Axis, Axis] } | undefined {
    const { map, block, window } = this;
    if (!window || !this.ready || this.refusal) return undefined;
    const [width, height] = this.size;
    const [columns, rows] = [Math.ceil(width / block), Math.ceil(height / block)];
    const found = empty(columns * rows);
    for (let index = 0; index < columns * rows; index++) {
      const [column, row] = [index % columns, Math.floor(index / columns)];
      copy(map, block * (row * width + column), found, index);
    }
    return { map: found, size: [columns, rows], window };
  }
}

/** A map without results. */
function empty(points: number): MapPart {
  return {
    values: new Float32Array(points * STRIDE).fill(NaN),
    counts: new Uint16Array(points).fill(NO_COUNT),
    codes: new Uint32Array(points),
  };
}

function copy(from: MapPart, index: number, into: MapPart, to: number): void {
  into.counts[to] = from.counts[index] as number;
  into.codes[to] = from.codes[index] as number;
  for (let place = 0; place < STRIDE; place++) {
    into.values[to * STRIDE + place] = from.values[index * STRIDE + place] as number;
  }
}

function bandsOf(scene: SceneRequest, width: number, height: number, block: number): Band[] {
  const [columns, rows] = [Math.ceil(width / block), Math.ceil(height / block)];
  const by = Math.max(1, Math.floor(POINTS_OF_A_BAND / columns));
  const bands: Band[] = [];
  for (let first = 0; first < rows; first += by) {
    const end = Math.min(rows, first + by);
    bands.push({ task: { task: "map", scene, columns, rows, first, end }, block });
  }
  return bands;
}

/** Writes coarse points into all places that they cover. */
function spread(
  found: MapPart,
  { columns, first, end }: Band["task"],
  block: number,
  into: MapPart,
  width: number,
  height: number,
): void {
  for (let row = first * block; row < Math.min(height, end * block); row++) {
    const begin = (Math.floor(row / block) - first) * columns;
    for (let column = 0; column < width; column++) {
      copy(found, begin + Math.floor(column / block), into, row * width + column);
    }
  }
}
