// What the opening of the module can do: the contacts of the paper's model that presets show. The
// build runs this, to find the functions that they need.

import { INTERVALS, taskOf } from "./state";
import { Engine } from "./engine";
import { PRESETS } from "./presets";

/** Computes these contacts in a module; returns its memory. */
export async function rehearsed(module: BufferSource): Promise<WebAssembly.Memory> {
  const engine = await Engine.start(await WebAssembly.compile(module), () => {});
  for (const { state } of PRESETS.filter((it) => it.state.law === "paper")) {
    const { scene, x, y, intervals } = taskOf(state, INTERVALS.screen);
    const { error } = engine.contact(scene, x, y, intervals);
    if (error) throw new Error(error);
  }
  return engine.memory;
}
