// The microphone of the person at a seat: opened if the voice may be used, transmitted while the
// button is held.

import { byId } from "./dom.js";
import { GamepadButton } from "./gamepad.js";

const MOST_UNSENT_BYTES = 64000; // two seconds of sound
const OPENING = "Opening the microphone.";
const WHY = {
  NotAllowedError:
    "The microphone was denied. Type what you want to say, or allow it in the browser and try again.",
  NotFoundError: "There is no microphone. Type what you want to say.",
  NotReadableError: "Another program has the microphone. Type what you want to say.",
};
/** What is told of the recogniser of the run, by its kind. */
const UNDERSTANDING = {
  none: "No recogniser takes part: only people understand you.",
  embedded:
    "The embedded recogniser has learned from synthetic voices and hears few people right. If you are not understood, type.",
};
const AUDIO = {
  channelCount: 1,
  echoCancellation: false,
  noiseSuppression: false,
  autoGainControl: true,
};

export class Microphone {
  #live;
  #frequencies;
  #state = null; // of the seat
  #opened = {}; // its stream, and the context and the node that read it
  #opening = null; // the attempt to open it that goes on
  #held = false;

  constructor(live, frequencies) {
    this.#live = live;
    this.#frequencies = frequencies;
    const button = byId("talk-button");
    button.addEventListener("pointerdown", (event) => {
      if (event.button === 0) {
        button.setPointerCapture(event.pointerId);
        this.press(event);
      }
    });
    for (const name of ["pointerup", "pointercancel"])
      button.addEventListener(name, () => this.release());
    button.addEventListener("click", () => {
      if (!this.#opened.node) this.#open();
    });
    window.addEventListener("blur", () => this.release());
    window.addEventListener("keydown", (event) => this.#key(event, true), { capture: true });
    window.addEventListener("keyup", (event) => this.#key(event, false), { capture: true });
    new GamepadButton((event, isDown) => this.#use(event, isDown));
    this.#draw();
  }

  get isHeld() {
    return this.#held;
  }

  /** Takes in the state of the own seat; null without a seat. */
  setState(state) {
    const isNew = !this.#state,
      mayHad = this.#mayOpen;
    this.#state = state;
    if (!this.#mayOpen && (mayHad || !state)) this.shut(state ? "Your voice is not used." : "");
    byId("talk").hidden = !state;
    byId("talk-button").disabled = !this.#mayOpen;
    if (!state || (!isNew && mayHad === this.#mayOpen)) return;
    if (!state.has_sound) this.#tell("This run has no sound. Type what you want to say.");
    else if (!state.uses.includes("voice"))
      this.#tell("To speak, choose beside the seat that your voice may be used.");
    else this.#tell(UNDERSTANDING[state.recogniser] ?? "");
  }

  get #mayOpen() {
    return Boolean(this.#state?.has_sound && this.#state.uses.includes("voice"));
  }

  /** Closes the microphone, also if it opens now, and tells why. */
  shut(why) {
    this.#opening?.abort();
    this.#opening = null;
    this.#close();
    this.#tell(why);
  }

  /** Takes in that nobody hears what is said from now on. */
  cut(why) {
    this.release();
    this.#tell(why);
  }

  /** Begins to transmit. */
  press(event) {
    if (this.#held || !this.#opened.node) return;
    if (!this.#live.isThere) {
      this.#tell("Nobody hears you: the connection is lost.");
      return;
    }
    this.#tell("");
    this.#held = true;
    const press = {
      do: "press",
      frequency_khz: this.#frequencies.transmit,
      delay_s: this.#live.delay(event),
    };
    this.#live.act(press).then(
      (why) => why && this.cut(why),
      () => {},
    );
    this.#opened.node.port.postMessage({ isOn: true });
    this.#draw();
  }

  /** Ends the transmission, once the last samples have been sent. */
  release() {
    if (!this.#held) return;
    this.#held = false;
    this.#opened.node?.port.postMessage({ isOn: false });
    this.#draw();
  }

  #key(event, isDown) {
    const { tagName, type } = event.target,
      isTyping =
        tagName === "SELECT" || tagName === "SUMMARY" || (tagName === "INPUT" && type === "text");
    if (event.key !== " " || !this.#mayOpen || isTyping || document.querySelector("dialog[open]"))
      return;
    event.preventDefault();
    event.stopPropagation();
    if (!event.repeat) this.#use(event, isDown);
  }

  /** Takes in that the space bar, or the button of a gamepad, goes down or up. */
  #use(event, isDown) {
    if (!this.#mayOpen || (isDown && document.querySelector("dialog[open]"))) return;
    if (!isDown) this.release();
    else if (this.#opened.node) this.press(event);
    else this.#open();
  }

  async #open() {
    this.#tell(OPENING);
    if (this.#opening) return;
    this.#opening = new AbortController();
    const { signal } = this.#opening,
      opened = await openMicrophone(signal).catch((error) => ({ error }));
    if (signal.aborted) return; // What has become of it was told then.
    const { error, node, stream } = opened;
    this.#opening = null;
    this.#opened = error ? {} : opened;
    this.#tell(
      !error
        ? ""
        : (WHY[error.name] ??
            `The microphone cannot be opened: ${error.message}. Type what you want to say.`),
    );
    this.#draw();
    if (error) return;
    node.port.onmessage = ({ data }) => this.#take(data);
    const gone = "The microphone is gone. Type what you want to say.";
    stream.getTracks()[0].addEventListener("ended", () => this.shut(gone));
  }

  #take({ pcm, level, isOver }) {
    if (level !== undefined) byId("talk-level").value = level;
    if (pcm && !this.#opened.node) return; // It was closed meanwhile.
    if (pcm && this.#live.unsent > MOST_UNSENT_BYTES) {
      this.release();
      this.#tell("Your call was cut: the connection is too slow.");
    } else if (pcm) this.#live.sendSound(pcm);
    if (isOver) this.#live.act({ do: "release" }).catch(() => {});
  }

  #close() {
    this.release();
    close(this.#opened);
    this.#opened = {};
    byId("talk-level").value = 0;
    this.#draw();
  }

  #draw() {
    const button = byId("talk-button");
    button.setAttribute("aria-pressed", this.#held);
    button.textContent = this.#opened.node
      ? this.#held
        ? "On the air"
        : "Hold to talk"
      : "Open the microphone";
    byId("talk-level").hidden = !this.#opened.node;
  }

  #tell(text) {
    byId("talk-state").textContent = text;
  }
}

/** Connects a stream at 16 kHz, or, where the browser cannot do that, at the rate of the device. */
function connected(stream) {
  let failure;
  for (const rate of [{ sampleRate: 16000 }, {}]) {
    const context = new AudioContext({ ...rate, latencyHint: "interactive" });
    try {
      return { context, source: context.createMediaStreamSource(stream) };
    } catch (error) {
      context.close();
      failure = error;
    }
  }
  throw failure;
}

/** Returns the stream of the microphone, with the context and the node that give out what it hears. */
async function openMicrophone(signal) {
  if (!navigator.mediaDevices) throw new DOMException("not secure", "SecurityError");
  const opened = { stream: await navigator.mediaDevices.getUserMedia({ audio: AUDIO }) };
  signal.addEventListener("abort", () => close(opened));
  try {
    signal.throwIfAborted();
    const { context, source } = connected(opened.stream);
    opened.context = context;
    await context.audioWorklet.addModule("page/microphone_worklet.js");
    await context.resume();
    const one = { numberOfOutputs: 0, channelCount: 1, channelCountMode: "explicit" };
    opened.node = new AudioWorkletNode(context, "microphone", one);
    source.connect(opened.node);
    return opened;
  } catch (error) {
    if (!signal.aborted || !opened.context) close(opened);
    throw error;
  }
}

/** Ends a microphone, so that the browser does not show it as open any more. */
function close({ stream, context }) {
  for (const track of stream?.getTracks() ?? []) track.stop();
  context?.close();
}
