// The exports of the module, as functions on JavaScript's values.

import type { Answer, MapPart, SceneRequest } from "./types";

interface Exports {
  memory: WebAssembly.Memory;
  input(length: number): number;
  call(): number;
  map(columns: number, rows: number, first: number, end: number): number;
  stride(): number;
  course(x: number, y: number, intervals: number): number;
  course_stride(): number;
  text_ptr(): number;
  text_len(): number;
  numbers_ptr(): number;
  numbers_len(): number;
  values_ptr(): number;
  values_len(): number;
  counts_ptr(): number;
  counts_len(): number;
  codes_ptr(): number;
  codes_len(): number;
}

export class Engine {
  private readonly encoder = new TextEncoder();
  private readonly decoder = new TextDecoder();
  private shown = "";

  private constructor(private readonly exports: Exports) {}

  /** `show` takes each curve of an atlas that is being traced, as pairs of values. */
  static async start(
    module: WebAssembly.Module,
    show: (curve: Float64Array) => void,
  ): Promise<Engine> {
    let exports: Exports | undefined;
    const curve = (address: number, length: number) => {
      if (exports) show(new Float64Array(exports.memory.buffer, address, 2 * length).slice());
    };
    const instance = await WebAssembly.instantiate(module, { env: { curve } });
    exports = instance.exports as unknown as Exports;
    return new Engine(exports);
  }

  get memory(): WebAssembly.Memory {
    return this.exports.memory;
  }

  /** Answers a request that needs no scene. */
  ask(request: object): Answer {
    const bytes = this.encoder.encode(JSON.stringify(request));
    const address = this.exports.input(bytes.length);
    new Uint8Array(this.exports.memory.buffer, address, bytes.length).set(bytes);
    this.exports.call();
    return JSON.parse(this.text()) as Answer;
  }

  /** Answers a request about a scene. */
  askOf(scene: SceneRequest, request: object): Answer {
    return this.show(scene) ?? this.ask(request);
  }

  /** Rows of a map. */
  map(
    scene: SceneRequest,
    columns: number,
    rows: number,
    first: number,
    end: number,
  ): Answer | MapPart {
    const refused = this.show(scene);
    if (refused) return refused;
    const { exports } = this;
    exports.map(columns, rows, first, end);
    const { buffer } = exports.memory;
    return {
      values: new Float32Array(buffer, exports.values_ptr(), exports.values_len()).slice(),
      counts: new Uint16Array(buffer, exports.counts_ptr(), exports.counts_len()).slice(),
      codes: new Uint32Array(buffer, exports.codes_ptr(), exports.codes_len()).slice(),
    };
  }

  /** The collision at a point with its course. */
  contact(scene: SceneRequest, x: number, y: number, intervals: number): Answer {
    const found = this.askOf(scene, { do: "collision", x, y });
    if (found.error) return found;
    const { exports } = this;
    if (exports.course(x, y, intervals) === 0) return { error: this.text() };
    const numbers = new Float64Array(
      exports.memory.buffer,
      exports.numbers_ptr(),
      exports.numbers_len(),
    );
    return { document: found, course: numbers.slice(), stride: exports.course_stride() };
  }

  /** Shows a scene, unless it is shown already; returns why it is impossible. */
  private show(scene: SceneRequest): Answer | undefined {
    const key = JSON.stringify(scene);
    if (key === this.shown) return undefined;
    this.shown = "";
    const found = this.ask({ do: "scene", scene });
    if (found.error) return found;
    this.shown = key;
    return undefined;
  }

  private text(): string {
    const { exports } = this;
    return this.decoder.decode(
      new Uint8Array(exports.memory.buffer, exports.text_ptr(), exports.text_len()),
    );
  }
}
