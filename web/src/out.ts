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

/** Writes a file, if there is something to write; returns why not. */
export async function write(what: string, from: Sources): Promise<string | undefined> {
  const { plane } = from;
  const draw = (pen: Pen, width: number, height: number) =>
    plane.drawWith(pen, width, height);
  switch (what) {
    case "plane-svg":
      return saved("plane.svg", svg(...plane.extent, draw), "image/svg+xml");
    case "plane-png":
      return saved("plane.png", await png(...plane.extent, draw));
    case "plane-csv":
      return saved("map.csv", mapTable(plane, from.axes, from.fields), "text/csv");
    case "plane-json": {
      const atlas = plane.traced && { axes: from.axes, ...plane.traced };
      return saved("atlas.json", atlas && JSON.stringify(atlas, null, 1), "application/json");
    }
    case "text":
      return saved(`${nameOf(from.state)}.slip`, textOf(from.state));
    case "course-csv":
    case "events-csv":
      return saved(`${what.replace("-csv", "")}.csv`, await tableOf(what, from), "text/csv");
  }
  const spheres = from.state.tab === "spheres";
  const name = spheres ? "contact" : nameOf(from.state);
  const chart = spheres ? from.contact.chart : from.system.chart;
  const found = spheres ? from.contact.contact?.document : from.system.run;
  if (what === "course-json")
    return saved(`${name}.json`, found && JSON.stringify(found, null, 2), "application/json");
  if (what === "course-svg")
    return saved(
      `${name}.svg`,
      chart && svg(...CHART_SIZE, drawing(chart)),
      "image/svg+xml",
    );
  return saved(`${name}.png`, chart && (await png(...CHART_SIZE, drawing(chart))));
}

/** Hands a file to the user, if there is its content; returns why not. */
function saved(
  name: string,
  content: Blob | string | undefined,
  type?: string,
): string | undefined {
  if (content === undefined) return `${name}: not computed`;
  save(name, content, type);
  return undefined;
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
