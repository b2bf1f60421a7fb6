// Gestures on a canvas: drag, wheel, pinch, and keys, as moves of a window or of a point.

export interface Gestures {
  /** A press at a place, in pixels: does it take the point along, or the window? */
  grab(x: number, y: number): "point" | "window";
  /** The point is dragged to a place. */
  point(x: number, y: number): void;
  /** The window is moved by pixels, and zoomed about a place. */
  move(dx: number, dy: number, zoom: number, x: number, y: number): void;
  /** The pointer is over a place, perhaps while it drags the point, or nowhere. */
  hover(place: [number, number] | undefined, dragging?: boolean): void;
  /** The point is moved by steps. */
  step(dx: number, dy: number, fine: boolean): void;
}

/** How much one unit of the wheel zooms. */
const WHEEL = 1.0016;
const KEY_ZOOM = 1.25;
const KEY_MOVE = 60;

export function listen(canvas: HTMLElement, gestures: Gestures): void {
  const pressed = new Map<number, [number, number]>();
  let grabbed: "point" | "window" | undefined;

  const place = (event: MouseEvent): [number, number] => {
    const box = canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  };
  const spread = (): { centre: [number, number]; size: number } => {
    const [one, other] = [...pressed.values()] as [[number, number], [number, number]];
    const centre: [number, number] = [(one[0] + other[0]) / 2, (one[1] + other[1]) / 2];
    return { centre, size: Math.max(20, Math.hypot(one[0] - other[0], one[1] - other[1])) };
  };

  canvas.addEventListener("pointerdown", (event) => {
    if (event.button !== 0) return;
    canvas.setPointerCapture(event.pointerId);
    const at = place(event);
    pressed.set(event.pointerId, at);
    if (pressed.size > 1) grabbed = "window";
    else grabbed = event.shiftKey ? "window" : gestures.grab(...at);
    if (grabbed === "point") gestures.point(...at);
  });
  canvas.addEventListener("pointermove", (event) => {
    const at = place(event);
    const last = pressed.get(event.pointerId);
    if (!last || !grabbed) {
      gestures.hover(at);
      return;
    }
    if (pressed.size === 2) {
      const before = spread();
      pressed.set(event.pointerId, at);
      const after = spread();
      const [dx, dy] = [after.centre[0] - before.centre[0], after.centre[1] - before.centre[1]];
      gestures.move(dx, dy, after.size / before.size, ...after.centre);
      return;
    }
    pressed.set(event.pointerId, at);
    if (grabbed === "point") {
      gestures.point(...at);
      gestures.hover(at, true);
    } else gestures.move(at[0] - last[0], at[1] - last[1], 1, ...at);
  });
  const release = (event: PointerEvent) => {
    pressed.delete(event.pointerId);
    if (pressed.size === 0) grabbed = undefined;
  };
  canvas.addEventListener("pointerup", release);
  canvas.addEventListener("pointercancel", release);
  canvas.addEventListener("pointerleave", () => gestures.hover(undefined));
  canvas.addEventListener(
    "wheel",
    (event) => {
      event.preventDefault();
      const unit = event.deltaMode === 1 ? 20 : 1;
      gestures.move(0, 0, Math.pow(WHEEL, -event.deltaY * unit), ...place(event));
    },
    { passive: false },
  );
  canvas.addEventListener("keydown", (event) => {
    const [dx, dy] = ARROWS[event.key] ?? [0, 0];
    const middle: [number, number] = [canvas.clientWidth / 2, canvas.clientHeight / 2];
    if (event.ctrlKey || event.metaKey) return;
    if (dx || dy) {
      if (event.altKey) gestures.move(-dx * KEY_MOVE, dy * KEY_MOVE, 1, ...middle);
      else gestures.step(dx, dy, event.shiftKey);
    } else if (event.key === "+" || event.key === "=") gestures.move(0, 0, KEY_ZOOM, ...middle);
    else if (event.key === "-") gestures.move(0, 0, 1 / KEY_ZOOM, ...middle);
    else return;
    event.preventDefault();
  });
}

const ARROWS: Record<string, [number, number]> = {
  ArrowLeft: [-1, 0],
  ArrowRight: [1, 0],
  ArrowUp: [0, 1],
  ArrowDown: [0, -1],
};
