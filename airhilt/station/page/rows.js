// Lists that follow the clock.

const QUIET_MS = 4000;

/** Scrolls a list so that a row can be seen, unless somebody has just scrolled or is in it. */
export function keepInView(list, row) {
  if (list.contains(document.activeElement) || performance.now() - Number(list.dataset.touched ?? -QUIET_MS) < QUIET_MS) return;
  const top = row.offsetTop - list.offsetTop;
  if (top < list.scrollTop || top + row.offsetHeight > list.scrollTop + list.clientHeight) list.scrollTop = Math.max(top - 8, 0);
}

/** Lets lists be read in peace: for some seconds after the wheel or a touch they do not follow the clock. */
export function noteReading(...lists) {
  for (const list of lists) {
    for (const event of ["wheel", "pointerdown"]) list.addEventListener(event, () => { list.dataset.touched = performance.now(); }, { passive: true });
  }
}
