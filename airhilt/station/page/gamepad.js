// A button of a gamepad, yoke or joystick with which one talks, as with the space bar.

import { byId, on } from "./dom.js";

const NAME = "airhilt-gamepad-button";

export class GamepadButton {
  #act;
  #button = Number(localStorage.getItem(NAME) ?? 0);
  #isDown = false;
  #isChoosing = false;
  #isPolling = false;

  /** `act(event, isDown)` is called when the button goes down or up. */
  constructor(act) {
    this.#act = act;
    on("gamepad-choose", "click", () => {
      this.#isChoosing = !this.#isChoosing;
      this.#draw();
    });
    window.addEventListener("gamepadconnected", () => {
      this.#draw();
      if (!this.#isPolling) this.#poll();
    });
    window.addEventListener("gamepaddisconnected", () => this.#draw());
    this.#draw();
  }

  get #pads() {
    return [...navigator.getGamepads()].filter((pad) => pad?.connected);
  }

  /** Looks at the buttons with each picture, as browsers give no events of them. */
  #poll() {
    const pads = this.#pads;
    this.#isPolling = pads.length > 0;
    if (!this.#isPolling) {
      this.#set(false, performance.now());
      return;
    }
    if (this.#isChoosing) {
      const down = (pad) => pad.buttons.findIndex((button) => button.pressed),
        pressed = Math.max(...pads.map(down));
      if (pressed >= 0) {
        this.#button = pressed;
        localStorage.setItem(NAME, pressed);
        this.#isChoosing = false;
        this.#draw();
      }
    } else {
      const pad = pads.find((one) => one.buttons[this.#button]?.pressed);
      this.#set(Boolean(pad), pad?.timestamp || performance.now());
    }
    requestAnimationFrame(() => this.#poll());
  }

  #set(isDown, timeStamp) {
    if (isDown === this.#isDown) return;
    this.#isDown = isDown;
    this.#act({ timeStamp: Math.min(timeStamp, performance.now()) }, isDown);
  }

  #draw() {
    byId("gamepad").hidden = !this.#pads.length;
    byId("gamepad-choose").textContent = this.#isChoosing ? "Leave it" : "Choose another";
    byId("gamepad-state").textContent = this.#isChoosing
      ? "Press the button that is to talk."
      : `Button ${this.#button + 1} of the gamepad talks.`;
  }
}
