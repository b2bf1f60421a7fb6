// The two spheres, drawn as they move through the contact.

import { fit, onceAFrame, sizeOf } from "./dom";
import type { Course } from "./course";
import { CanvasPen, type Path } from "./pen";
import { theme } from "./theme";
import type { Contact } from "./types";

/** The radius of a sphere, in units of length of the contact; real spheres are stiffer. */
const RADIUS = 2.6;
/** How long the spheres fly before and behind the contact. */
const FLIGHT = 1.1;

/** Where the spheres are at a time: distance, sideways shift, and turn. */
interface Pose {
  gap: number;
  shift: number;
  turn: number;
  sliding: number | undefined;
  normal: number;
  tangential: number;
}

export class Spheres {
  private course: Course | undefined;
  private contact: Contact | undefined;
  private shifts: Float64Array = new Float64Array();
  private turns: Float64Array = new Float64Array();
  private ratio = 1;
  private alpha = 2 / 7;
  private frame = 0;
  /** What was drawn last. */
  private drawn = "";
  private last = 0;
  /** The time that is shown, from −FLIGHT to the end of contact and FLIGHT beyond. */
  time = 0;
  speed = 0.5;
  playing = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly moved: (time: number | undefined) => void,
  ) {
    new ResizeObserver(() => this.draw()).observe(canvas);
  }

  /** Shows another contact, of spheres with this friction and inertia. */
  show(contact: Contact, course: Course, mu: number, alpha: number): void {
    [this.contact, this.course, this.alpha, this.ratio] = [contact, course, alpha, mu / alpha];
    const { time, velocity } = course;
    this.shifts = new Float64Array(time.length);
    this.turns = new Float64Array(time.length);
    for (let index = 1; index < time.length; index++) {
      const h = time[index]! - time[index - 1]!;
      const [one, other] = [this.speeds(velocity[index - 1]!), this.speeds(velocity[index]!)];
      this.shifts[index] = this.shifts[index - 1]! + (h * (one[0] + other[0])) / 2;
      this.turns[index] = this.turns[index - 1]! + (h * (one[1] + other[1])) / 2;
    }
    this.draw();
  }

  /** Shows no contact. */
  clear(): void {
    this.contact = this.course = undefined;
    this.drawn = "";
    fit(this.canvas);
  }

  /** The speeds of shift and turn, where the surfaces slide by w: only α of a change is shift. */
  private speeds(w: number): [number, number] {
    const before = this.contact?.document.parameters.psi ?? 0;
    const change = (w - before) * this.ratio;
    return [before * this.ratio + this.alpha * change, ((1 - this.alpha) * change) / (2 * RADIUS)];
  }

  private pose(at: number): Pose {
    const { contact, course } = this;
    const rest = { sliding: undefined, normal: 0, tangential: 0 };
    if (!contact || !course) return { gap: 2 * RADIUS, shift: 0, turn: 0, ...rest };
    const { time, compression, sliding, normal_force, tangential_force } = course;
    const last = time.length - 1;
    const end = time[last]!;
    if (at < 0)
      return {
        gap: -at,
        shift: at * this.speeds(contact.document.parameters.psi)[0],
        turn: 0,
        ...rest,
      };
    if (at > end) {
      const [shift, turn] = this.speeds(contact.document.w_final);
      const beyond = at - end;
      return {
        gap: beyond * contact.document.eps_n,
        shift: this.shifts[last]! + beyond * shift,
        turn: this.turns[last]! + beyond * turn,
        ...rest,
      };
    }
    let [low, high] = [0, last];
    while (high - low > 1) {
      const middle = (low + high) >> 1;
      if (time[middle]! <= at) low = middle;
      else high = middle;
    }
    const share = (at - time[low]!) / Math.max(1e-12, time[high]! - time[low]!);
    const mix = (column: Float64Array) => column[low]! + share * (column[high]! - column[low]!);
    return {
      gap: -mix(compression),
      shift: mix(this.shifts),
      turn: mix(this.turns),
      sliding: sliding[low]!,
      normal: mix(normal_force),
      tangential: mix(tangential_force),
    };
  }

  private get end(): number {
    return this.contact?.document.contact_time ?? 0;
  }

  toggle(): void {
    this.playing = !this.playing;
    if (!this.playing) return;
    if (this.time >= this.end + FLIGHT) this.time = -FLIGHT;
    this.last = performance.now();
    cancelAnimationFrame(this.frame);
    this.frame = requestAnimationFrame((now) => this.tick(now));
  }

  private tick(now: number): void {
    if (!this.playing) return;
    this.time += (Math.min(100, now - this.last) / 1000) * this.speed;
    this.last = now;
    if (this.time > this.end + FLIGHT) this.time = -FLIGHT;
    this.draw();
    this.moved(this.time >= 0 && this.time <= this.end ? this.time : undefined);
    this.frame = requestAnimationFrame((next) => this.tick(next));
  }

  /** Shows the spheres at a time of the contact. */
  seek(time: number): void {
    this.time = time;
    this.draw();
  }

  readonly draw = onceAFrame(() => this.drawNow());

  private drawNow(): void {
    if (sizeOf(this.canvas)[0] === 0 || !this.contact) return;
    const colours = theme();
    const pose = this.pose(this.time);
    // Before the contact, the spheres of all contacts look the same.
    const key = JSON.stringify([pose, this.time, sizeOf(this.canvas), devicePixelRatio, colours.ink]);
    if (key === this.drawn) return;
    this.drawn = key;
    const [context, width, height] = fit(this.canvas);
    const pen = new CanvasPen(context);
    const { gap, shift, turn, sliding, normal, tangential } = pose;
    const scale = height / (2 * RADIUS + 1.7);
    const centre = [width / 2, height / 2] as const;
    const apart = (2 * RADIUS + gap) / 2;
    // Side by side: the normal points across, and the tangential motion up and down.
    const bodies = [-1, 1].map((side) => ({
      x: centre[0] + side * apart * scale,
      y: centre[1] + (side * shift * scale) / 2,
      side,
    }));
    for (const { x, y, side } of bodies) {
      // Spheres in contact are flat where they meet.
      const from = side < 0 ? 0 : centre[0];
      pen.within(from, 0, width / 2, height, () => {
        pen.disc(x, y, RADIUS * scale, side < 0 ? colours.slipNegative : colours.slipPositive, {
          colour: colours.ink,
          width: 1.5,
        });
        for (let spoke = 0; spoke < 6; spoke++) {
          const angle = turn + (spoke * Math.PI) / 3;
          const [cos, sin] = [Math.cos(angle), Math.sin(angle)];
          const spokePath: Path = [
            [x + 0.55 * RADIUS * scale * cos, y + 0.55 * RADIUS * scale * sin],
            [x + 0.92 * RADIUS * scale * cos, y + 0.92 * RADIUS * scale * sin],
          ];
          pen.line(spokePath, { colour: colours.faint, width: spoke === 0 ? 3 : 1 });
        }
      });
    }
    if (sliding !== undefined) {
      const reach = 0.9 * scale;
      const middle = [centre[0], centre[1]] as const;
      pen.disc(...middle, 4, sliding === 0 ? colours.spring : colours.force, {
        colour: colours.paper,
        width: 1.5,
      });
      arrow(pen, middle, [-normal * reach, 0], colours.normal);
      arrow(pen, middle, [normal * reach, 0], colours.normal);
      arrow(pen, middle, [0, tangential * reach], colours.force);
    }
    const state =
      sliding === undefined
        ? this.time < 0
          ? "before the contact"
          : "behind the contact"
        : sliding === 0
          ? "stick"
          : sliding > 0
            ? "slip +"
            : "slip −";
    pen.text(state, 10, 18, { colour: colours.ink, size: 13, bold: true });
    pen.text(`t = ${this.time.toFixed(2).replace("-", "−")}`, width - 10, 18, {
      colour: colours.ink,
      size: 12,
      align: "right",
    });
  }
}

function arrow(
  pen: CanvasPen,
  [x, y]: readonly [number, number],
  [dx, dy]: [number, number],
  colour: string,
): void {
  const length = Math.hypot(dx, dy);
  if (length < 3) return;
  const [ux, uy] = [dx / length, dy / length];
  const head = Math.min(8, length);
  pen.line(
    [
      [x, y],
      [x + dx - ux * head * 0.6, y + dy - uy * head * 0.6],
    ],
    { colour, width: 3 },
  );
  const [tx, ty] = [x + dx, y + dy];
  pen.area(
    [
      [tx, ty],
      [tx - ux * head - uy * head * 0.5, ty - uy * head + ux * head * 0.5],
      [tx - ux * head + uy * head * 0.5, ty - uy * head - ux * head * 0.5],
    ],
    colour,
  );
}
