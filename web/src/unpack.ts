// LZMA, decoded: the module is a third smaller than with the browser's own gzip.
//
// After the reference decoder in the LZMA specification of Igor Pavlov, which is in the public
// domain: https://www.7-zip.org/sdk.html. The input is a file of `xz --format=lzma` with a known
// size and the usual lc = 3, lp = 0, pb = 2.

const MODEL = 2048;
const LITERAL_CONTEXTS = 3;
const POSITIONS = 3;
const SIGN = 1 << 31;
const TOP = 0xff << 24;

/** Decodes a file of at most 2 GB. */
export function unpack(packed: Uint8Array, size: number): Uint8Array {
  const out = new Uint8Array(size);
  // Thirteen bytes of header, and one that is always 0.
  let at = 18;
  // Signed numbers of 32 bits, compared without their sign. Variables of closures would be objects
  // on a heap where they are larger than 31 bits; elements of an array are not.
  const coder = new Int32Array([
    -1,
    (packed[14]! << 24) | (packed[15]! << 16) | (packed[16]! << 8) | packed[17]!,
  ]);

  const bit = (probabilities: Uint16Array, index: number): number => {
    const probability = probabilities[index]!;
    let range = coder[0]!;
    let code = coder[1]!;
    const bound = Math.imul(range >>> 11, probability);
    let found = 0;
    if ((code ^ SIGN) < (bound ^ SIGN)) {
      range = bound;
      probabilities[index] = probability + ((MODEL - probability) >> 5);
    } else {
      range = (range - bound) | 0;
      code = (code - bound) | 0;
      probabilities[index] = probability - (probability >> 5);
      found = 1;
    }
    if ((range & TOP) === 0) {
      range <<= 8;
      code = (code << 8) | packed[at++]!;
    }
    coder[0] = range;
    coder[1] = code;
    return found;
  };
  const tree = (probabilities: Uint16Array, begin: number, bits: number): number => {
    let node = 1;
    for (let index = 0; index < bits; index++)
      node = (node << 1) | bit(probabilities, begin + node);
    return node - (1 << bits);
  };
  const reversed = (probabilities: Uint16Array, begin: number, bits: number): number => {
    let [node, found] = [1, 0];
    for (let index = 0; index < bits; index++) {
      const one = bit(probabilities, begin + node);
      node = (node << 1) | one;
      found |= one << index;
    }
    return found;
  };
  const even = (count: number) => new Uint16Array(count).fill(MODEL / 2);
  const lengths = () => {
    const [choice, low, middle, high] = [even(2), even(4 * 8), even(4 * 8), even(256)];
    return (position: number): number => {
      if (bit(choice, 0) === 0) return tree(low, position << 3, 3);
      if (bit(choice, 1) === 0) return 8 + tree(middle, position << 3, 3);
      return 16 + tree(high, 0, 8);
    };
  };

  const literals = even(0x300 << LITERAL_CONTEXTS);
  const [isMatch, isRepeated, isRepeated0, isRepeated1, isRepeated2, isLong] = [
    even(12 << 4),
    even(12),
    even(12),
    even(12),
    even(12),
    even(12 << 4),
  ] as const;
  const [slots, positions, aligned] = [even(4 << 6), even(1 + 128 - 14), even(16)] as const;
  const [matchLength, repeatedLength] = [lengths(), lengths()];
  let [state, rep0, rep1, rep2, rep3] = [0, 0, 0, 0, 0];
  let to = 0;

  const distance = (length: number): number => {
    const slot = tree(slots, Math.min(length, 3) << 6, 6);
    if (slot < 4) return slot;
    const bits = (slot >> 1) - 1;
    let found = (2 | (slot & 1)) << bits;
    if (slot < 14) return found + reversed(positions, found - slot, bits);
    let direct = 0;
    for (let index = bits - 4; index > 0; index--) {
      let range = (coder[0]! >>> 1) | 0;
      let code = coder[1]!;
      const one = (code ^ SIGN) >= (range ^ SIGN) ? 1 : 0;
      if (one) code = (code - range) | 0;
      direct = (direct << 1) | one;
      if ((range & TOP) === 0) {
        range <<= 8;
        code = (code << 8) | packed[at++]!;
      }
      coder[0] = range;
      coder[1] = code;
    }
    found += direct << 4;
    return found + reversed(aligned, 0, 4);
  };

  while (to < size) {
    const position = to & POSITIONS;
    if (bit(isMatch, (state << 4) + position) === 0) {
      const begin = 0x300 * ((to > 0 ? out[to - 1]! : 0) >> (8 - LITERAL_CONTEXTS));
      let symbol = 1;
      if (state >= 7) {
        let matched = out[to - rep0 - 1]!;
        do {
          const one = (matched >> 7) & 1;
          matched <<= 1;
          const found = bit(literals, begin + ((1 + one) << 8) + symbol);
          symbol = (symbol << 1) | found;
          if (one !== found) break;
        } while (symbol < 0x100);
      }
      while (symbol < 0x100) symbol = (symbol << 1) | bit(literals, begin + symbol);
      out[to++] = symbol & 255;
      state = state < 4 ? 0 : state < 10 ? state - 3 : state - 6;
      continue;
    }
    let length: number;
    if (bit(isRepeated, state) === 0) {
      [rep3, rep2, rep1] = [rep2, rep1, rep0];
      length = matchLength(position);
      state = state < 7 ? 7 : 10;
      rep0 = distance(length);
    } else {
      if (bit(isRepeated0, state) === 0) {
        if (bit(isLong, (state << 4) + position) === 0) {
          state = state < 7 ? 9 : 11;
          out[to] = out[to - rep0 - 1]!;
          to++;
          continue;
        }
      } else if (bit(isRepeated1, state) === 0) [rep0, rep1] = [rep1, rep0];
      else if (bit(isRepeated2, state) === 0) [rep0, rep1, rep2] = [rep2, rep0, rep1];
      else [rep0, rep1, rep2, rep3] = [rep3, rep0, rep1, rep2];
      length = repeatedLength(position);
      state = state < 7 ? 8 : 11;
    }
    const end = Math.min(size, to + length + 2);
    for (; to < end; to++) out[to] = out[to - rep0 - 1]!;
  }
  return out;
}
