// Numbers as people read them.

const SUPERSCRIPTS: Record<string, string> = {
  "-": "⁻",
  "0": "⁰",
  "1": "¹",
  "2": "²",
  "3": "³",
  "4": "⁴",
  "5": "⁵",
  "6": "⁶",
  "7": "⁷",
  "8": "⁸",
  "9": "⁹",
};

/** A number with so many significant digits, without needless zeros. */
export function short(value: number, digits = 5): string {
  if (!Number.isFinite(value)) return "—";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= Math.min(1e6, 10 ** digits)) {
    const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
    const trimmed = (mantissa ?? "").replace(/\.?0+$/, "");
    return `${minus(trimmed)}·10${raised(Number(exponent))}`;
  }
  const text = value.toPrecision(digits);
  return minus(text.includes(".") ? text.replace(/\.?0+$/, "") : text);
}

/** A number with so many places behind the point. */
export function fixed(value: number, places: number): string {
  return Number.isFinite(value) ? minus(value.toFixed(places)) : "—";
}

/** An exponent in superscripts. */
export function raised(exponent: number): string {
  return [...String(exponent)].map((digit) => SUPERSCRIPTS[digit] ?? digit).join("");
}

/** The value rounded to so many significant digits. */
export function rounded(value: number, digits = 6): number {
  return Number(value.toPrecision(digits));
}

/** A real minus sign for the hyphen. */
export function minus(text: string): string {
  return text.replace(/^-/, "−");
}

/** The number that a user types, or undefined. Commas and fractions such as 2/7 are understood. */
export function typed(text: string): number | undefined {
  const words = text.replaceAll("−", "-").replaceAll(",", ".").split("/");
  const parts = words.map((word) => (word.trim() === "" ? NaN : Number(word)));
  if (parts.length > 2 || parts.some((part) => !Number.isFinite(part))) return undefined;
  const value = parts.length === 2 ? (parts[0] ?? 0) / (parts[1] ?? 1) : parts[0];
  return value !== undefined && Number.isFinite(value) ? value : undefined;
}
