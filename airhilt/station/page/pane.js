// A part of the page that shows a run at the time of a clock.

export class Pane {
  constructor(run, clock) {
    this.run = run;
    this.clock = clock;
  }
}
