// The module of the page is a text. What unpacks it is a module too, examples/unpack.rs in
// crates/explorer.

/** What a part of the module is made from: texts in base64, the first of which the browser can
 * unpack by itself, and its size in bytes. */
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
  const zipped = new Blob([bytes(unpacker)]).stream();
  const code = new Response(zipped.pipeThrough(new DecompressionStream("gzip")));
  const { instance } = await WebAssembly.instantiate(await code.arrayBuffer());
  const exports = instance.exports as unknown as Exports;
  const file = bytes(packed);
  const input = exports.input(file.length);
  new Uint8Array(exports.memory.buffer, input, file.length).set(file);
  const address = exports.unpack(size);
  if (address === 0) throw new Error("a part of it is damaged");
  return new Uint8Array(exports.memory.buffer, address, size).slice();
}

function bytes(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64);
  const found = new Uint8Array(text.length);
  for (let index = 0; index < text.length; index++) found[index] = text.charCodeAt(index);
  return found;
}
