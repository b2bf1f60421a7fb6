// The module of the page: its opening, which is there first, and the whole.

import type { Hand } from "./crew";
import { byId } from "./dom";
import { joined } from "./join";
import { unzipped } from "./unpack";

/** Compiles the opening, with which the first of `hands` begins, and then the whole module, whose
 * other parts they unpack at the same time. `first` is waited for in between. */
export async function compiled(
  hands: readonly Hand[],
  first: Promise<unknown>,
): Promise<WebAssembly.Module> {
  const opening = await unzipped(textOf("opening"));
  hands[0]!.open(await WebAssembly.compile(opening));
  await parsed();
  const unpacker = textOf("unpack");
  const sizes = (byId("wasm").dataset.size ?? "").split(",").map(Number);
  const others = await Promise.all(
    textOf("wasm")
      .split("\n")
      .map(async (packed, place) => {
        // The worker of the first contact comes when it has it.
        if (place === 0) await first;
        return hands[place % hands.length]!.unpack({ unpacker, packed, size: sizes[place] ?? 0 });
      }),
  );
  return WebAssembly.compile(joined(opening, others));
}

function textOf(id: string): string {
  return (byId(id).textContent ?? "").trim();
}

/** Waits until all of the page is there. */
function parsed(): Promise<void> {
  return new Promise((resolve) => {
    if (document.readyState !== "loading") resolve();
    else document.addEventListener("DOMContentLoaded", () => resolve());
  });
}
