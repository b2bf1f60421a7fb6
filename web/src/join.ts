// Puts a module together that split.mjs took apart.

/** The kind of the section that has the functions. */
const CODE = 10;

/** The whole module: the opening, in which stubs stand for functions, and these functions, with
 * their sizes and one after the other, in parts. */
export function joined(opening: Uint8Array, parts: Uint8Array[]): Uint8Array<ArrayBuffer> {
  const functions = together(parts);
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
