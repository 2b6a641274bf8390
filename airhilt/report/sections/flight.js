function drawNow() {
  const say = (id, name, text) => byId(id).replaceChildren(html("b", {}, name), text);
  const last = (events, t) => events.findLast((event) => (known(event.t_tx) ? event.t_tx : event.t) <= t);
  return (t) => {
    const apart = apartAt(t), call = last(calls, t), advisory = last(advisories, t);
    byId("clock").textContent = seconds(t);
    byId("slider").value = t;
    byId("slider").setAttribute("aria-valuetext", `${fixed(t, 1)} seconds`);
    say("now-separation", "Separation", apart ? apartText(apart).join(", ") : "–");
    say("now-radio", "Radio", call ? `${call.who}: “${call.text}”` : "nothing said yet");
    say("now-advisory", "Advisory", advisory ? `${advisory.active ? advisory.severity : "over"} to ${advisory.who}: ${advisory.text}` : "none yet");
  };
}

function drawPlayer() {
  const slider = byId("slider"), play = byId("play"), calm = matchMedia("(prefers-reduced-motion: reduce)");
  slider.max = endS;
  slider.addEventListener("input", () => clock.set(Number(slider.value)));
  let playing = false, lastFrame = 0, shown = 0;
  const stop = () => { playing = clock.playing = false; play.textContent = "Play"; clock.set(clock.t); };
  const setRate = () => { clock.rate = Number(byId("speed").value); byId("media-note").textContent = clock.rate > FASTEST_MEDIA ? ` up to ${FASTEST_MEDIA}×` : ""; };
  byId("speed").addEventListener("change", setRate);
  byId("sound").addEventListener("change", (event) => { clock.sound = event.target.checked; clock.set(clock.t); });
  requestAnimationFrame(() => { byId("media").hidden = !document.querySelector("audio, video"); }); // once all sections are drawn
  setRate();
  const frame = (now) => {
    if (!playing) return;
    const wait = calm.matches ? 1000 : 0; // steps of a second where motion is not wanted
    if (now - lastFrame >= wait) {
      shown = (now - lastFrame) / 1000 * clock.rate;
      lastFrame = now;
      clock.set(clock.t + shown);
    }
    if (clock.t >= endS) stop(); else requestAnimationFrame(frame);
  };
  play.addEventListener("click", () => {
    if (playing) { stop(); return; }
    if (clock.t >= endS) clock.set(0);
    playing = clock.playing = true;
    play.textContent = "Pause";
    lastFrame = performance.now();
    requestAnimationFrame(frame);
  });
}

return {
  draw() {
    if (airport) byId("speed").value = "5";
    drawPlayer();
    return drawNow();
  },
};
