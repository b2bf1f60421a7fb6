// Elements of the page: made and found.

type Attributes = Record<string, string | number | boolean | ((event: Event) => void) | undefined>;
type Child = Node | string | undefined;

/** Makes an element. An attribute that is a function listens to the event of its name. */
export function make<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: Child[]
): HTMLElementTagNameMap[K] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") element.addEventListener(name, value);
    else if (value === true) element.setAttribute(name, "");
    else if (value !== undefined && value !== false) element.setAttribute(name, String(value));
  }
  element.append(...children.filter((child) => child !== undefined));
  return element;
}

/** The element of an id, which the page has. */
export function byId<T extends HTMLElement = HTMLElement>(id: string): T {
  const element = document.getElementById(id);
  if (!element) throw new Error(`the page has no #${id}`);
  return element as T;
}

/** Puts a value into a control, unless it is being typed. */
export function put(id: string, value: string | number): void {
  const input = byId<HTMLInputElement | HTMLSelectElement>(id);
  if (input !== document.activeElement || input.type !== "text") input.value = String(value);
}

/** Hands a file to the user. */
export function save(name: string, content: Blob | string, type = "text/plain"): void {
  const blob = typeof content === "string" ? new Blob([content], { type }) : content;
  const link = make("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}

/** Makes the children of a box those nodes, and changes only what differs. Listeners of new nodes are
 * lost where an old node is kept. */
export function become(box: Element, nodes: Node[]): void {
  nodes.forEach((node, index) => {
    const old = box.childNodes[index];
    if (!old) box.append(node);
    else if (!merged(old, node)) old.replaceWith(node);
  });
  while (box.childNodes.length > nodes.length) box.lastChild?.remove();
}

/** Makes an old node like a new one, if they are of one kind. */
function merged(old: Node, node: Node): boolean {
  if (old.nodeName !== node.nodeName) return false;
  if (!(old instanceof Element && node instanceof Element)) {
    if (old.nodeValue !== node.nodeValue) old.nodeValue = node.nodeValue;
    return true;
  }
  for (const { name, value } of node.attributes)
    if (old.getAttribute(name) !== value) old.setAttribute(name, value);
  for (const name of old.getAttributeNames())
    if (!node.hasAttribute(name)) old.removeAttribute(name);
  become(old, [...node.childNodes]);
  return true;
}

const due = new Set<() => void>();
/** Milliseconds that the last frame took. */
export const frame = { work: 0 };

/** Calls a function once a frame, however often it is asked for. What a frame asks for is done in the
 * same frame. */
export function onceAFrame(act: () => void): () => void {
  return () => {
    if (due.size === 0) requestAnimationFrame(work);
    due.add(act);
  };
}

function work(): void {
  const begun = performance.now();
  // A set also gives what is added meanwhile.
  for (const act of due) {
    try {
      act();
    } catch (error) {
      // The others are drawn, and the next frame too.
      reportError(error);
    }
    due.delete(act);
  }
  frame.work = performance.now() - begun;
}

const sizes = new WeakMap<Element, [number, number]>();
const measure = (element: Element): [number, number] => {
  const size: [number, number] = [element.clientWidth, element.clientHeight];
  sizes.set(element, size);
  return size;
};
const watcher = new ResizeObserver((entries) => entries.forEach(({ target }) => measure(target)));

/** The size of a box in pixels. It is measured when it changes, since asking makes a layout. */
export function sizeOf(element: Element): [number, number] {
  const known = sizes.get(element);
  if (known) return known;
  watcher.observe(element);
  return measure(element);
}

/** Makes a canvas as large as its box, in device pixels; returns its context and size. */
export function fit(canvas: HTMLCanvasElement): [CanvasRenderingContext2D, number, number] {
  const ratio = window.devicePixelRatio || 1;
  const [width, height] = sizeOf(canvas);
  const [across, down] = [Math.round(width * ratio), Math.round(height * ratio)];
  if (canvas.width !== across || canvas.height !== down) {
    canvas.width = across;
    canvas.height = down;
  }
  const context = canvas.getContext("2d");
  if (!context) throw new Error("no canvas");
  context.setTransform(ratio, 0, 0, ratio, 0, 0);
  context.clearRect(0, 0, width, height);
  return [context, width, height];
}
