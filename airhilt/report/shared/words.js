// Numbers, places and commands in words.

const METRE_PER_NM = 1852;
const METRE_PER_FT = 0.3048;
const SEVERITIES = ["INFO", "ADVISORY", "CAUTION", "WARNING"];

const known = (value) => value !== null && value !== undefined;
/** A value in words, empty where it is not known or empty. */
const ifKnown = (value, text) => (known(value) && value !== "" ? text(value) : "");
const minus = (text) => text.replace("-", "−");
function fixed(value, digits) {
  const text = value.toFixed(digits);
  return minus(Number(text) === 0 ? text.replace("-", "") : text);
}
const WHOLE = new Intl.NumberFormat("en-US");
const whole = (value) => minus(WHOLE.format(Math.round(value) + 0)); // + 0: no negative zero
const seconds = (value, digits = 1) => `${fixed(value, digits)} s`;
const feet = (value) => `${whole(value)} ft`;
const miles = (value) => `${fixed(value, 2)} NM`;

function duration(value) {
  if (!known(value)) return "–";
  if (value === 0) return "0 s";
  if (value < 1e-3) return `${fixed(value * 1e6, 0)} µs`;
  if (value < 1) return `${fixed(value * 1e3, value < 0.01 ? 2 : 0)} ms`;
  return seconds(value, 2);
}

const words = (name) => name.replaceAll("_", " ");
const compass = (value, positive, negative) => `${fixed(Math.abs(value), 4)}° ${value < 0 ? negative : positive}`;
const bearing = (degrees) => `${String(Math.round(degrees) % 360 || 360).padStart(3, "0")}°`;
const metres = (value) => (value < 10 ? `${fixed(value, 1)} m` : value < 10000 ? `${whole(value)} m` : `${fixed(value / 1000, 1)} km`);
const list = (names) => (names.length > 1 ? `${names.slice(0, -1).join(", ")} and ${names.at(-1)}` : names[0] || "");

/** A position of a scenario or a command, in words. */
function place(position) {
  switch (position && position.type) {
    case "geodetic": return `${compass(position.lat_deg, "N", "S")}, ${compass(position.lon_deg, "E", "W")}`;
    case "from_centre": return `${miles(position.distance_nm)} from the centre, bearing ${bearing(position.bearing_deg)}`;
    case "hold_short": return `the hold short of runway ${position.runway} on ${position.taxiway}`;
    case "node": return position.node;
    case "runway": {
      const along = position.along_m < 0 ? `${metres(-position.along_m)} before` : `${metres(position.along_m)} past`;
      const aside = position.offset_m ? `, ${metres(Math.abs(position.offset_m))} ${position.offset_m < 0 ? "left" : "right"} of its centre line` : "";
      return `${along} the threshold of runway ${position.runway}${aside}`;
    }
    default: return "a place";
  }
}

/** A command, or what an advisory recommends, in words; a vehicle does not taxi, it drives. */
function instruction(action, drives = false) {
  const turn = (degrees) => `turn ${degrees < 0 ? "left" : "right"} ${fixed(Math.abs(degrees), 0)}°`;
  const climb = (sense) => ifKnown(action.climb_to_ft, (value) => `${sense}climb to ${feet(value)}`);
  switch (action && action.action) {
    case "altitude": return `${action.turn_deg ? `${turn(action.turn_deg)} and ` : ""}${action.sense || "go"} to ${feet(action.altitude_ft)}${ifKnown(action.vertical_rate_fpm, (rate) => ` at ${whole(rate)} ft/min`)}`;
    case "turn": return turn(action.degrees);
    case "maintain": return `maintain ${feet(action.altitude_ft)}`;
    case "track": return `turn to track ${bearing(action.track_deg)}`;
    case "speed": return `fly ${whole(action.cas_kt)} kt`;
    case "route": return `fly a route of ${counted(action.route, "point")}`;
    case "resume_route": return "go back to the route";
    case "drift_down": return "drift down";
    case "emergency_descent": return `descend in emergency to ${feet(action.altitude_ft)}`;
    case "line_up": return `line up on runway ${action.runway} and wait`;
    case "take_off": return `take off from runway ${action.runway}${climb(", ")}`;
    case "cancel_takeoff": return `cancel the takeoff${ifKnown(action.runway, (runway) => ` on runway ${runway}`)}`;
    case "land": return `land on runway ${action.runway}${action.via ? ` over ${counted(action.via, "point")}` : ""}`
      + (action.vacate === false ? ", and stop on it" : ifKnown(action.exit, (exit) => `, exit at ${words(exit)}`));
    case "go_around": return `go around${ifKnown(action.runway, (runway) => ` from runway ${runway}`)}${climb(", ")}`;
    case "side_step": return `side-step to runway ${action.runway}`;
    case "taxi": return `${drives ? "drive" : "taxi"} to ${place(action.to)}${action.via && action.via.length ? ` via ${action.via.join(", ")}` : ""}`
      + `${ifKnown(action.speed_kt, (speed) => ` at ${whole(speed)} kt`)}${action.off_taxiways ? ", straight off the taxiways" : ""}`;
    case "hold_position": return `hold position${ifKnown(action.runway, (runway) => ` short of runway ${runway}`)}`;
    case "continue": return "continue";
    case "move": return `${action.gait} to ${place(action.to)}${action.gait === "fly" ? ifKnown(action.height_ft, (height) => `, ${feet(height)} above the ground`) : ""}`;
    case "stand": return "stand still";
    case "confirm": return `confirm the ${words(action.slot)} of ${action.callsign}`;
    default: return action ? words(action.action) : "";
  }
}

const capital = (text) => text[0].toUpperCase() + text.slice(1);
const megahertz = (khz) => `${fixed(khz / 1000, 3)} MHz`;
const decibels = (value) => (known(value) ? `${fixed(value, 1)} dB` : "no noise");
const percent = (value) => (known(value) ? `${fixed(value * 100, 1)} %` : "–");
const counted = (n, one, many = `${one}s`) => `${whole(n)} ${n === 1 ? one : many}`;
