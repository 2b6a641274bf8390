// Runs beside the audio of the browser: gives out 16 kHz samples of 16 bits while a call is made,
// and the level always.

const RATE_HZ = 16000,
  PIECE = RATE_HZ / 10;

class Microphone extends AudioWorkletProcessor {
  #isOn = false;
  #piece = new Int16Array(PIECE);
  #filled = 0;
  #peak = 0;
  #seen = 0;
  #sum = 0; // of the samples that make the next one, where the browser has a higher rate
  #weight = 0;

  constructor() {
    super();
    this.port.onmessage = ({ data }) => {
      this.#isOn = data.isOn;
      if (!this.#isOn) {
        this.#give();
        this.port.postMessage({ isOver: true });
      }
    };
  }

  process([[input]]) {
    for (const sample of input ?? []) {
      this.#peak = Math.max(this.#peak, Math.abs(sample));
      this.#seen += 1;
      if (this.#isOn) this.#add(sample);
    }
    if (this.#seen >= sampleRate / 20) {
      this.port.postMessage({ level: this.#peak });
      this.#peak = this.#seen = 0;
    }
    return true;
  }

  /** Adds a sample; at a higher rate, several make one by their mean. */
  #add(sample) {
    this.#sum += sample;
    this.#weight += RATE_HZ;
    if (this.#weight < sampleRate) return;
    const count = this.#weight / RATE_HZ;
    this.#piece[this.#filled++] = Math.max(
      -32768,
      Math.min(32767, Math.round((this.#sum / Math.max(1, Math.round(count))) * 32768)),
    );
    this.#sum = 0;
    this.#weight -= sampleRate;
    if (this.#filled === PIECE) this.#give();
  }

  #give() {
    if (this.#filled) this.port.postMessage({ pcm: this.#piece.slice(0, this.#filled).buffer });
    this.#filled = 0;
  }
}

registerProcessor("microphone", Microphone);
