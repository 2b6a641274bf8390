// Lists that follow the clock, or the run.

import { html } from "./dom.js";

const QUIET_MS = 4000;

/**
 * The rows of a list. A row that shows what it has shown before stays, with the focus and with what
 * is open in it.
 */
export class Rows {
  #list;
  #known = new Map(); // by names: what a row shows, and its element
  #current = []; // rows of what happens now
  #kept = null; // the row that is kept in view
  #touched = -QUIET_MS; // when somebody has scrolled last

  constructor(list) {
    this.#list = list;
    for (const event of ["wheel", "pointerdown", "keydown"])
      list.addEventListener(event, () => (this.#touched = performance.now()), { passive: true });
    // What is shown above the list takes room from it.
    new ResizeObserver(() => this.#keepInView()).observe(list);
  }

  /** Marks the rows of what happens now, and keeps the last of them, or another one, in view. */
  mark(rows, kept = rows.at(-1)) {
    const isSame = rows.length === this.#current.length && rows.every((row) => row.ariaCurrent);
    if (isSame && kept === this.#kept) return;
    for (const row of this.#current) row.removeAttribute("aria-current");
    for (const row of rows) row.ariaCurrent = "true";
    this.#current = rows;
    this.#kept = kept;
    this.#keepInView();
  }

  /**
   * Scrolls the list so that a row can be seen, unless somebody is in it or has just scrolled: then
   * it can be read in peace.
   */
  #keepInView() {
    const list = this.#list,
      row = this.#kept;
    if (
      !row ||
      list.contains(document.activeElement) ||
      performance.now() - this.#touched < QUIET_MS
    )
      return;
    const top = row.offsetTop - list.offsetTop;
    if (top < list.scrollTop || top + row.offsetHeight > list.scrollTop + list.clientHeight)
      list.scrollTop = Math.max(top - 8, 0);
  }

  /**
   * Shows a row for each thing: `name(thing)` identifies it, `make(thing)` makes its row. Without
   * things it shows a text. Returns the rows.
   */
  show(things, name, make, empty = "") {
    const before = this.#known,
      made = new Map();
    for (const thing of things) {
      const known = before.get(name(thing)),
        shown = JSON.stringify(thing);
      made.set(
        name(thing),
        known?.shown === shown ? known : { shown, item: make(thing), old: known?.item },
      );
    }
    this.#known = made;
    const rows = [...made.values()];
    for (const row of rows) if (row.old) this.#replace(row);
    this.#arrange(rows.length || !empty ? rows.map(({ item }) => item) : [html("li.empty", empty)]);
    return things.map((thing) => made.get(name(thing)).item);
  }

  /** Puts a row in the place of the one that it was, as far as that is open and has the focus. */
  #replace(row) {
    const { old, item } = row,
      parts = (node) => [...node.querySelectorAll("a, button, summary")];
    const focused = parts(old).indexOf(document.activeElement);
    item.querySelectorAll("details").forEach((one, i) => {
      one.open = old.querySelectorAll("details")[i]?.open ?? false;
    });
    old.replaceWith(item);
    parts(item)[focused]?.focus({ preventScroll: true });
    delete row.old;
  }

  /**
   * Makes these the elements of the list; those that are in it already are not moved, if their
   * order is the same.
   */
  #arrange(items) {
    const kept = new Set(items);
    for (const child of [...this.#list.children]) if (!kept.has(child)) child.remove();
    let next = this.#list.firstElementChild;
    for (const item of items) {
      if (item === next) next = next.nextElementSibling;
      else this.#list.insertBefore(item, next);
    }
  }
}
