// Questions about workload: ISA while the run goes on, NASA-TLX at its end.

import { button, byId, on, onSubmit } from "./dom.js";
import { Questionnaire } from "./questionnaire.js";

/** Ratings of the Instantaneous Self-Assessment (Tattersall & Foord 1996). */
const RATINGS = ["Under-used", "Relaxed", "Comfortable", "High", "Excessive"];
const PATIENCE_MS = 30_000; // for which ISA is asked

export class Workload {
  #live;
  #question = null;
  #timer = null;
  #tlx = null; // what is asked, or was asked last

  constructor(live) {
    this.#live = live;
    byId("isa-ratings").replaceChildren(
      ...RATINGS.map((name, i) =>
        button(`${i + 1} ${name}`, () => this.rate(i + 1), { title: `${name}: key ${i + 1}` }),
      ),
    );
    onSubmit(byId("tlx"), () => this.#give());
    on("tlx-skip", "click", () => this.#close({}));
    on("tlx-dialog", "cancel", (event) => event.preventDefault());
  }

  /**
   * Takes in the question that is open at the own seat, null for none, as where the seat is another
   * person's or the run is over; whoever has just taken the seat is not asked what is long ago.
   */
  take(question, now) {
    const before = this.#question;
    this.#question = question?.number ?? null;
    if (!question) {
      this.#hideIsa();
      byId("tlx-dialog").close();
    }
    if (!question || question.number === before) return;
    if (question.scale === "isa" && (now - question.t) * 1000 > PATIENCE_MS) return;
    if (question.scale === "isa") {
      byId("isa").hidden = false;
      clearTimeout(this.#timer);
      this.#timer = setTimeout(() => this.#hideIsa(), PATIENCE_MS);
    } else {
      this.#hideIsa();
      this.#tlx = new Questionnaire(byId("tlx-items"), this.#live.run.nasa_tlx);
      byId("tlx-state").textContent = "";
      if (!byId("tlx-dialog").open) byId("tlx-dialog").showModal();
    }
  }

  /** Rates the workload from 1 to 5, if that is asked. */
  rate(rating) {
    if (byId("isa").hidden) return;
    this.#answer({ isa: rating });
    this.#hideIsa();
  }

  #answer(answers) {
    const act = { do: "answer", question: this.#question, ...answers };
    this.#live.do(act, "Not answered: the connection is lost.");
  }

  #hideIsa() {
    clearTimeout(this.#timer);
    byId("isa").hidden = true;
  }

  #give() {
    const { missing } = this.#tlx;
    if (missing.length)
      byId("tlx-state").textContent = `Click on these lines as well: ${missing.join(", ")}.`;
    else this.#close({ nasa_tlx: this.#tlx.answers });
  }

  #close(answers) {
    this.#answer(answers);
    byId("tlx-dialog").close();
  }
}
