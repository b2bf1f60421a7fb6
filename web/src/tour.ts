// A tour of a minute: a few views, each with some sentences.

import { byId, make } from "./dom";
import { presetOf } from "./presets";
import { DEFAULT, type State } from "./state";

interface Stop {
  title: string;
  words: string;
  preset: string;
  state: Partial<State>;
}

const STOPS: Stop[] = [
  {
    title: "Two spheres collide",
    words:
      "During one contact the tangential force switches between sliding (Coulomb) and a spring. Every point of the plane is one collision; its colour is how much of the tangential velocity is left.",
    preset: "plane",
    state: {},
  },
  {
    title: "Drag the point",
    words:
      "The right side shows the contact under the point: the force between its limits ±F, the velocity, and the spring. Shaded times are slip, the others stick. Each change of shade is a switch.",
    preset: "plane",
    state: { point: [18, 0.9] },
  },
  {
    title: "Boundaries",
    words:
      "Black lines are boundaries: a switch falls on the end of contact (full), or the force touches its limit (dashed). Between them nothing changes. Move the pointer over a region to see its itinerary.",
    preset: "plane",
    state: { point: [30, 0.6], quantity: "count" },
  },
  {
    title: "Zoom without end",
    words:
      "Wheel, pinch or + and − zoom; drag with Shift, or drag an axis, to move. Boundaries are traced anew for each window, to eight digits of its size.",
    preset: "plane",
    state: {
      x: { low: 40, high: 90, log: true },
      y: { low: 0.05, high: 0.7, log: false },
      point: [63, 0.5],
      quantity: "itinerary",
    },
  },
  {
    title: "The figures of the paper",
    words:
      "Presets show the six figures of Schwager, Becker and Pöschel (2008). These are the points a to o of Figure 4, on the line ακ = 18.",
    preset: "figure4",
    state: {},
  },
  {
    title: "Damping and other laws",
    words:
      "With damping a contact begins in stick. Particle codes have other laws: choose one by its name.",
    preset: "damped",
    state: {},
  },
  {
    title: "Your own system",
    words:
      "Any piecewise-smooth system is a text of a few lines. Its parameters have sliders, and two of them span a plane with its own boundaries.",
    preset: "plane",
    state: { tab: "system" },
  },
];

/** Starts the tour; `go` shows a state. */
export function tour(go: (state: State, preset: string) => void): void {
  const dialog = byId<HTMLDialogElement>("tour");
  let at = 0;
  const show = () => {
    const stop = STOPS[at] as Stop;
    const preset = presetOf(stop.preset);
    go({ ...(at === STOPS.length - 1 ? DEFAULT : preset.state), ...stop.state }, stop.preset);
    const last = at === STOPS.length - 1;
    const button = (name: string, act: () => void, own = {}) =>
      make("button", { type: "button", click: act, ...own }, name);
    const next = button(last ? "Done" : "Next", () => (last ? dialog.close() : step(1)), {
      class: "primary",
    });
    dialog.replaceChildren(
      make("h2", {}, stop.title),
      make("p", {}, stop.words),
      make(
        "div",
        { class: "row" },
        make("span", { class: "hint" }, `${at + 1} of ${STOPS.length}`),
        button("Back", () => step(-1), at === 0 ? { disabled: true } : {}),
        next,
        button("Close", () => dialog.close()),
      ),
    );
    next.focus();
  };
  const step = (by: number) => {
    at = Math.max(0, Math.min(STOPS.length - 1, at + by));
    show();
  };
  if (!dialog.open) dialog.show();
  dialog.onkeydown = (event) => {
    if (event.key === "Escape") dialog.close();
  };
  show();
}
