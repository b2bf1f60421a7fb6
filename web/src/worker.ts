// A worker: it may unpack a part of the module, gets it compiled, then tasks, one after the other.

import { Engine } from "./engine";
import type { Answer, MapPart, Task } from "./types";
import { type Packed, unpack } from "./unpack";

type Message =
  | Packed
  | { module: WebAssembly.Module }
  | { id: number; task: Task };

interface Port {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: unknown, transfer?: Transferable[]): void;
}

const port = globalThis as unknown as Port;
let engine: Promise<Engine> | undefined;
/** The task that is done. */
let doing = 0;

port.onmessage = async ({
  data,
}: MessageEvent<Message>) => {
  if ("packed" in data) {
    try {
      const part = await unpack(data);
      port.postMessage({ part }, [part.buffer as ArrayBuffer]);
    } catch (error) {
      port.postMessage({ damaged: reason(error) });
    }
    return;
  }
  if ("module" in data) {
    engine = Engine.start(data.module, (curve) =>
      port.postMessage({ id: doing, curve }, [curve.buffer as ArrayBuffer]),
    );
    return;
  }
  const ready = await engine;
  if (!ready) return;
  doing = data.id;
  const begun = performance.now();
  try {
    const answer = run(ready, data.task);
    port.postMessage({ id: data.id, answer, ms: performance.now() - begun }, transferred(answer));
  } catch (error) {
    // Its memory may be in any state.
    port.postMessage({ id: data.id, dead: reason(error) });
  }
};

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
