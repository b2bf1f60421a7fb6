// Workers that never keep the page waiting: one that dies or is too slow is started again.

import { byId } from "./dom";
import type { Answer, MapPart, Task } from "./types";
import type { Packed } from "./unpack";

export type Result<T> = { answer: T; ms: number };

type Message =
  | { part: Uint8Array }
  | { damaged: string }
  | ({ id: number; curve?: Float64Array; dead?: string; opening?: boolean } & Result<never>);

interface Pending {
  task: Task;
  /** The limit of its time, in milliseconds. */
  most: number | undefined;
  resolve(result: Result<never>): void;
  timer: ReturnType<typeof setTimeout> | undefined;
  show: Show | undefined;
}

/** Takes a curve of an atlas before the answer, as pairs of values. */
type Show = (curve: Float64Array) => void;

let code: string | undefined;

/** Why there is no module is told once, by who starts the page. */
const ignored = (): void => {};

/** One worker, which is started when it is needed. */
export class Hand {
  private worker: Worker | undefined;
  private readonly pending = new Map<number, Pending>();
  private next = 0;
  /** Takes the part of the module that is being unpacked, or why it cannot be. */
  private unpacked: ((part: Uint8Array | Error) => void) | undefined;
  /** How often it was started again. */
  restarts = 0;
  /** What is done when no task is left. */
  idle: () => void = () => {};
  /** Whether it can begin before the whole module is there. */
  private opened = false;
  private hasTried: () => void = () => {};
  /** Its first task is done, or waits for the whole module. */
  readonly tried = new Promise<void>((resolve) => (this.hasTried = resolve));

  constructor(private readonly module: Promise<WebAssembly.Module>) {}

  get busy(): boolean {
    return this.pending.size > 0;
  }

  /** Does a task. The answer has an error if the worker dies, or takes longer than `most` ms. */
  do<T = Answer>(task: Task, most?: number, show?: Show): Promise<Result<T>> {
    return new Promise((resolve) => {
      const id = this.next++;
      const timer = undefined;
      this.pending.set(id, { task, most, resolve: resolve as Pending["resolve"], timer, show });
      this.post(id, task);
      this.time();
    });
  }

  /** Gives the worker a task. A worker that is not there starts when the module is. */
  private post(id: number, task: Task): void {
    const post = () => this.pending.has(id) && this.warm().postMessage({ id, task });
    if (this.worker) post();
    else this.module.then(post, ignored);
  }

  /** Limits the time of the task that the worker does, which is the first one. */
  private time(): void {
    const [first] = this.pending;
    if (!first) return;
    const [id, task] = first;
    const { most } = task;
    if (most === undefined || task.timer !== undefined) return;
    const late = () => this.die(`this takes longer than ${most / 1000} s`, id);
    const begin = () => {
      if (this.pending.get(id) === task) task.timer ??= setTimeout(late, most);
    };
    // To wait for the module is no part of it.
    if (this.opened) begin();
    else this.module.then(begin, ignored);
  }

  /** Begins tasks with the opening of the module, until the whole is there. */
  open(module: WebAssembly.Module): void {
    this.warm().postMessage({ module, opening: true });
    this.opened = true;
    this.time();
  }

  /** Unpacks a part of the module, for which nothing else has to be there. */
  unpack(packed: Packed): Promise<Uint8Array> {
    return new Promise((resolve, reject) => {
      this.unpacked = (part) => {
        this.unpacked = undefined;
        if (part instanceof Error) reject(part);
        else resolve(part);
      };
      this.warm().postMessage(packed);
    });
  }

  /** Starts the worker, if it is not there yet. */
  warm(): Worker {
    return (this.worker ??= this.start());
  }

  /** Ends what the worker does; the next task starts another one. */
  restart(): void {
    this.end();
    for (const id of [...this.pending.keys()]) this.fail(id, "cancelled");
  }

  /** Ends the worker, and the task that it does; another one does the rest. */
  private die(reason: string, id = Math.min(...this.pending.keys())): void {
    this.end();
    this.fail(id, reason);
    for (const [other, { task }] of this.pending) this.post(other, task);
  }

  private end(): void {
    this.restarts += 1;
    this.opened = false;
    // The module is needed by all.
    if (this.unpacked) return;
    this.worker?.terminate();
    this.worker = undefined;
  }

  private fail(id: number, error: string): void {
    this.settle(id, { answer: { error } as never, ms: 0 });
  }

  private settle(id: number, result: Result<never>): void {
    const pending = this.pending.get(id);
    this.pending.delete(id);
    clearTimeout(pending?.timer);
    this.hasTried();
    pending?.resolve(result);
    if (this.busy) this.time();
    else this.idle();
  }

  private start(): Worker {
    code ??= URL.createObjectURL(
      new Blob([byId("worker").textContent ?? ""], { type: "text/javascript" }),
    );
    const worker = new Worker(code);
    worker.onmessage = ({
      data,
    }: MessageEvent<Message>) => {
      if ("part" in data) return this.unpacked?.(data.part);
      if ("damaged" in data) return this.unpacked?.(new Error(data.damaged));
      const pending = this.pending.get(data.id);
      if (data.curve) {
        pending?.show?.(data.curve);
      } else if (data.dead === undefined) {
        this.settle(data.id, data);
      } else if (data.opening && pending) {
        // What the opening does not have, the whole module has.
        this.opened = false;
        this.hasTried();
        worker.postMessage({ id: data.id, task: pending.task });
        clearTimeout(pending.timer);
        pending.timer = undefined;
        this.time();
      } else {
        this.die(`a worker ended (${data.dead}); it was started again`, data.id);
      }
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.unpacked?.(new Error("a worker ended before it was there"));
      this.die("a worker ended; it was started again");
    };
    this.module.then((module) => worker.postMessage({ module, opening: false }), ignored);
    return worker;
  }
}

/** A band of a map. */
export interface Band {
  task: Extract<Task, { task: "map" }>;
  /** The size of its points in those of the finished map. */
  block: number;
  /** Whether a worker has failed at it. */
  again?: boolean;
}

/** Workers that compute the bands of a map, coarse ones first. Only the newest map counts. */
export class Crew {
  readonly hands: Hand[];
  private queue: Band[] = [];
  private generation = 0;
  private left = 0;
  private finished: (error?: string) => void = () => {};
  /** Why bands were not computed. */
  private error: string | undefined;
  private take: (band: Band, part: MapPart) => void = () => {};

  constructor(module: Promise<WebAssembly.Module>, count: number) {
    this.hands = Array.from({ length: count }, () => new Hand(module));
    for (const hand of this.hands) hand.idle = () => void this.feed(hand);
  }

  /** Computes a map instead of the one before. */
  compute(
    bands: Band[],
    take: (band: Band, part: MapPart) => void,
    finished: (error?: string) => void,
  ): void {
    this.generation += 1;
    this.queue = [...bands];
    this.left = bands.length;
    this.take = take;
    this.finished = finished;
    this.error = undefined;
    this.hands.forEach((hand) => this.feed(hand));
  }

  private async feed(hand: Hand): Promise<void> {
    if (hand.busy) return;
    const band = this.queue.shift();
    if (!band) return;
    const { generation } = this;
    const { answer } = await hand.do<MapPart & Answer>(band.task, 60_000);
    if (generation === this.generation) {
      if (!answer.counts && !band.again) this.queue.unshift({ ...band, again: true });
      else {
        if (answer.counts) this.take(band, answer);
        else this.error = answer.error;
        this.left -= 1;
        if (this.left === 0) this.finished(this.error);
      }
    }
    void this.feed(hand);
  }
}
