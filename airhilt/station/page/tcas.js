// What the TCAS II of the own aircraft tells its pilot.

import { whole } from "./words.js";

const CLEAR_S = 5; // for which a pilot is told that the conflict is over
const GREEN_FPM = 500; // width of the green band of a resolution advisory
const LEVEL_FPM = 250; // about level flight
const MOST_FPM = 6000; // end of the scale of a vertical speed indicator

/**
 * Returns what TCAS tells at a time: its words, its severity, and the vertical speeds in ft/min that are to be
 * flown (`green`) and avoided (`red`), each a pair, null if there are none. Null if it tells nothing.
 */
export function tcasOf(run, t) {
  const isOwn = (row) => row.equipment === "tcas" && run.textsOf(row).length > 0;
  const active = run.activeAdvisories(t).filter(isOwn),
    row = active.find(({ severity }) => severity === "WARNING") ?? active[0];
  if (row)
    return {
      words: inWords(row),
      severity: row.severity,
      ...bands(run.textsOf(row).at(-1).recommendation),
    };
  const over = run.advisories.some(
    (one) => !one.active && one.t <= t && t - one.t < CLEAR_S && isOwn(one),
  );
  return over ? { words: "CLEAR OF CONFLICT", severity: "INFO", green: null, red: null } : null;
}

/** The announcement of an advisory without its repetition, as in "descend, descend". */
const inWords = ({ severity, evidence }) =>
  (
    evidence.note.split(",")[0] || (severity === "WARNING" ? "resolution advisory" : "traffic")
  ).toUpperCase();

/**
 * The bands of the vertical speed indicator. Which side of level flight is to be avoided,
 * "maintain" does not tell.
 */
function bands(advised) {
  if (advised?.action === "maintain") return { green: [-LEVEL_FPM, LEVEL_FPM], red: null };
  if (advised?.action !== "altitude") return { green: null, red: null };
  const rate = advised.vertical_rate_fpm;
  return advised.sense === "climb"
    ? { green: [rate, rate + GREEN_FPM], red: [-MOST_FPM, rate] }
    : { green: [-rate - GREEN_FPM, -rate], red: [-rate, MOST_FPM] };
}

/** What TCAS tells, for a screen reader. */
export function spoken(told) {
  if (!told) return "";
  const rate = told.green ? `, fly ${told.green.map(whole).join(" to ")} feet per minute` : "";
  return `TCAS: ${told.words.toLowerCase()}${rate}`;
}
