// A worker: it gets the compiled module, then tasks, one after the other.

import { Engine } from "./engine";
import type { Answer, MapPart, Task } from "./types";

interface Port {
  onmessage: ((event: MessageEvent) => void) | null;
  postMessage(message: unknown, transfer?: Transferable[]): void;
}

const port = globalThis as unknown as Port;
let engine: Promise<Engine> | undefined;

port.onmessage = async ({
  data,
}: MessageEvent<{ module: WebAssembly.Module } | { id: number; task: Task }>) => {
  if ("module" in data) {
    engine = Engine.start(data.module);
    return;
  }
  const ready = await engine;
  if (!ready) return;
  const begun = performance.now();
  const answer = run(ready, data.task);
  port.postMessage({ id: data.id, answer, ms: performance.now() - begun }, transferred(answer));
};

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
