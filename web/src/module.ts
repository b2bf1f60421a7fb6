// The module of the page: its opening, which is there first, and the whole.

import { byId } from "./dom";
import type { Hand } from "./crew";
import { unzipped } from "./unpack";

/** The kind of the section that has the functions. */
const CODE = 10;

/** Compiles the opening, with which the first of `hands` begins, and then the whole module, whose
 * other parts they unpack at the same time. `first` is waited for in between. */
export async function compiled(
  hands: readonly Hand[],
  first: Promise<unknown>,
): Promise<WebAssembly.Module> {
  const opening = await unzipped(textOf("opening"));
  hands[0]!.open(await WebAssembly.compile(opening));
  await Promise.all([first, parsed()]);
  const unpacker = textOf("unpack");
  const sizes = (byId("wasm").dataset.size ?? "").split(",").map(Number);
  const others = await Promise.all(
    textOf("wasm")
      .split("\n")
      .map((packed, place) =>
        hands[place % hands.length]!.unpack({ unpacker, packed, size: sizes[place] ?? 0 }),
      ),
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

/** The whole module: the opening, in which stubs stand for functions, and these functions. */
function joined(opening: Uint8Array, others: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const functions = together(others);
  let [from, next] = [8, 0];
  const number = (bytes: Uint8Array, at: number): [number, number] => {
    let [value, shift, byte] = [0, 0, 0];
    do {
      byte = bytes[at++]!;
      value += (byte & 127) * 2 ** shift;
      shift += 7;
    } while (byte & 128);
    return [value, at];
  };
  let [size, begin] = number(opening, from + 1);
  while (opening[from] !== CODE) {
    from = begin + size;
    if (from >= opening.length) throw new Error("it has no functions");
    [size, begin] = number(opening, from + 1);
  }
  const end = begin + size;
  let [count, at] = number(opening, begin);
  const code = [opening.subarray(begin, at)];
  for (; count > 0; count--) {
    const [length, body] = number(opening, at);
    const isStub = length === 3 && opening[body] === 0 && opening[body + 1] === 0;
    if (isStub) {
      const [own, start] = number(functions, next);
      code.push(functions.subarray(next, start + own));
      next = start + own;
    } else code.push(opening.subarray(at, body + length));
    at = body + length;
  }
  if (next !== functions.length) throw new Error("its parts do not fit");
  const section = together(code);
  const header = [CODE];
  for (let rest = section.length; ; rest = Math.floor(rest / 128)) {
    header.push(rest < 128 ? rest : (rest % 128) | 128);
    if (rest < 128) break;
  }
  return together([
    opening.subarray(0, from),
    Uint8Array.from(header),
    section,
    opening.subarray(end),
  ]);
}

function together(parts: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const whole = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
  parts.reduce((at, part) => (whole.set(part, at), at + part.length), 0);
  return whole;
}
