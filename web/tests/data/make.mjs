// Makes the facts that the browser is compared with, by the native program:
//
//   node tests/data/make.mjs ../target/release/stickslip
//
// contacts.json has 500 contacts, atlases.json the regions of some windows.

import { execFileSync } from "node:child_process";
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from "node:fs";
import { tmpdir } from "node:os";
import { join } from "node:path";

const program = process.argv[2] ?? "stickslip";
const folder = mkdtempSync(join(tmpdir(), "facts-"));
const out = (name) => new URL(name, import.meta.url);

// A generator of Park and Miller: the same contacts everywhere.
let seed = 20081127;
const random = () => (seed = (seed * 48271) % 2147483647) / 2147483647;
const digits = (value) => Number(value.toPrecision(6));

const LAWS = [
  "gran/hooke/history",
  "gran/hertz/history",
  "granular/hertz/tsuji/mindlin_rescale/force",
  "mfix/HERTZIAN",
  "yade/FrictPhys_CundallStrack",
];
const groups = [
  { count: 250, law: "paper", damping: 0 },
  { count: 100, law: "paper", damping: 0.1 },
  { count: 50, law: "paper", damping: 0.6 },
  ...LAWS.map((law) => ({ count: 20, law, damping: law.startsWith("yade") ? 0 : 0.2 })),
];
const contacts = groups.flatMap(({ count, law, damping }) => {
  const rows = Array.from({ length: count }, () => [
    digits(Math.exp(Math.log(0.1) + random() * Math.log(5000))),
    digits(0.02 + 2.4 * random()),
  ]);
  const input = join(folder, "in.csv");
  const output = join(folder, "out.csv");
  rmSync(output, { force: true });
  writeFileSync(input, `kappa,psi\n${rows.map((row) => row.join(",")).join("\n")}\n`);
  const options = ["--damping", String(damping), "--law", law, "--method", "auto"];
  execFileSync(program, ["collide", "--batch", input, "--out", output, ...options], {
    stdio: ["ignore", "ignore", "inherit"],
  });
  const [header, ...lines] = readFileSync(output, "utf8")
    .trim()
    .split("\n")
    .map((line) => line.split(","));
  const field = (line, name) => line[header.indexOf(name)];
  return lines.map((line, index) => ({
    kappa: rows[index][0],
    psi: rows[index][1],
    law,
    damping,
    eps_t: Number(field(line, "eps_t")),
    eps_n: Number(field(line, "eps_n")),
    itinerary: field(line, "itinerary"),
    contact_time: Number(field(line, "contact_time")),
  }));
});
writeFileSync(
  out("contacts.json"),
  `[\n${contacts.map((it) => JSON.stringify(it)).join(",\n")}\n]\n`,
);

const windows = [
  { kappa: [5, 20], psi: [0.2, 2.5], damping: 0 },
  { kappa: [1, 100], psi: [0.02, 2.2], damping: 0 },
  { kappa: [0.5, 100], psi: [0.01, 3], damping: 0 },
  { kappa: [40, 90], psi: [0.05, 0.7], damping: 0 },
  { kappa: [62.9, 63.1], psi: [0.49, 0.51], damping: 0 },
  { kappa: [10, 12], psi: [0.3, 0.5], damping: 0 },
  { kappa: [100, 200], psi: [0.2, 1], damping: 0 },
  { kappa: [0.1, 2], psi: [0.5, 4], damping: 0 },
  { kappa: [5, 40], psi: [0.1, 2], damping: 0.1 },
  { kappa: [10, 30], psi: [0.2, 1.5], damping: 0.6 },
];
const atlases = windows.map((window, index) => {
  const file = join(folder, `${index}.json`);
  const options = [
    "--kappa",
    window.kappa.join(":"),
    "--psi",
    window.psi.join(":"),
    "--damping",
    String(window.damping),
  ];
  execFileSync(program, ["trace", ...options, "--out", file], {
    stdio: ["ignore", "ignore", "inherit"],
  });
  const { regions, boundaries } = JSON.parse(readFileSync(file, "utf8"));
  return {
    ...window,
    boundaries: boundaries.length,
    regions: regions.map((region) => region.itinerary).sort(),
  };
});
writeFileSync(
  out("atlases.json"),
  `[\n${atlases.map((it) => JSON.stringify(it)).join(",\n")}\n]\n`,
);
rmSync(folder, { recursive: true });
