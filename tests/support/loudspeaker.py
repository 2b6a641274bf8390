"""Sound that the loudspeaker of a page gives out, taken where the page hands it to the browser."""

from __future__ import annotations

from base64 import b64decode, b64encode

import numpy as np

from airhilt.audio.pcm import SAMPLE_RATE_HZ, Audio
from devtools import Page

SILENCE = 1e-4
"""Level below which there is no sound."""
TAP = """
    const code = `registerProcessor("tap", class extends AudioWorkletProcessor {
        #blocks = [];
        process([[samples]]) {
            this.#blocks.push(samples ? samples.slice() : new Float32Array(128));
            if (this.#blocks.length < 32) return true;
            this.port.postMessage(this.#blocks);
            this.#blocks = [];
            return true;
        }
    })`;
    window.given = { blocks: [], rate: 0 };
    const connect = AudioNode.prototype.connect, context = (node) => node.context;
    AudioNode.prototype.connect = function (to, ...more) {
        if (to === context(this).destination && context(this) instanceof AudioContext) {
            const place = URL.createObjectURL(new Blob([code], { type: "text/javascript" }));
            window.given.rate = context(this).sampleRate;
            context(this).audioWorklet.addModule(place).then(() => {
                const tap = new AudioWorkletNode(context(this), "tap", { numberOfOutputs: 0 });
                tap.port.onmessage = ({ data }) => window.given.blocks.push(...data);
                connect.call(this, tap);
            });
        }
        return connect.call(this, to, ...more);
    };
"""
"""Script that keeps all samples that go to the output of the page."""
TAKEN = """(() => {
    const samples = given.blocks.splice(0).flatMap((block) => [...block]);
    const pcm = Int16Array.from(samples, (one) => Math.max(-1, Math.min(1, one)) * 32767);
    let text = "";
    for (const byte of new Uint8Array(pcm.buffer)) text += String.fromCharCode(byte);
    return [given.rate, btoa(text)];
})()"""


COUNT_PIECES = """
    window.pieces = [];
    const start = AudioBufferSourceNode.prototype.start;
    AudioBufferSourceNode.prototype.start = function (...when) {
        window.pieces.push(this.buffer.duration);
        start.apply(this, when);
    };
    null
"""
"""Script that notes the length of each piece of sound that the page plays, in s."""
PIECES = "window.pieces.map((length_s) => Number(length_s.toFixed(3)))"


def piece(length_s: float) -> str:
    """Return a piece of silence as the server sends sound to pages."""
    return b64encode(bytes(2 * round(length_s * SAMPLE_RATE_HZ))).decode()


def tap(page: Page) -> None:
    """Keep what the pages that are opened from now on give out."""
    page.call("Page.setBypassCSP", enabled=True)  # For the script above, not for that of the page.
    page.call("Page.addScriptToEvaluateOnNewDocument", source=TAP)


def given_out(page: Page) -> Audio:
    """Return what the page has given out since it was asked last, at `SAMPLE_RATE_HZ`.

    It begins with the first sound: a recogniser is not made for the long silence before that.
    """
    rate_hz, pcm = page.evaluate(TAKEN)
    samples = np.frombuffer(b64decode(pcm), np.int16).astype(np.float32) / 32768.0
    times = np.arange(int(len(samples) * SAMPLE_RATE_HZ / rate_hz)) * rate_hz / SAMPLE_RATE_HZ
    audio = np.interp(times, np.arange(len(samples)), samples).astype(np.float32)
    sounding = np.flatnonzero(np.abs(audio) > SILENCE)
    begin = int(sounding[0]) if len(sounding) else len(audio)
    return np.asarray(audio[begin:], np.float32)
