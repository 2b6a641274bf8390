// Other pages of the same machine.

/**
 * Returns the address of another page by the name under which this one was opened: the server may
 * not know it, as where it listens at all addresses.
 */
export function onThisHost(address) {
  const found = new URL(address);
  found.hostname = location.hostname;
  return found.href;
}
