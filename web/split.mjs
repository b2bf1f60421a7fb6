// The functions of a module that the opening calls, and the others, which come after it.
//
// The page opens with a module in which the other functions are stubs: a call of one would end the
// task, and the whole module does it again. Both have the same functions in the same order, so
// that the whole one is put together again by src/join.ts.

const CODE = 10;
const MEMORY = 5;
const PAGE = 65_536;
/** No locals, `unreachable`, `end`. */
const STUB = Buffer.from([3, 0, 0x00, 0x0b]);

function leb(value) {
  const bytes = [];
  for (; value >= 128; value = Math.floor(value / 128)) bytes.push((value % 128) | 128);
  return Buffer.from([...bytes, value]);
}

function reader(bytes, at = 0) {
  const read = {
    at,
    byte: () => bytes[read.at++],
    number() {
      let [value, shift, byte] = [0, 0, 0];
      do {
        byte = read.byte();
        value += (byte & 127) * 2 ** shift;
        shift += 7;
      } while (byte & 128);
      return value;
    },
    take(length) {
      read.at += length;
      return bytes.subarray(read.at - length, read.at);
    },
    get left() {
      return bytes.length - read.at;
    },
  };
  return read;
}

/** The sections of a module but for the custom ones, which say by what it was made. */
function sections(module) {
  const read = reader(module, 8);
  const found = [];
  while (read.left > 0) {
    const kind = read.byte();
    const content = read.take(read.number());
    if (kind !== 0) found.push({ kind, content });
  }
  return found;
}

/** A module of these sections, some of which are made anew. */
function assembled(module, change = {}) {
  const parts = sections(module).map(({ kind, content }) => {
    const made = change[kind]?.(content) ?? content;
    return Buffer.concat([Buffer.from([kind]), leb(made.length), made]);
  });
  return Buffer.concat([module.subarray(0, 8), ...parts]);
}

/** The code section with other bodies. */
function recoded(content, change) {
  const read = reader(content);
  const count = read.number();
  const bodies = Array.from({ length: count }, (_, index) => {
    const body = read.take(read.number());
    return change(Buffer.concat([leb(body.length), body]), index);
  });
  return Buffer.concat([leb(count), ...bodies]);
}

/** A module without its custom sections. */
export function stripped(module) {
  return assembled(module);
}

/** Runs a module, and finds the functions that are called: each one writes a byte into memory. */
export async function called(module, run) {
  let marks = 0;
  let count = 0;
  const watched = assembled(module, {
    [MEMORY](content) {
      // One memory, which may grow: its first pages are followed by those for the marks.
      const read = reader(content, 2);
      const pages = read.number();
      marks = pages * PAGE;
      return Buffer.concat([Buffer.from([1, 0]), leb(pages + 1)]);
    },
    [CODE]: (content) =>
      recoded(content, (sized, index) => {
        count += 1;
        const body = reader(sized);
        body.number();
        const begin = body.at;
        for (let kinds = body.number(); kinds > 0; kinds--) [body.number(), body.byte()];
        const mark = [[0x41], signed(marks + index), [0x41, 1, 0x3a, 0, 0]];
        const parts = [sized.subarray(begin, body.at), ...mark.map((it) => Buffer.from(it))];
        const made = Buffer.concat([...parts, sized.subarray(body.at)]);
        return Buffer.concat([leb(made.length), made]);
      }),
  });
  if (count > PAGE) throw new Error(`${count} functions; expected ${PAGE} at the most`);
  const memory = await run(watched);
  const found = new Uint8Array(memory.buffer, marks, count);
  return new Set([...found.keys()].filter((index) => found[index] === 1));
}

/** A number from 0 as the signed one that an instruction has. */
function signed(value) {
  const bytes = [];
  for (; value >= 64; value = Math.floor(value / 128)) bytes.push((value % 128) | 128);
  return [...bytes, value];
}

/** The module in which all but some functions are stubs, and the others, one after the other. */
export function split(module, functions) {
  const others = [];
  const opening = assembled(module, {
    [CODE]: (content) =>
      recoded(content, (body, index) => {
        if (functions.has(index) && !body.equals(STUB)) return body;
        others.push(body);
        return STUB;
      }),
  });
  return { opening, others: Buffer.concat(others) };
}
