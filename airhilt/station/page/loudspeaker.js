// What the person at a seat hears: the frequencies while somebody speaks there, and the assistant.

import { byId, html } from "./dom.js";

const RATE_HZ = 16000;
const AHEAD_S = 0.15; // between the coming of a piece of sound and its playing, against gaps
// By which sound is played later than it came: after a stall, old sound is left out.
const MOST_BEHIND_S = 1.5;
const MOST_SOURCES = 10; // pieces of a transmission that may still have to be stopped
// In which pieces sound comes; a shorter first one says how late the microphone is.
const PIECE_S = 0.5;
// Pieces of a transmission in slow motion, the newest: a call lasts 60 s at most.
const MOST_WAITING = 130;
// Frequency in Hz, and when each pulse begins, in s.
const TONES = { CAUTION: [700, [0]], WARNING: [1100, [0, 0.18, 0.36]] };
const PULSE_S = 0.12;
const WAKING_MS = 500; // that sound may take to begin after a click

export class Loudspeaker {
  #context = null;
  #gain = null;
  // Of each transmission: when its next piece is due, and those that are played.
  #playing = new Map();
  #waiting = new Map(); // pieces of the transmissions that are played when they have ended
  #begun = new Set(); // transmissions that have begun, and of which no sound has come yet
  #live;
  #isWanted = false;
  #silent = html("span", { class: "note", role: "status", hidden: true });
  #volume = html("input", { type: "range", min: 0, max: 1, step: 0.05, value: 0.8 });

  constructor(live) {
    this.#live = live;
    this.#volume.addEventListener("input", () => this.#setVolume());
    byId("hearing").append(html("label", "Volume", this.#volume), this.#silent);
    for (const gesture of ["pointerup", "keydown"])
      addEventListener(gesture, () => this.#isWanted && this.#context.resume());
  }

  /**
   * Begins to give out sound. A browser allows that after a click or a key alone, which a page that
   * was loaded again has not had: it says so until then.
   */
  begin() {
    if (!this.#context) {
      this.#context = new AudioContext({ latencyHint: "interactive" });
      this.#context.addEventListener("statechange", () => this.#tellSilence());
      this.#gain = this.#context.createGain();
      this.#gain.connect(this.#context.destination);
      this.#setVolume();
    }
    this.#isWanted = true;
    this.#context.resume();
    setTimeout(() => this.#tellSilence(), WAKING_MS);
    byId("hearing").hidden = false;
  }

  end() {
    this.#isWanted = false;
    this.#context?.suspend();
    for (const kept of [this.#playing, this.#waiting, this.#begun]) kept.clear();
    byId("hearing").hidden = true;
  }

  /**
   * Takes in pieces of transmissions, of which one's own are not heard, and none while one
   * transmits. Where time passes slowly, a transmission is heard when it has ended.
   */
  take(pieces, isTransmitting) {
    const { own, pace } = this.#live.run,
      ofOwn = `microphone.${own.replace(/[^A-Za-z0-9]+/g, "_")}.`,
      isSlow = Number.parseFloat(pace) < 1;
    for (const [phase, { id, pcm }] of pieces) {
      const isHeard =
        !id.startsWith(ofOwn) && !isTransmitting && this.#context?.state === "running";
      if (phase === "opened" && isHeard) this.#begun.add(id);
      if (phase === "closed") this.#close(id);
      if (pcm && isHeard) {
        if (isSlow) this.#keep(id, pcm);
        else this.#play(id, pcm);
      } else if (pcm) this.#begun.delete(id); // Its beginning is not heard.
    }
  }

  /** Keeps a piece until its transmission has ended. */
  #keep(id, pcm) {
    this.#waiting.set(id, [...(this.#waiting.get(id) ?? []), pcm].slice(-MOST_WAITING));
  }

  /**
   * Plays the tone of a severity and then the voice, and returns, once the first of them is
   * played, when its first sample is audible, in s from then; null if nothing is played.
   */
  async warn(severity, url) {
    const context = this.#context;
    if (!context || context.state !== "running" || !this.#isOn) return null;
    const begin = context.currentTime,
      [hertz, pulses] = TONES[severity] ?? [0, []];
    for (const at of pulses) this.#pulse(hertz, begin + at);
    const voice =
      url && this.#voice(url, begin + (pulses.length ? pulses.at(-1) + PULSE_S + 0.05 : 0));
    if (!pulses.length && !((await voice) && this.#isOn)) return null;
    return this.#delay;
  }

  /**
   * Plays a piece after those of its transmission that came before; `isOld`: they have all been
   * waiting.
   */
  #play(id, pcm, isOld = false) {
    const bytes = Uint8Array.from(atob(pcm), (letter) => letter.charCodeAt(0)),
      samples = new Int16Array(bytes.buffer);
    const buffer = this.#context.createBuffer(1, samples.length, RATE_HZ),
      channel = buffer.getChannelData(0);
    samples.forEach((sample, i) => {
      channel[i] = sample / 32768;
    });
    const now = this.#context.currentTime;
    let line = this.#playing.get(id);
    if (line && !isOld && line.due - now > MOST_BEHIND_S) {
      for (const source of line.sources) source.stop();
      line = { due: now, sources: [] };
    }
    line ??= { due: now + Math.max(PIECE_S - buffer.duration, 0) + AHEAD_S, sources: [] };
    const due = Math.max(line.due, now + AHEAD_S);
    line.sources = [...line.sources.slice(-MOST_SOURCES), this.#start(buffer, due)];
    if (this.#begun.delete(id) && this.#isOn)
      this.#live.do({ do: "hear", id, after_s: this.#live.afterArrival(due - now + this.#delay) });
    line.due = due + buffer.duration;
    this.#playing.set(id, line);
  }

  #start(buffer, at) {
    const source = this.#context.createBufferSource();
    source.buffer = buffer;
    source.connect(this.#gain);
    source.start(at);
    return source;
  }

  #pulse(hertz, at) {
    const oscillator = this.#context.createOscillator(),
      envelope = this.#context.createGain();
    oscillator.frequency.value = hertz;
    envelope.gain.setValueAtTime(0, at);
    envelope.gain.linearRampToValueAtTime(0.35, at + 0.01);
    envelope.gain.setValueAtTime(0.35, at + PULSE_S - 0.01);
    envelope.gain.linearRampToValueAtTime(0, at + PULSE_S);
    oscillator.connect(envelope).connect(this.#gain);
    oscillator.start(at);
    oscillator.stop(at + PULSE_S);
  }

  /** Plays a voice from a time on, and returns true; false if there is none, or no seat any more. */
  async #voice(url, at) {
    const sound = await this.#fetched(url).catch(() => null);
    if (!sound || this.#context.state !== "running") return false;
    this.#start(sound, Math.max(at, this.#context.currentTime));
    return true;
  }

  async #fetched(url) {
    const answer = await fetch(url);
    return answer.status === 200 ? this.#context.decodeAudioData(await answer.arrayBuffer()) : null;
  }

  #close(id) {
    for (const pcm of this.#waiting.get(id) ?? []) this.#play(id, pcm, true);
    for (const kept of [this.#playing, this.#waiting, this.#begun]) kept.delete(id);
  }

  /** Time in s from when a sample is due until it is audible, as far as the browser knows. */
  get #delay() {
    return (this.#context.outputLatency || 0) + (this.#context.baseLatency || 0);
  }

  /** True unless the volume is down: then nobody hears anything. */
  get #isOn() {
    return Number(this.#volume.value) > 0;
  }

  #tellSilence() {
    const isSilent = this.#isWanted && this.#context.state !== "running";
    this.#silent.textContent = isSilent ? "No sound: click or press a key." : "";
    this.#silent.hidden = !isSilent;
  }

  #setVolume() {
    if (this.#gain) this.#gain.gain.value = Number(this.#volume.value) ** 2;
  }
}
