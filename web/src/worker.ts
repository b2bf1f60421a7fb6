// A worker: it may unpack a part of the module, gets it compiled, then tasks, one after the other.
// One worker has the opening of the module before the others have the whole.

import { Engine } from "./engine";
import type { Answer, MapPart, Task } from "./types";
import { type Packed, unpack } from "./unpack";

type Message =
  | Packed
  | { module: WebAssembly.Module; opening: boolean }
  | { id: number; task: Task };

interface Port {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: unknown, transfer?: Transferable[]): void;
}

const port = globalThis as unknown as Port;
let take: (engine: Promise<Engine>) => void = () => {};
let engine = none();
/** The engine of the opening. */
let opening: Promise<Engine> | undefined;
/** The task that is done. */
let doing = 0;

/** An engine that is still to come. */
function none(): Promise<Engine> {
  return new Promise((resolve) => (take = resolve));
}

port.onmessage = async ({
  data,
}: MessageEvent<Message>) => {
  if ("task" in data) return work(data.id, data.task);
  if ("module" in data) {
    const started = Engine.start(data.module, (curve) =>
      port.postMessage({ id: doing, curve }, [curve.buffer as ArrayBuffer]),
    );
    take(started);
    engine = started;
    opening = data.opening ? started : undefined;
    return;
  }
  try {
    const part = await unpack(data);
    port.postMessage({ part }, [part.buffer as ArrayBuffer]);
  } catch (error) {
    port.postMessage({ damaged: reason(error) });
  }
};

async function work(id: number, task: Task): Promise<void> {
  let own = engine;
  try {
    let ready = await own;
    // It was replaced meanwhile.
    while (own !== engine) ready = await (own = engine);
    doing = id;
    const begun = performance.now();
    const answer = run(ready, task);
    port.postMessage({ id, answer, ms: performance.now() - begun }, transferred(answer));
  } catch (error) {
    // Its memory may be in any state.
    if (own === engine) engine = none();
    port.postMessage({ id, dead: reason(error), opening: own === opening });
  }
}

function reason(error: unknown): string {
  return error instanceof Error ? error.message : String(error);
}

function run(engine: Engine, task: Task): Answer | MapPart {
  switch (task.task) {
    case "ask":
      return task.scene ? engine.askOf(task.scene, task.request) : engine.ask(task.request);
    case "contact":
      return engine.contact(task.scene, task.x, task.y, task.intervals);
    case "map":
      return engine.map(task.scene, task.columns, task.rows, task.first, task.end);
  }
}

function transferred(answer: Answer | MapPart): Transferable[] {
  const arrays = Object.values(answer).filter((it) => ArrayBuffer.isView(it)) as ArrayBufferView[];
  return arrays.map((it) => it.buffer as ArrayBuffer);
}
