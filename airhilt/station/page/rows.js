// Lists that follow the clock, or the run.

import { html } from "./dom.js";

const QUIET_MS = 4000;

/** Scrolls a list so that a row can be seen, unless somebody has just scrolled or is in it. */
export function keepInView(list, row) {
  if (
    list.contains(document.activeElement) ||
    performance.now() - Number(list.dataset.touched ?? -QUIET_MS) < QUIET_MS
  )
    return;
  const top = row.offsetTop - list.offsetTop;
  if (top < list.scrollTop || top + row.offsetHeight > list.scrollTop + list.clientHeight)
    list.scrollTop = Math.max(top - 8, 0);
}

/**
 * Lets lists be read in peace: for some seconds after the wheel or a touch they do not follow the
 * clock.
 */
export function noteReading(...lists) {
  for (const list of lists) {
    for (const event of ["wheel", "pointerdown"])
      list.addEventListener(
        event,
        () => {
          list.dataset.touched = performance.now();
        },
        { passive: true },
      );
  }
}

/**
 * The rows of a list. A row that shows what it has shown before stays, with the focus and with what
 * is open in it.
 */
export class Rows {
  #list;
  #known = new Map(); // by names: what a row shows, and its element

  constructor(list) {
    this.#list = list;
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
