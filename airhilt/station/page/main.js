// Reads a recorded run from the server, or follows a live one, and lets all panes follow one clock.

import { Advisories } from "./advisories.js";
import { Cameras } from "./cameras.js";
import { Clock, FollowingClock } from "./clock.js";
import { byId, html } from "./dom.js";
import { connectKeys, timeKeys } from "./keys.js";
import { Latencies } from "./latencies.js";
import { Live } from "./live.js";
import { Marks } from "./marks.js";
import { Run } from "./model.js";
import { Plan } from "./plan.js";
import { Profile } from "./profile.js";
import { Seat } from "./seat.js";
import { LiveSounds, Sounds } from "./sounds.js";
import { Talk } from "./talk.js";
import { connectTheme } from "./theme.js";
import { Traffic } from "./traffic.js";
import { Transcript } from "./transcript.js";
import { Transport } from "./transport.js";

const note = (text) => byId("notes").append(html("p", text));

async function begin() {
  const answer = await fetch("api/run");
  if (!answer.ok) throw new Error(`the server answers ${answer.status}`);
  const run = new Run(await answer.json()),
    together = window.parent === window ? null : window.parent.together;
  const clock = together
    ? new FollowingClock(run.end_s, together.clock)
    : new Clock(run.end_s, Boolean(run.live));
  if (together) document.body.dataset.together = "true";
  if (run.live) run.title = run.run.replace(/^Trial-/, "Trial ");
  document.title = `${run.title || run.run} - AIRHILT`;
  const folder = run.folder?.split(/[\\/]/).at(-1),
    assistant = run.summary?.assistant,
    named = [folder ?? run.run, assistant ? `assistant ${assistant}` : ""]
      .filter(Boolean)
      .join(", ");
  byId("title").textContent = together ? named : run.title || run.run;
  byId("subtitle").textContent = run.live
    ? ""
    : together
      ? run.title
      : [named, run.scenario.description].filter(Boolean).join(": ");
  byId("subtitle").title = run.scenario.description;
  byId("state").textContent = run.live ? "connecting" : run.phase;
  run.notes.forEach(note);

  const plan = new Plan(run, clock),
    profile = new Profile(run, clock),
    marks = new Marks(run, clock),
    latencies = new Latencies(run, clock);
  const live = run.live ? new Live(run, clock) : null,
    sounds = live ? new LiveSounds() : new Sounds(run, clock);
  const transcript = new Transcript(run, clock),
    cameras = new Cameras(run, clock, plan, (name) => live?.watch(name));
  const advisories = new Advisories(run, clock, {
    call: (id) => transcript.goTo(id),
    camera: (name) => cameras.choose(name),
  });
  const traffic = new Traffic(run, clock),
    transport = new Transport(run, clock);
  const panes = {
    profile,
    latencies,
    marks,
    transcript,
    advisories,
    traffic,
    cameras,
    sounds,
    transport,
  };
  connectTheme(() => {
    profile.redraw();
    latencies.draw();
    plan.redraw();
    marks.draw();
  });
  clock.listen(() => Object.values(panes).forEach((pane) => pane.draw()));
  clock.animate(() => plan.draw());
  const seat = live ? new Seat(run, live, clock, cameras) : null;
  const talk = live ? new Talk(run, live) : null;
  if (live) run.tuned = () => talk.heard;
  live?.connect({ ...panes, plan, seat, talk });
  connectKeys([
    ...timeKeys(clock, transport),
    // A seat has its volume.
    { names: ["m"], text: "sound off or on", isUsed: () => !run.own, act: () => sounds.mute() },
    { names: ["f"], text: "all traffic in the plan", act: () => plan.fit("all") },
    { names: ["+", "="], text: "zoom in", repeats: true, act: () => plan.zoom(1.5) },
    { names: ["-"], text: "zoom out", repeats: true, act: () => plan.zoom(1 / 1.5) },
    ...(run.seats?.length ? [...seat.keys, ...talk.keys] : []),
  ]);
  if (together && !together.join(window, run)) sounds.mute();
  document.body.dataset.ready = "true";
}

begin().catch((error) => note(`The page cannot be shown: ${error.message}`));
