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
  const slider = byId("slider"), button = byId("play"), calm = matchMedia("(prefers-reduced-motion: reduce)");
  slider.max = endS;
  slider.addEventListener("input", () => clock.set(Number(slider.value)));
  let lastFrame = 0;
  const play = (isPlaying) => {
    clock.playing = isPlaying;
    button.textContent = isPlaying ? "Pause" : "Play";
    clock.set(isPlaying && clock.t >= endS ? 0 : clock.t);
  };
  const setRate = () => { clock.rate = Number(byId("speed").value); byId("media-note").textContent = clock.rate > FASTEST_MEDIA ? ` up to ${FASTEST_MEDIA}×` : ""; };
  byId("speed").addEventListener("change", setRate);
  byId("sound").addEventListener("change", (event) => { clock.sound = event.target.checked; clock.set(clock.t); });
  requestAnimationFrame(() => { byId("media").hidden = !document.querySelector("audio, video"); }); // once all sections are drawn
  setRate();
  const frame = (now) => {
    if (!clock.playing) return;
    if (now - lastFrame >= (calm.matches ? 1000 : 0)) { // steps of a second where motion is not wanted
      clock.set(clock.t + (now - lastFrame) / 1000 * clock.rate);
      lastFrame = now;
    }
    if (clock.t >= endS) play(false); else requestAnimationFrame(frame);
  };
  button.addEventListener("click", () => {
    play(!clock.playing);
    lastFrame = performance.now();
    if (clock.playing) requestAnimationFrame(frame);
  });
}

return {
  draw() {
    if (airport) byId("speed").value = "5";
    drawPlayer();
    return drawNow();
  },
};
