// The name of this open page, which only it and the server know.

const STORED = "browser";
const unique = () =>
  Array.from(crypto.getRandomValues(new Uint8Array(12)), (byte) =>
    byte.toString(16).padStart(2, "0"),
  ).join("");
const own = sessionStorage.getItem(STORED) ?? unique();
const take = () => sessionStorage.removeItem(STORED);

// A tab that is duplicated while its page is open gets a copy of its storage, without the name.
take();
addEventListener("pageshow", take);
addEventListener("pagehide", () => sessionStorage.setItem(STORED, own));

/** The name that the page keeps when its connection is lost, or when it is loaded again. */
export const identity = () => own;
