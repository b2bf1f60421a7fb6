// Colours of maps, which people with any kind of colour vision can tell apart.

export type Rgb = [number, number, number];

/** Blue for reversal, white, orange for going on. */
const DIVERGING: Rgb[] = [
  [8, 48, 107],
  [33, 102, 172],
  [103, 169, 207],
  [209, 229, 240],
  [247, 247, 247],
  [253, 219, 181],
  [244, 165, 82],
  [204, 99, 20],
  [127, 59, 8],
];
/** Viridis: dark to bright, even in grey. */
const SEQUENTIAL: Rgb[] = [
  [68, 1, 84],
  [71, 44, 122],
  [59, 81, 139],
  [44, 113, 142],
  [33, 144, 141],
  [39, 173, 129],
  [92, 200, 99],
  [170, 220, 50],
  [253, 231, 37],
];
/** Counts: brightness alternates, so that neighbours differ. */
const COUNTS: Rgb[] = [
  [250, 246, 233],
  [171, 217, 233],
  [44, 123, 182],
  [253, 205, 124],
  [215, 99, 41],
  [118, 55, 122],
  [199, 165, 207],
  [17, 94, 89],
  [128, 205, 193],
  [140, 81, 10],
  [223, 194, 125],
  [64, 64, 64],
];

function along(stops: Rgb[], at: number): Rgb {
  const place = Math.max(0, Math.min(1, at)) * (stops.length - 1);
  const index = Math.min(stops.length - 2, Math.floor(place));
  const [one, other] = [stops[index] as Rgb, stops[index + 1] as Rgb];
  return one.map((it, channel) =>
    Math.round(it + ((other[channel] ?? 0) - it) * (place - index)),
  ) as Rgb;
}

function table(stops: Rgb[]): Rgb[] {
  return Array.from({ length: 256 }, (_, index) => along(stops, index / 255));
}

const TABLES = { diverging: table(DIVERGING), sequential: table(SEQUENTIAL) };
export type Ramp = keyof typeof TABLES;

/** The colour at a part of a ramp. */
export function ramp(name: Ramp, at: number): Rgb {
  const index = Math.max(0, Math.min(255, Math.round(at * 255)));
  return TABLES[name][index] as Rgb;
}

/** The colour of a number of switches; `by` is the difference between usual neighbours. */
export function ofCount(count: number, by: number): Rgb {
  return COUNTS[Math.floor(count / by) % COUNTS.length] as Rgb;
}

/** The colours of itineraries that were seen, in the order in which they were. */
const seen = new Map<number, Rgb>();

/** The colour of an itinerary, by its code: another one for each, and the same for a session. */
export function ofCode(code: number): Rgb {
  let colour = seen.get(code);
  if (!colour) {
    // Hues by the golden ratio, and three steps of brightness that also differ in grey.
    const index = seen.size;
    const light = [0.8, 0.46, 0.64][index % 3] ?? 0.5;
    colour = hsl((0.58 + index * 0.618033988749895) % 1, 0.52, light);
    seen.set(code, colour);
  }
  return colour;
}

function hsl(hue: number, saturation: number, light: number): Rgb {
  const reach = saturation * Math.min(light, 1 - light);
  const channel = (offset: number) => {
    const k = (offset + hue * 12) % 12;
    return Math.round(255 * (light - reach * Math.max(-1, Math.min(k - 3, 9 - k, 1))));
  };
  return [channel(0), channel(8), channel(4)];
}

export const NOTHING: Rgb = [128, 128, 128];

export function css([red, green, blue]: Rgb): string {
  return `rgb(${red},${green},${blue})`;
}

/** Whether black is readable on a colour. */
export function isBright([red, green, blue]: Rgb): boolean {
  return 0.299 * red + 0.587 * green + 0.114 * blue > 140;
}
