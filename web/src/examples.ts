// The systems of `examples/systems`, and a plane that shows each one well.

import ball from "../../examples/systems/ball.slip";
import bangbang from "../../examples/systems/bangbang.slip";
import belt from "../../examples/systems/belt.slip";
import buck from "../../examples/systems/buck.slip";
import collision from "../../examples/systems/collision.slip";
import impact from "../../examples/systems/impact.slip";
import neuron from "../../examples/systems/neuron.slip";
import relay from "../../examples/systems/relay.slip";
import rocking from "../../examples/systems/rocking.slip";
import table from "../../examples/systems/table.slip";
import tank from "../../examples/systems/tank.slip";
import thermostat from "../../examples/systems/thermostat.slip";

import type { State } from "./state";

export interface Example {
  text: string;
  plane?: Pick<State, "across" | "up" | "sx" | "sy" | "most">;
}

export const EXAMPLES: Record<string, Example> = {
  ball: {
    text: ball,
    plane: {
      across: "e",
      up: "g",
      sx: { low: 0.3, high: 0.7, log: false },
      sy: { low: 5, high: 15, log: false },
      most: 6,
    },
  },
  bangbang: { text: bangbang },
  belt: {
    text: belt,
    plane: {
      across: "belt",
      up: "kinetic",
      sx: { low: 0.05, high: 0.8, log: false },
      sy: { low: 0, high: 0.7, log: false },
      most: 12,
    },
  },
  buck: {
    text: buck,
    plane: {
      across: "source",
      up: "gain",
      sx: { low: 15, high: 40, log: false },
      sy: { low: 4, high: 12, log: false },
      most: 12,
    },
  },
  collision: {
    text: collision,
    plane: {
      across: "kappa",
      up: "psi",
      sx: { low: 2, high: 30, log: false },
      sy: { low: 0.1, high: 2.2, log: false },
      most: 20,
    },
  },
  impact: {
    text: impact,
    plane: {
      across: "w",
      up: "e",
      sx: { low: 1, high: 3.5, log: false },
      sy: { low: 0.3, high: 1, log: false },
      most: 8,
    },
  },
  neuron: {
    text: neuron,
    plane: {
      across: "drive",
      up: "tau",
      sx: { low: 1.1, high: 4, log: false },
      sy: { low: 0.4, high: 2, log: false },
      most: 20,
    },
  },
  relay: { text: relay },
  rocking: {
    text: rocking,
    plane: {
      across: "e",
      up: "tilt",
      sx: { low: 0.5, high: 1, log: false },
      sy: { low: 0.02, high: 0.19, log: false },
      most: 8,
    },
  },
  table: {
    text: table,
    plane: {
      across: "a",
      up: "e",
      sx: { low: 0.001, high: 0.05, log: false },
      sy: { low: 0, high: 0.9, log: false },
      most: 8,
    },
  },
  tank: {
    text: tank,
    plane: {
      across: "inflow",
      up: "outlet",
      sx: { low: 0.05, high: 0.5, log: false },
      sy: { low: 0.4, high: 1, log: false },
      most: 12,
    },
  },
  thermostat: {
    text: thermostat,
    plane: {
      across: "heater",
      up: "outside",
      sx: { low: 18, high: 40, log: false },
      sy: { low: -10, high: 12, log: false },
      most: 12,
    },
  },
};
