// Other pages of the same machine, and whom an address is for.

/**
 * Returns the address of another page by the name under which this one was opened: the server may
 * not know it, as where it listens at all addresses. At its end is whom it is for: a seat.
 */
export function onThisHost(address, whom = "") {
  const found = new URL(address);
  found.hostname = location.hostname;
  found.hash = encodeURIComponent(whom);
  return found.href;
}

/** Returns whom the address of this page is for: a seat, or a participant; empty for nobody. */
export function addressee() {
  try {
    return decodeURIComponent(location.hash.slice(1));
  } catch {
    return ""; // It was not made by `onThisHost`.
  }
}
