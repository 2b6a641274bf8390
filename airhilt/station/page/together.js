// Two recorded runs side by side: each is a page of its own, and both follow one clock.

import { Clock } from "./clock.js";
import { byId, html } from "./dom.js";
import { timeKeys, connectKeys } from "./keys.js";
import { Marks } from "./marks.js";
import { connectTheme } from "./theme.js";
import { Transport } from "./transport.js";

const PLACES = ["left", "right"];

/** The two runs as one, for the controls of the time. */
class TwoRuns {
  moments = [];
  calls = [];
  events = [];
  pair = null;

  add(run, place) {
    this.moments = [
      ...this.moments,
      ...run.moments.map((moment) => ({ ...moment, text: `${place}: ${moment.text}` })),
    ].sort((a, b) => a.t - b.t);
    this.calls = [...this.calls, ...run.calls];
    this.events = [...this.events, ...run.events];
  }

  apart() {
    return null;
  }
}

const runs = new TwoRuns(),
  clock = new Clock(0),
  frames = PLACES.map((place, i) => html("iframe", { title: `Run on the ${place}`, src: `${i}/` }));
const transport = new Transport(runs, clock),
  marks = new Marks(runs, clock);
window.together = {
  clock,
  /** Takes in the run of a part, and returns true if that part is the one to be heard. */
  join(part, run) {
    const i = frames.findIndex((frame) => frame.contentWindow === part);
    runs.add(run, PLACES[i]);
    transport.renew();
    clock.setEnd(run.end_s);
    marks.draw();
    if (frames.every((frame) => frame.contentDocument.body.dataset.together))
      document.body.dataset.ready = "true";
    return i === 0;
  },
};
connectTheme(() => marks.draw());
clock.listen(() => {
  transport.draw();
  marks.draw();
});
connectKeys(timeKeys(clock, transport));
byId("two").replaceChildren(...frames);
