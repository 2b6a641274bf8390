// The time shown, one for the whole page: it plays, pauses, jumps and loops, or follows a live run.

import { LiveTime } from "./live_time.js";

export const RATES = [0.25, 0.5, 1, 2, 4, 8];

const BETWEEN_TELLS_MS = 100; // between two drawings of what does not move, while a run is followed
const HIDDEN_MS = 500; // without a frame, as on a page that nobody sees

export class Clock {
  #listeners = [];
  #animations = [];
  #last = null;
  #run = new LiveTime();
  #isMoved = false; // since the panes of a live run were told last
  #frame = 0;

  /**
   * A clock of a run that lasts `end` seconds; while it is live, the end moves on, and may be
   * followed.
   */
  constructor(end, live = false) {
    this.t = 0;
    this.end = end;
    this.live = live;
    this.following = live;
    this.rate = 1;
    this.playing = false;
    this.loop = { from: null, to: null, on: false };
    if (!live) return;
    requestAnimationFrame((now) => this.#follow(now));
    setInterval(() => this.#isMoved && this.#tellMoved(), BETWEEN_TELLS_MS);
  }

  /** Calls a function with the clock, now and after each change. */
  listen(listener) {
    this.#listeners.push(listener);
    listener(this);
  }

  /**
   * Calls a function that draws what moves: after each change, and at each frame while a live run
   * is followed.
   */
  animate(draw) {
    this.#animations.push(draw);
    draw(this);
  }

  tell() {
    this.#listeners.forEach((listener) => listener(this));
    this.#animations.forEach((draw) => draw(this));
  }

  /** Shows a time in seconds. */
  set(t) {
    this.t = Math.min(Math.max(t, 0), this.end);
    this.following = false;
    this.tell();
  }

  /** Takes in that a live run has come to a time. */
  setEnd(end) {
    this.end = Math.max(end, this.end);
    this.#run.arrived(this.end, performance.now());
    this.#isMoved = this.live;
    if (!this.live) this.tell();
  }

  #tellMoved() {
    this.#isMoved = false;
    if (this.following && performance.now() - this.#frame > HIDDEN_MS) this.#jump();
    this.#listeners.forEach((listener) => listener(this));
  }

  /** Takes in that a live run has another pace from now on. */
  paced() {
    this.#run.paced();
  }

  #jump() {
    this.t = this.end;
    this.#run.jump(this.end);
  }

  #follow(now) {
    this.#frame = now;
    const t = this.#run.at(now);
    if (this.following && t !== this.t) {
      this.t = t;
      this.#animations.forEach((draw) => draw(this));
      this.#isMoved = true;
    }
    requestAnimationFrame((later) => this.#follow(later));
  }

  /** Shows what is happening now, as it happens. */
  follow() {
    this.playing = false;
    this.following = true;
    this.#jump();
    this.tell();
  }

  /** Plays, from the beginning if the end is shown. */
  play() {
    if (this.playing) return;
    const { from, on } = this.loop;
    if (this.t >= this.end) this.t = on ? from : 0;
    this.playing = true;
    this.#last = null;
    this.tell();
    requestAnimationFrame((now) => this.#tick(now));
  }

  pause() {
    this.playing = false;
    this.tell();
  }

  toggle() {
    if (this.following) this.set(this.t);
    else if (this.playing) this.pause();
    else if (this.live && this.t >= this.end) this.follow();
    else this.play();
  }

  setRate(rate) {
    this.rate = rate;
    this.tell();
  }

  /** Plays faster, or slower with a step of -1. */
  stepRate(step) {
    const i = RATES.indexOf(this.rate) + step;
    if (RATES[i]) this.setRate(RATES[i]);
  }

  /** Sets the begin or the end of the loop to the time shown; the loop is on once it has both. */
  mark(side) {
    const loop = { ...this.loop, [side]: this.t };
    if (loop.from !== null && loop.to !== null && loop.from >= loop.to)
      loop[side === "from" ? "to" : "from"] = null;
    loop.on = loop.from !== null && loop.to !== null;
    this.loop = loop;
    this.tell();
  }

  /** Switches the loop on or off. Without a begin and an end it is the whole run. */
  toggleLoop() {
    const { from, to, on } = this.loop;
    this.loop = { from: from ?? 0, to: to ?? this.end, on: !on };
    this.tell();
  }

  #tick(now) {
    if (!this.playing) return;
    if (this.#last !== null) {
      let t = this.t + Math.min((now - this.#last) / 1000, 0.5) * this.rate;
      if (this.loop.on && t >= this.loop.to && this.t <= this.loop.to) t = this.loop.from;
      if (t >= this.end) {
        this.playing = false;
        this.following = this.live;
      }
      this.t = Math.min(t, this.end);
      this.tell();
    }
    this.#last = now;
    if (this.playing) requestAnimationFrame((later) => this.#tick(later));
  }
}

/**
 * The clock of a page that is shown within another: what somebody does to it, the other page's
 * clock does.
 */
export class FollowingClock extends Clock {
  #leader;

  constructor(end, leader) {
    super(end);
    this.#leader = leader;
    for (const name of ["set", "toggle", "setRate", "stepRate", "mark", "toggleLoop"])
      this[name] = (given) => leader[name](given);
    leader.listen(() => this.#follow());
  }

  #follow() {
    this.t = Math.min(this.#leader.t, this.end);
    this.playing = this.#leader.playing && this.#leader.t < this.end;
    this.rate = this.#leader.rate;
    this.tell();
  }
}
