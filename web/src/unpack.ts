// The module of the page is texts. What unpacks them, but for the first, is a module too,
// examples/unpack.rs in crates/explorer.

/** What a part of the module is made from: texts, the first of which the browser can unpack by
 * itself, and its size in bytes. */
export interface Packed {
  unpacker: string;
  packed: string;
  size: number;
}

interface Exports {
  memory: WebAssembly.Memory;
  input(length: number): number;
  unpack(size: number): number;
}

export async function unpack({ unpacker, packed, size }: Packed): Promise<Uint8Array> {
  const { instance } = await WebAssembly.instantiate(await unzipped(unpacker));
  const exports = instance.exports as unknown as Exports;
  const file = bytes(packed);
  const input = exports.input(file.length);
  new Uint8Array(exports.memory.buffer, input, file.length).set(file);
  const address = exports.unpack(size);
  if (address === 0) throw new Error("a part of it is damaged");
  return new Uint8Array(exports.memory.buffer, address, size).slice();
}

/** The bytes of a text that the browser can unpack. */
export async function unzipped(text: string): Promise<Uint8Array<ArrayBuffer>> {
  const zipped = new Blob([bytes(text)]).stream();
  const whole = new Response(zipped.pipeThrough(new DecompressionStream("gzip")));
  return new Uint8Array(await whole.arrayBuffer());
}

/** The values of the characters that a text of bytes has: those from ! to ~ but for ", & and <. */
const VALUES = new Int16Array(128).fill(-1);
for (let code = 33, value = 0; code < 127; code++)
  if (!['"', "&", "<"].includes(String.fromCharCode(code))) VALUES[code] = value++;

/** The bytes of a text: each two characters are 13 bits, and one that is left is up to 6. */
function bytes(text: string): Uint8Array<ArrayBuffer> {
  const { length } = text;
  const found = new Uint8Array((13 * (length >> 1) + 6 * (length & 1)) >> 3);
  let [held, bits, at] = [0, 0, 0];
  for (let index = 0; index < length; index += 2) {
    const alone = index + 1 === length;
    const low = VALUES[text.charCodeAt(index)]!;
    const high = alone ? 0 : VALUES[text.charCodeAt(index + 1)]!;
    // A character that is none of them has a value below 0, or none at all.
    if (!(low >= 0 && high >= 0)) throw new Error("a character of it is damaged");
    held |= (low + 91 * high) << bits;
    for (bits += alone ? 6 : 13; bits >= 8; bits -= 8, held >>>= 8) found[at++] = held;
  }
  return found;
}
