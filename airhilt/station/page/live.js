// A run that goes on: its changes come over a WebSocket, which is opened again when it is lost.

import { Pane } from "./pane.js";
import { byId } from "./dom.js";
import { identity } from "./identity.js";
import { Lag } from "./lag.js";
import { PACES } from "./run_pace.js";
import { capital, seconds } from "./words.js";

const RETRY_MS = 1000;
const ECHO_MS = 2000;
const SILENT_MS = 5000; // without an answer to an echo, after which another connection is opened
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
const KEPT = "seat-wish"; // name of the wish for a seat in the storage of the tab

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
  #wish = {}; // seat, uses and frequencies that the person wants
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
  #roundTrip = 0; // s
  #unanswered = []; // acts that the run has not answered, in their order: { resolve, reject }

  constructor(run, clock) {
    super(run, clock);
    const kept = JSON.parse(sessionStorage.getItem(KEPT));
    if (kept?.run === run.run) this.#wish = kept;
    this.#lag = new Lag(run);
    byId("link-reload").onclick = () => location.reload();
  }

  /** Begins to follow the run. */
  connect(panes) {
    this.#panes = panes;
    this.#open();
    setInterval(() => this.#listen(), SILENT_MS / 4);
    setInterval(() => this.echo(), ECHO_MS);
  }

  /** Asks the station for an answer at once. */
  echo() {
    this.send({ echo: performance.now() });
  }

  /** Time from when a message of now is with the server until a time from now, in s. */
  afterArrival(after) {
    return Math.max(-10, Math.min(10, after - this.#roundTrip / 2));
  }

  /** Time from an event on the page until a message of now is with the server, in s. */
  delay(event) {
    return Math.max(0, (performance.now() - event.timeStamp) / 1000 + this.#roundTrip / 2);
  }

  /** Lets the pictures of a camera come. */
  watch(name) {
    this.#watched = name;
    this.send({ watch: name });
  }

  #open() {
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
      this.#tell();
      this.#sendWish();
      this.watch(this.#watched);
    };
    this.#socket.onmessage = (event) => {
      this.#heard = performance.now();
      this.#take(JSON.parse(event.data));
    };
    this.#socket.onclose = ({ code, reason }) => {
      const isOld = code === OLD_PAGE || code === REPLACED;
      this.#lose(reason, isOld);
      if (!isOld && !this.run.isOver) setTimeout(() => this.#open(), RETRY_MS);
    };
  }

  /**
   * Opens another connection where nothing comes: the network is cut, or the station stands still.
   * The end of the old one may come much later, and says nothing new.
   */
  #listen() {
    const isLeft = this.#socket.readyState > WebSocket.OPEN || this.run.isOver;
    this.#lag.draw(this.isThere, this.#heard);
    if (isLeft || performance.now() - this.#heard < SILENT_MS) return;
    this.#socket.onmessage = this.#socket.onclose = null;
    this.#socket.close();
    this.#lose();
    this.#open();
  }

  /**
   * Tells that there is no connection, and of the acts of which nobody knows whether they were
   * done, the newest first.
   */
  #lose(why = "", isOld = false) {
    this.#lostAt ??= performance.now();
    this.#panes.talk.lost();
    for (const { reject } of this.#unanswered.splice(0).reverse()) reject({ wasSent: true });
    if (this.run.isOver) this.#tell();
    else this.#warn(why || `Connection lost, trying again. ${this.#seatMeanwhile}`, isOld);
  }

  /** What becomes of the own seat meanwhile, as far as the page can know. */
  get #seatMeanwhile() {
    if (!this.run.own) return "";
    return performance.now() - this.#lostAt < HOLD_MS
      ? "Until then nobody hears you. Your seat is kept for 5 s; then its script goes on."
      : "Until then nobody hears you. After more than 5 s your seat may have been given back. If the server has ended, it has to be started again.";
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

  /** True while the station can be reached. */
  get isThere() {
    return this.#socket?.readyState === WebSocket.OPEN;
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

  /** Keeps what the person wants, also when the page is loaded again. */
  #want(wish) {
    this.#wish = { ...wish, run: this.run.run };
    sessionStorage.setItem(KEPT, JSON.stringify(this.#wish));
  }

  /** Takes a seat with the uses to which the person agrees. */
  sit(seat, uses) {
    this.#want({ seat, uses });
    this.#sendWish();
  }

  /** Leaves the seat. */
  leave() {
    this.#want({});
    this.do({ do: "leave" });
  }

  /** Agrees to these uses from now on. */
  agree(uses) {
    this.#want({ ...this.#wish, uses });
    this.do({ do: "agree", uses });
  }

  /** Listens to these frequencies in kHz from now on. */
  tune(khz) {
    this.#want({ ...this.#wish, tuned: khz });
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

  /** Tells the run all that the person wants, so that nothing depends on what it has heard. */
  #sendWish() {
    const { seat, uses, tuned } = this.#wish;
    if (!seat || this.run.isOver) return;
    this.act({ do: "take" }, seat).then(
      (why) => {
        if (!why) return;
        this.#want({});
        this.refuse(why);
      },
      () => {},
    );
    this.act({ do: "agree", uses }).catch(() => {});
    if (tuned) this.act({ do: "tune", frequencies_khz: tuned }).catch(() => {});
  }

  /** Sends a message; returns false if there is no connection. */
  send(message) {
    if (this.isThere) this.#socket.send(JSON.stringify(message));
    return this.isThere;
  }

  /** Sends sound of the microphone. */
  sendSound(buffer) {
    if (this.isThere) this.#socket.send(buffer);
  }

  /** Number of bytes that wait to be sent. */
  get unsent() {
    return this.#socket?.bufferedAmount ?? 0;
  }

  #take(message) {
    const { next, changes, seats, own, answer, echo, forget, shown } = message;
    if (echo !== undefined) this.#roundTrip = (performance.now() - echo) / 1000;
    if (answer !== undefined) this.#unanswered.shift()?.resolve(answer && sentence(answer));
    if (forget) this.#forget(shown);
    if (seats) this.#takeSeats(seats);
    if (own) this.#takeOwn(own);
    const { plan, transcript, cameras, sounds, talk } = this.#panes,
      { pace, phase } = this.run,
      changed = this.run.apply(changes ?? []),
      has = (...kinds) => kinds.some((kind) => changed.has(kind));
    talk.take(message);
    // With its state, the frequencies of the seat are known.
    if (has("call") || own?.some(([kind]) => kind === "seat")) transcript.redraw();
    if (!changes) return;
    this.#seen = next;
    for (const [kind, ...rest] of changes) {
      if (kind === "picture") cameras.add(...rest);
      if (kind === "call" && this.clock.following && !this.run.own) sounds.add(rest[0]);
    }
    if (has("call")) this.#panes.seat.drawTasks();
    if (has("briefing")) plan.renew();
    if (has("state", "plot")) plan.keepFitted();
    if (has("camera")) cameras.renew();
    if (has("clock")) {
      this.#tell();
      this.#lag.told();
    }
    if (this.run.pace !== pace || this.run.phase !== phase) this.clock.paced();
    if (this.run.phase !== phase) this.#panes.seat.setPhase();
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
    const { seat, talk, transcript, plan } = this.#panes,
      before = this.run.own;
    seat.setSeats(seats);
    talk.setSeat(this.run.own);
    if (this.run.own === before) return;
    transcript.redraw();
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
    const { profile, marks, traffic, transport } = this.#panes;
    this.#drawing = null;
    this.#drawn = performance.now();
    if (this.#undrawn.has("call") || this.#undrawn.has("event")) transport.renew();
    if (this.#undrawn.has("event")) this.#tellRefused();
    if (this.#undrawn.has("track")) traffic.redraw();
    this.#undrawn.clear();
    profile.redraw();
    marks.draw();
  }
}
