// A run that goes on: its changes come over a WebSocket, which is opened again when it is lost.

import { Pane } from "./pane.js";
import { byId } from "./dom.js";
import { identity } from "./identity.js";
import { Lag } from "./lag.js";
import { PACES } from "./run_pace.js";
import { SeatWish } from "./seat_wish.js";
import { capital, seconds } from "./words.js";

const RETRY_MS = 1000;
const SILENT_MS = 4000; // an answer to an echo comes every two seconds
// Without a message, after which another connection is tried: the server has given this one up.
const DEAD_MS = 8000;
const HOLD_MS = 5000; // for which the server keeps a seat whose connection is lost
// Codes with which the server closes: the page has to be loaded again, or has another connection.
const OLD_PAGE = 4426,
  REPLACED = 4409;
const PHASES = {
  waiting: "waiting for the run",
  finished: "finished",
  stopped: "stopped",
  gone: "the run is not there any more",
};
const SLOWLY_MS = 1000; // between two drawings of what takes long

const SILENT = "Nothing comes from the station. What is shown is old";
const SILENT_AT_SEAT = "and nobody hears you. If it stays so, your seat is given back.";
const DEBRIEF =
  "Its debrief is on the first page of the station, or at “airhilt view” with its folder.";

/** Returns how a run has ended, in words. */
function ending({ title, phase }) {
  if (/^Trial \d+$/.test(title)) {
    return "The trial is over. Go back to the page of the experiment.";
  }
  if (phase === "gone") {
    return "The run has ended without saying so. What is shown is how far it came.";
  }
  return `The run ${phase === "finished" ? "is over" : "was stopped"}. ${DEBRIEF}`;
}

/** Returns the reason of a refusal as a sentence. */
export const sentence = (reason) => `${capital(reason).replace(/\.$/, "")}.`;

export class Live extends Pane {
  #wish;
  #panes;
  #socket = null;
  #watched = null;
  #drawn = 0;
  #drawing = null;
  #undrawn = new Set(); // kinds of changes that lists do not show yet
  #lag;
  #seen = 0;
  #shown = null; // the seat whose view is shown; null: what everybody sees
  #lostAt = null; // since when there is no connection, null while there is one
  #heard = 0; // when the last message came
  #isSilent = false;
  #unanswered = []; // acts that the run has not answered, in their order: { resolve, reject }

  constructor(run, clock) {
    super(run, clock);
    this.#wish = new SeatWish(run.run);
    this.#lag = new Lag(run);
  }

  /** Begins to follow the run. */
  connect(panes) {
    this.#panes = panes;
    this.#open();
    setInterval(() => this.#listen(), SILENT_MS / 4);
  }

  /** Lets the pictures of a camera come. */
  watch(name) {
    this.#watched = name;
    this.send({ watch: name });
  }

  #open() {
    this.#abandon();
    this.#lose();
    const url = new URL("api/live", location.href);
    url.protocol = url.protocol.replace("http", "ws");
    url.searchParams.set("from", this.#seen);
    if (this.#shown !== null) url.searchParams.set("shown", this.#shown);
    url.searchParams.set("browser", identity());
    url.searchParams.set("version", this.run.version ?? "");
    this.#socket = new WebSocket(url);
    this.#heard = performance.now();
    this.#socket.onopen = () => {
      this.#lostAt = null;
      this.#heard = performance.now();
      this.#tell();
      this.#sendWish();
      this.watch(this.#watched);
    };
    this.#socket.onmessage = (event) => {
      this.#heard = performance.now();
      if (this.#isSilent) {
        this.#isSilent = false;
        this.#tell();
      }
      this.#take(JSON.parse(event.data));
    };
    this.#socket.onclose = (event) => {
      this.#panes.talk.lost();
      this.#lose();
      if (this.run.isOver) {
        this.#tell();
        return;
      }
      const isOld = event.code === OLD_PAGE || event.code === REPLACED;
      this.#warn(
        event.reason ||
          (this.run.own
            ? `Connection lost, trying again. ${this.#seatMeanwhile}`
            : "Connection lost, trying again."),
        isOld,
      );
      if (!isOld) setTimeout(() => this.#open(), RETRY_MS);
    };
    byId("link-reload").onclick = () => location.reload();
  }

  /**
   * Leaves a connection over which nothing comes; its end may come much later, and says nothing
   * new.
   */
  #abandon() {
    if (!this.#socket) return;
    this.#socket.onopen = this.#socket.onmessage = this.#socket.onclose = null;
    this.#socket.close();
  }

  /** What becomes of the own seat meanwhile, as far as the page can know. */
  get #seatMeanwhile() {
    return performance.now() - this.#lostAt < HOLD_MS
      ? "Your seat is kept for 5 s; then its script goes on."
      : "After more than 5 s your seat may have been given back. If the server has ended, it has to be started again.";
  }

  /** Tells of the acts of which nobody knows whether they were done, the newest first. */
  #lose() {
    this.#lostAt ??= performance.now();
    const lost = this.#unanswered.reverse();
    this.#unanswered = [];
    for (const { reject } of lost) reject({ wasSent: true });
  }

  /**
   * Tells if nothing comes although the connection is there: the network is cut, or the station
   * stands still.
   */
  #listen() {
    const isOpen = this.#isOpen,
      isOpening = this.#socket.readyState === WebSocket.CONNECTING,
      silentMs = performance.now() - this.#heard;
    this.#isSilent = isOpen && !this.run.isOver && silentMs > SILENT_MS;
    this.#lag.draw(isOpen && !this.#isSilent, this.#heard);
    if (this.#isSilent) {
      this.#panes.talk.lost();
      this.#warn(this.run.own ? `${SILENT}, ${SILENT_AT_SEAT}` : `${SILENT}.`);
    }
    if (
      !this.run.isOver &&
      ((isOpen && silentMs > DEAD_MS) || (isOpening && silentMs > SILENT_MS))
    ) {
      this.#lostAt ??= this.#heard;
      this.#open();
    }
  }

  /** Shows large what keeps the page from following the run; nothing if it does. */
  #warn(text, isOld = false) {
    byId("link").hidden = !text;
    byId("link-text").textContent = text;
    byId("link-reload").hidden = !isOld;
    if (text) byId("state").textContent = isOld ? "not connected" : "connection lost";
  }

  #tell() {
    const { phase, pace } = this.run;
    this.#warn("");
    byId("state").textContent =
      PHASES[phase] ?? (pace === "paused" ? "paused" : `running, ${PACES[pace] ?? pace}`);
    if (!this.run.isOver) return;
    byId("link").hidden = false;
    byId("pace").hidden = true;
    byId("link-text").textContent = ending(this.run);
  }

  get #isOpen() {
    return this.#socket?.readyState === WebSocket.OPEN;
  }

  /** True while the station can be reached. */
  get isThere() {
    return this.#isOpen && !this.#isSilent;
  }

  /**
   * Does something at the own seat. It is resolved with the reason for which it is refused, which is
   * empty if it is not, and rejected with { wasSent } if the connection is lost before that is known.
   */
  act(act, seat = "") {
    return new Promise((resolve, reject) => {
      if (this.send({ act, seat })) this.#unanswered.push({ resolve, reject });
      else reject({ wasSent: false });
    });
  }

  /** Takes a seat with the uses to which the person agrees. */
  sit(seat, uses) {
    this.#wish.set({ seat, uses });
    this.#sendWish();
  }

  /** Leaves the seat. */
  leave() {
    this.#wish.set({});
    this.do({ do: "leave" });
  }

  /** Agrees to these uses from now on. */
  agree(uses) {
    this.#wish.set({ ...this.#wish, uses });
    this.do({ do: "agree", uses });
  }

  /** Listens to these frequencies in kHz from now on. */
  tune(khz) {
    this.#wish.set({ ...this.#wish, tuned: khz });
    this.do({ do: "tune", frequencies_khz: khz });
  }

  /**
   * Does something, and shows why it is refused, or what is given if the connection is lost: what
   * the wish has is sent again.
   */
  do(act, lost = "") {
    this.act(act).then(
      (why) => why && this.refuse(why),
      () => lost && this.refuse(lost),
    );
  }

  #sendWish() {
    const { seat, acts } = this.#wish;
    if (!seat || this.run.isOver) return;
    this.act(acts[0], seat).then(
      (why) => {
        if (!why) return;
        this.#wish.set({});
        this.refuse(why);
      },
      () => {},
    );
    for (const act of acts.slice(1)) this.act(act).catch(() => {});
  }

  /** Sends a message; returns false if there is no connection. */
  send(message) {
    if (this.#isOpen) this.#socket.send(JSON.stringify(message));
    return this.#isOpen;
  }

  /** Sends sound of the microphone. */
  sendSound(buffer) {
    if (this.#isOpen) this.#socket.send(buffer);
  }

  /** Number of bytes that wait to be sent. */
  get unsent() {
    return this.#socket?.bufferedAmount ?? 0;
  }

  #take(message) {
    const { next, changes, seats, own, answer, forget, shown } = message;
    if (answer !== undefined) this.#unanswered.shift()?.resolve(answer && sentence(answer));
    if (forget) this.#forget(shown);
    if (seats) this.#takeSeats(seats);
    if (own) this.#takeOwn(own);
    const { plan, transcript, cameras, sounds, talk } = this.#panes,
      { pace, phase } = this.run,
      changed = this.run.apply(changes ?? []),
      has = (...kinds) => kinds.some((kind) => changed.has(kind));
    talk.take(message);
    // The frequencies of the seat are known from now on.
    if (own?.some(([kind]) => kind === "seat")) transcript.redraw();
    if (!changes) return;
    this.#seen = next;
    for (const [kind, ...rest] of changes) {
      if (kind === "picture") cameras.add(...rest);
      if (kind === "call" && this.clock.following && !this.run.own) sounds.add(rest[0]);
    }
    if (has("call")) this.#panes.seat.drawTasks();
    if (has("briefing")) plan.renew();
    if (has("state", "plot")) plan.keepFitted();
    if (has("call")) transcript.redraw();
    if (has("camera")) cameras.renew();
    if (has("clock")) {
      this.#tell();
      this.#lag.told();
    }
    if (this.run.pace !== pace || this.run.phase !== phase) this.clock.paced();
    if (this.run.isOver) for (const pane of [this.#panes.seat, this.#panes.talk]) pane.end();
    for (const kind of changed) this.#undrawn.add(kind);
    this.#drawing ??= setTimeout(
      () => this.#drawLists(),
      Math.max(SLOWLY_MS - (performance.now() - this.#drawn), 0),
    );
    this.clock.setEnd(this.run.now ?? 0);
  }

  /** Shows why something was not done: at the seats, or where the run has none, below the title. */
  refuse(text) {
    if (this.run.seats?.length) this.#panes.seat.refuse(text);
    else byId("refused").textContent = text;
  }

  /** Shows who watches a run without seats what the run has refused last. */
  #tellRefused() {
    const last = this.run.seats?.length
      ? null
      : this.run.events.findLast(({ kind }) => kind === "refused");
    if (last) this.refuse(`Refused at ${seconds(last.t)}: ${last.text}`);
  }

  #takeSeats(seats) {
    const { seat, talk, transcript, advisories, plan } = this.#panes,
      before = this.run.own;
    seat.setSeats(seats);
    talk.setSeat(this.run.own);
    if (this.run.own === before) return;
    transcript.redraw();
    advisories.redraw();
    plan.fitFirst();
  }

  /** Takes in what only the person at the own seat sees. */
  #takeOwn(changes) {
    const { seat, plan } = this.#panes,
      before = this.run.ownCategory;
    seat.take(changes);
    if (this.run.ownCategory !== before) plan.fitFirst();
  }

  /** Forgets what was seen; all that the view of a seat, or nobody's (null), has comes next. */
  #forget(shown) {
    const { transcript, advisories, cameras, plan, seat, talk } = this.#panes;
    this.#seen = 0;
    this.#shown = shown;
    this.run.forget();
    for (const pane of [advisories, cameras, seat, talk]) pane.forget();
    transcript.redraw();
    plan.redraw();
    for (const kind of ["call", "event", "track"]) this.#undrawn.add(kind);
    clearTimeout(this.#drawing);
    this.#drawLists();
  }

  /** Draws what takes long: not with every message. */
  #drawLists() {
    const { profile, marks, advisories, traffic, transport } = this.#panes;
    this.#drawing = null;
    this.#drawn = performance.now();
    if (["advisory", "name", "briefing"].some((kind) => this.#undrawn.has(kind)))
      advisories.redraw();
    if (this.#undrawn.has("call") || this.#undrawn.has("event")) transport.renew();
    if (this.#undrawn.has("event")) this.#tellRefused();
    if (this.#undrawn.has("track")) traffic.redraw();
    this.#undrawn.clear();
    profile.redraw();
    marks.draw();
  }
}
