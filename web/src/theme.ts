// Colours of drawings, which follow the scheme of the page.

export interface Theme {
  ink: string;
  faint: string;
  rule: string;
  paper: string;
  accent: string;
  slipPositive: string;
  slipNegative: string;
  normal: string;
  force: string;
  velocity: string;
  spring: string;
  pinned: string;
}

const NAMES: [keyof Theme, string][] = [
  ["ink", "--ink"],
  ["faint", "--faint"],
  ["rule", "--rule"],
  ["paper", "--paper"],
  ["accent", "--accent"],
  ["slipPositive", "--slip-positive"],
  ["slipNegative", "--slip-negative"],
  ["normal", "--normal"],
  ["force", "--force"],
  ["velocity", "--velocity"],
  ["spring", "--spring"],
  ["pinned", "--pinned"],
];

let known: Theme | undefined;

/** The colours of the present scheme. */
export function theme(): Theme {
  if (!known) {
    const style = getComputedStyle(document.documentElement);
    known = Object.fromEntries(
      NAMES.map(([key, name]) => [key, style.getPropertyValue(name).trim()]),
    ) as unknown as Theme;
  }
  return known;
}

/** Calls a function when the scheme changes. */
export function whenSchemeChanges(act: () => void): void {
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => {
    known = undefined;
    act();
  });
}
