// The files that the page hands out, by the names of their buttons.

import type { ContactView } from "./contact";
import { save } from "./dom";
import { CHART_SIZE, courseTable, drawing, mapTable, png, svg, table } from "./files";
import type { Pen } from "./pen";
import type { Plane } from "./plane";
import type { State } from "./state";
import { nameOf, textOf, type SystemView } from "./system";
import type { Switch } from "./types";

/** What files are made of. */
export interface Sources {
  state: State;
  plane: Plane;
  contact: ContactView;
  system: SystemView;
  /** The names of the axes and of the values of a map. */
  axes: [string, string];
  fields: string[];
}

/** Writes a file, if there is something to write. */
export async function write(what: string, from: Sources): Promise<void> {
  const { plane } = from;
  const draw = (pen: Pen, width: number, height: number) =>
    plane.drawWith(pen, width, height);
  switch (what) {
    case "plane-svg":
      return save("plane.svg", svg(...plane.extent, draw), "image/svg+xml");
    case "plane-png":
      return save("plane.png", await png(...plane.extent, draw));
    case "plane-csv":
      return save("map.csv", mapTable(plane, from.axes, from.fields), "text/csv");
    case "plane-json": {
      const atlas = { axes: from.axes, ...plane.atlas };
      return save("atlas.json", JSON.stringify(atlas, null, 1), "application/json");
    }
    case "text":
      return save(`${nameOf(from.state)}.slip`, textOf(from.state));
    case "course-csv":
    case "events-csv": {
      const text = await tableOf(what, from);
      return text === undefined
        ? undefined
        : save(`${what.replace("-csv", "")}.csv`, text, "text/csv");
    }
  }
  const spheres = from.state.tab === "spheres";
  const name = spheres ? "contact" : nameOf(from.state);
  const chart = spheres ? from.contact.chart : from.system.chart;
  const found = spheres ? from.contact.contact?.document : from.system.run;
  if (what === "course-json" && found) {
    save(`${name}.json`, JSON.stringify(found, null, 2), "application/json");
  } else if (what === "course-svg" && chart) {
    save(`${name}.svg`, svg(...CHART_SIZE, drawing(chart)), "image/svg+xml");
  } else if (what === "course-png" && chart) {
    save(`${name}.png`, await png(...CHART_SIZE, drawing(chart)));
  }
}

async function tableOf(
  what: "course-csv" | "events-csv",
  { state, contact, system }: Sources,
): Promise<string | undefined> {
  const course = what === "course-csv";
  if (state.tab === "spheres") {
    if (course) {
      const fine = await contact.fine(state);
      return fine && courseTable(fine);
    }
    return contact.contact && switchTable(contact.contact.document.switches);
  }
  const { run, parsed } = system;
  if (!run || !parsed) return undefined;
  const names = parsed.components.map((it) => it.name);
  if (course) return table(["time", ...names], run.course);
  const sides = ["before", "after"].flatMap((side) => names.map((name) => `${name}_${side}`));
  const rows = run.events.map((it) => [
    it.time,
    it.event,
    it.from,
    it.to,
    ...it.before,
    ...it.after,
  ]);
  return table(["time", "event", "mode_before", "mode_after", ...sides], rows);
}

function switchTable(switches: Switch[]): string {
  const header = ["time", "time_left", "to", "side", "spring", "velocity"] as const;
  return table(
    [...header],
    switches.map((it) => header.map((name) => it[name])),
  );
}
