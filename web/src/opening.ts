// What the opening of the module can do: contacts of the paper's model in the windows of presets.
// The build runs this, to find the functions that they need.

import { Engine } from "./engine";
import { PRESETS } from "./presets";
import { value } from "./scale";
import { INTERVALS, taskOf, type Pinned, type State } from "./state";

/** So many contacts of a window, along each axis. */
const POINTS = 20;

/** Computes these contacts in a module; returns its memory. */
export async function rehearsed(module: BufferSource): Promise<WebAssembly.Memory> {
  const engine = await Engine.start(await WebAssembly.compile(module), () => {});
  for (const { state } of PRESETS.filter((it) => it.state.law === "paper")) {
    for (const of of contacts(state)) {
      const { scene, x, y, intervals } = taskOf(of, INTERVALS.screen);
      const { error } = engine.contact(scene, x, y, intervals);
      if (error) throw new Error(error);
    }
  }
  return engine.memory;
}

function contacts(state: State): Pinned[] {
  const parts = Array.from({ length: POINTS }, (_, index) => (index + 0.5) / POINTS);
  const points = parts.flatMap((x) =>
    parts.map((y): [number, number] => [value(state.x, x), value(state.y, y)]),
  );
  return [state, ...points.map((point) => ({ ...state, point }))];
}
