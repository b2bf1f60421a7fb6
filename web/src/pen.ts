// What draws: on a canvas for the screen, and as SVG for files.

export interface Stroke {
  colour: string;
  width?: number;
  dash?: number[];
}

export interface Words {
  colour: string;
  size?: number;
  align?: "left" | "center" | "right";
  bold?: boolean;
  /** Turned by a quarter, to be read upwards. */
  up?: boolean;
  /** The colour of a rim that keeps words readable on a picture. */
  halo?: string;
}

export type Path = [number, number][];

/** A path as its number of points, and the coordinates of each. */
export interface Track {
  length: number;
  x(index: number): number;
  y(index: number): number;
}

export interface Pen {
  rectangle(x: number, y: number, width: number, height: number, fill: string): void;
  line(path: Path, stroke: Stroke): void;
  curve(track: Track, stroke: Stroke): void;
  area(path: Path, fill: string, stroke?: Stroke): void;
  disc(x: number, y: number, radius: number, fill: string, stroke?: Stroke): void;
  text(words: string, x: number, y: number, style: Words): void;
  picture(source: HTMLCanvasElement, x: number, y: number, width: number, height: number): void;
  /** Draws inside of a rectangle alone. */
  within(x: number, y: number, width: number, height: number, draw: () => void): void;
}

const FONT = "system-ui, -apple-system, 'Segoe UI', 'DejaVu Sans', sans-serif";

export class CanvasPen implements Pen {
  constructor(private readonly context: CanvasRenderingContext2D) {}

  rectangle(x: number, y: number, width: number, height: number, fill: string): void {
    this.context.fillStyle = fill;
    this.context.fillRect(x, y, width, height);
  }

  line(path: Path, stroke: Stroke): void {
    this.trace(path);
    this.stroke(stroke);
  }

  curve({ length, x, y }: Track, stroke: Stroke): void {
    /** Points that are closer in pixels are left out. */
    const NEAR = 1.2;
    const { context } = this;
    context.beginPath();
    let [lastX, lastY] = [NaN, NaN];
    for (let index = 0; index < length; index++) {
      const [atX, atY] = [x(index), y(index)];
      const near = Math.abs(atX - lastX) < NEAR && Math.abs(atY - lastY) < NEAR;
      if (near && index < length - 1) continue;
      context.lineTo(atX, atY);
      [lastX, lastY] = [atX, atY];
    }
    this.stroke(stroke);
  }

  area(path: Path, fill: string, stroke?: Stroke): void {
    this.trace(path);
    this.context.closePath();
    this.context.fillStyle = fill;
    this.context.fill();
    if (stroke) this.stroke(stroke);
  }

  disc(x: number, y: number, radius: number, fill: string, stroke?: Stroke): void {
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.context.fillStyle = fill;
    this.context.fill();
    if (stroke) this.stroke(stroke);
  }

  text(words: string, x: number, y: number, style: Words): void {
    const { context } = this;
    context.save();
    context.font = `${style.bold ? "600 " : ""}${style.size ?? 12}px ${FONT}`;
    context.textAlign = style.align ?? "left";
    context.translate(x, y);
    if (style.up) context.rotate(-Math.PI / 2);
    if (style.halo) {
      context.strokeStyle = style.halo;
      context.lineWidth = 3;
      context.lineJoin = "round";
      context.strokeText(words, 0, 0);
    }
    context.fillStyle = style.colour;
    context.fillText(words, 0, 0);
    context.restore();
  }

  picture(source: HTMLCanvasElement, x: number, y: number, width: number, height: number): void {
    this.context.drawImage(source, x, y, width, height);
  }

  within(x: number, y: number, width: number, height: number, draw: () => void): void {
    this.context.save();
    this.context.beginPath();
    this.context.rect(x, y, width, height);
    this.context.clip();
    draw();
    this.context.restore();
  }

  private trace(path: Path): void {
    this.context.beginPath();
    path.forEach(([x, y], index) =>
      index ? this.context.lineTo(x, y) : this.context.moveTo(x, y),
    );
  }

  private stroke({ colour, width = 1, dash = [] }: Stroke): void {
    this.context.strokeStyle = colour;
    this.context.lineWidth = width;
    this.context.lineJoin = "round";
    this.context.setLineDash(dash);
    this.context.stroke();
    this.context.setLineDash([]);
  }
}

export class SvgPen implements Pen {
  private readonly parts: string[] = [];
  private clips = 0;

  constructor(
    private readonly width: number,
    private readonly height: number,
    background: string,
  ) {
    this.rectangle(0, 0, width, height, background);
  }

  rectangle(x: number, y: number, width: number, height: number, fill: string): void {
    this.parts.push(
      `<rect x="${near(x)}" y="${near(y)}" width="${near(width)}" height="${near(height)}" fill="${fill}"/>`,
    );
  }

  curve({ length, x, y }: Track, stroke: Stroke): void {
    this.line(
      Array.from({ length }, (_, index) => [x(index), y(index)]),
      stroke,
    );
  }

  line(path: Path, stroke: Stroke): void {
    if (path.length > 1)
      this.parts.push(`<path d="${course(path)}" fill="none"${strokes(stroke)}/>`);
  }

  area(path: Path, fill: string, stroke?: Stroke): void {
    if (path.length > 1)
      this.parts.push(`<path d="${course(path)}Z" fill="${fill}"${strokes(stroke)}/>`);
  }

  disc(x: number, y: number, radius: number, fill: string, stroke?: Stroke): void {
    this.parts.push(
      `<circle cx="${near(x)}" cy="${near(y)}" r="${near(radius)}" fill="${fill}"${strokes(stroke)}/>`,
    );
  }

  text(words: string, x: number, y: number, style: Words): void {
    const anchor = { left: "start", center: "middle", right: "end" }[style.align ?? "left"];
    const turn = style.up ? ` transform="rotate(-90 ${near(x)} ${near(y)})"` : "";
    const rim = style.halo
      ? ` stroke="${style.halo}" stroke-width="3" stroke-linejoin="round" paint-order="stroke"`
      : "";
    this.parts.push(
      `<text x="${near(x)}" y="${near(y)}" font-size="${style.size ?? 12}" text-anchor="${anchor}"` +
        `${style.bold ? ' font-weight="600"' : ""} fill="${style.colour}"${rim}${turn}>${escaped(words)}</text>`,
    );
  }

  picture(source: HTMLCanvasElement, x: number, y: number, width: number, height: number): void {
    this.parts.push(
      `<image x="${near(x)}" y="${near(y)}" width="${near(width)}" height="${near(height)}" ` +
        `preserveAspectRatio="none" href="${source.toDataURL("image/png")}"/>`,
    );
  }

  within(x: number, y: number, width: number, height: number, draw: () => void): void {
    const id = `clip${++this.clips}`;
    this.parts.push(
      `<clipPath id="${id}"><rect x="${near(x)}" y="${near(y)}" width="${near(width)}" ` +
        `height="${near(height)}"/></clipPath><g clip-path="url(#${id})">`,
    );
    draw();
    this.parts.push("</g>");
  }

  /** The whole picture. */
  document(): string {
    return (
      `<svg xmlns="http://www.w3.org/2000/svg" width="${this.width}" height="${this.height}" ` +
      `viewBox="0 0 ${this.width} ${this.height}" font-family="${FONT.replaceAll("'", "")}">\n` +
      `${this.parts.join("\n")}\n</svg>\n`
    );
  }
}

function near(value: number): string {
  return String(Math.round(value * 100) / 100);
}

/** A path through the points that are numbers, as a canvas draws it. */
function course(path: Path): string {
  return path
    .filter(([x, y]) => Number.isFinite(x) && Number.isFinite(y))
    .map(([x, y], index) => `${index ? "L" : "M"}${near(x)} ${near(y)}`)
    .join("");
}

function strokes(stroke?: Stroke): string {
  if (!stroke) return "";
  const dash = stroke.dash?.length ? ` stroke-dasharray="${stroke.dash.join(" ")}"` : "";
  return ` stroke="${stroke.colour}" stroke-width="${stroke.width ?? 1}" stroke-linejoin="round"${dash}`;
}

function escaped(words: string): string {
  return words.replaceAll("&", "&amp;").replaceAll("<", "&lt;").replaceAll(">", "&gt;");
}
