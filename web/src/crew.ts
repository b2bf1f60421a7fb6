// Workers that never keep the page waiting: one that dies or is too slow is started again.

import { byId } from "./dom";
import type { Answer, MapPart, Task } from "./types";
import { unpack } from "./unpack";

type Result<T> = { answer: T; ms: number };

interface Pending {
  resolve(result: Result<never>): void;
  timer: ReturnType<typeof setTimeout> | undefined;
}

let code: string | undefined;

/** The module, compiled from the text that the page holds. */
export function compiled(): Promise<WebAssembly.Module> {
  const holder = byId("wasm");
  const text = atob(holder.textContent ?? "");
  const packed = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index++) packed[index] = text.charCodeAt(index);
  return WebAssembly.compile(unpack(packed, Number(holder.dataset.size)) as BufferSource);
}

/** One worker, which starts with its first task. */
export class Hand {
  private worker: Worker | undefined;
  private readonly pending = new Map<number, Pending>();
  private next = 0;
  /** How often it was started again. */
  restarts = 0;

  constructor(private readonly module: Promise<WebAssembly.Module>) {}

  get busy(): boolean {
    return this.pending.size > 0;
  }

  /** Does a task. The answer has an error if the worker dies, or takes longer than `most` ms. */
  do<T = Answer>(task: Task, most?: number): Promise<Result<T>> {
    return new Promise((resolve) => {
      const id = this.next++;
      const late = () => this.restart(`this takes longer than ${(most ?? 0) / 1000} s`);
      const timer = most === undefined ? undefined : setTimeout(late, most);
      this.pending.set(id, { resolve: resolve as Pending["resolve"], timer });
      const worker = this.warm();
      // Behind the module, which the worker gets first.
      void this.module.then(() => worker.postMessage({ id, task }));
    });
  }

  /** Starts the worker, if it is not there yet. */
  warm(): Worker {
    return (this.worker ??= this.start());
  }

  /** Ends what the worker does; the next task starts another one. */
  restart(reason = "cancelled"): void {
    this.worker?.terminate();
    this.worker = undefined;
    this.restarts += 1;
    const given = [...this.pending.values()];
    this.pending.clear();
    for (const { resolve, timer } of given) {
      clearTimeout(timer);
      resolve({ answer: { error: reason } as never, ms: 0 });
    }
  }

  /** Ends the worker from outside, as a crash would. For tests. */
  crash(): void {
    this.worker?.dispatchEvent(new ErrorEvent("error", { message: "crash", cancelable: true }));
  }

  private start(): Worker {
    code ??= URL.createObjectURL(
      new Blob([byId("worker").textContent ?? ""], { type: "text/javascript" }),
    );
    const worker = new Worker(code);
    worker.onmessage = ({ data }: MessageEvent<{ id: number } & Result<never>>) => {
      const pending = this.pending.get(data.id);
      this.pending.delete(data.id);
      clearTimeout(pending?.timer);
      pending?.resolve({ answer: data.answer, ms: data.ms });
    };
    worker.onerror = (event) => {
      event.preventDefault();
      this.restart("a worker ended; it was started again");
    };
    void this.module.then((module) => worker.postMessage({ module }));
    return worker;
  }
}

/** A band of a map. */
export interface Band {
  task: Extract<Task, { task: "map" }>;
  /** The size of its points in those of the finished map. */
  block: number;
}

/** Workers that compute the bands of a map, coarse ones first. Only the newest map counts. */
export class Crew {
  readonly hands: Hand[];
  private queue: Band[] = [];
  private generation = 0;
  private left = 0;
  private finished: () => void = () => {};
  private take: (band: Band, part: MapPart) => void = () => {};

  constructor(module: Promise<WebAssembly.Module>, count: number) {
    this.hands = Array.from({ length: count }, () => new Hand(module));
  }

  /** Computes a map instead of the one before. */
  compute(bands: Band[], take: (band: Band, part: MapPart) => void, finished: () => void): void {
    this.generation += 1;
    this.queue = [...bands];
    this.left = bands.length;
    this.take = take;
    this.finished = finished;
    this.hands.forEach((hand) => this.feed(hand));
  }

  private async feed(hand: Hand): Promise<void> {
    if (hand.busy) return;
    const band = this.queue.shift();
    if (!band) return;
    const { generation } = this;
    const { answer } = await hand.do<MapPart & Answer>(band.task, 60_000);
    if (generation === this.generation) {
      if (answer.counts) this.take(band, answer);
      this.left -= 1;
      if (this.left === 0) this.finished();
    }
    void this.feed(hand);
  }
}
