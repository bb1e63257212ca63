// What is said of the robot, from all that is known. No page, no network.

import { capital, duration, sentence, STATES } from "./words.js";
import { troubles, whatToCheck } from "./what_to_check.js";

export const STALE_S = 2; // without a scan: nothing is live any more
const LIKELY = 0.01; // places that are less likely are left out where one is the only one
const LAGS_MS = 1000; // so late an answer is of a robot that has gone on
const FAR_M = 15; // driven without a pose: nothing in the map is like what the laser sees
const KNOWN = ["Unique", "Doubtful"];

/** The state in words. `kind` is empty where what is shown is past: then nothing is coloured. */
export function situation(store, link = "live", paused = false) {
  const { pose, answer } = store;
  const state = pose?.state ?? answer?.verdict ?? null;
  const silence = store.silence();
  const stale = silence === null || silence > STALE_S;
  const is = STATES[state] ?? { word: state ?? "Waiting", means: "Waiting for the first scan.", todo: "" };
  const why = pose ? pose.why : answer ? answer.says : "";
  const scanning = store.rawScanAt !== null && performance.now() - store.rawScanAt < 1000 * STALE_S;
  const said = { state, silence, stale, known: KNOWN.includes(state), best: state === "Unique", title: "What to check" };
  const past = state ? `Before: ${is.word}. ${capital(sentence(why))}` : "";
  if (link === "stopped") {
    return { ...said, stale: true, kind: "", word: "Stopped", means: "The graph was stopped.", why: past, todo: ["Start it again: backcast run. The page connects by itself."], title: "What to do" };
  }
  if (link === "lost") {
    return { ...said, stale: true, kind: "", word: "Disconnected", means: "The monitor does not answer.", why: past, todo: ["Is the robot on, and in reach of the network? The page connects again by itself."] };
  }
  if (paused) {
    return { ...said, stale: true, kind: "", word: "Paused", means: "The page is paused, the robot is not.", why: past, todo: ["Press space, or the button above, to continue."], title: "What to do" };
  }
  if (state && stale) {
    return { ...said, kind: "", word: "No data", means: `${scanning ? "Scans come, but no pose" : "No scan"} for ${duration(silence ?? 0)}: what is shown is past.`, why: past, todo: whatToCheck(store) };
  }
  if (!state) {
    return { ...said, kind: "", word: is.word, means: scanning ? "Scans come, and no answer yet." : is.means, why: "", todo: store.robot ? whatToCheck(store) : [] };
  }
  const failing = troubles(store);
  const todo = [...advice(store, is), ...failing, ...remarks(store, said)];
  const well = said.best && !failing.length;
  return { ...said, well, kind: state, word: is.word, means: is.means, why: sentence(why), todo: [...new Set(todo)], title: "What to do" };
}

/** What to do in this state, by the tracker or by the state alone. */
function advice(store, is) {
  const { pose } = store;
  if (pose?.why.startsWith("waiting for")) return whatToCheck(store);
  const text = pose?.advice || is.todo;
  return text ? [capital(sentence(text))] : [];
}

/** What neither the tracker nor a node can know. */
function remarks({ pose, answer, region }, { known }) {
  const late = (pose?.from_scan === false ? 0 : pose?.age_ms) ?? answer?.age_ms ?? 0;
  const seeks = pose && !known;
  return [
    late > LAGS_MS && `Answers come ${duration(late / 1000)} after their scans: is the machine overloaded?`,
    seeks && pose.since_m > FAR_M && `Nothing has fitted for ${Math.round(pose.since_m)} m: is it this map? See backcast doctor.`,
    seeks && region.length && "Only a region is searched: if the robot is elsewhere, search everywhere.",
  ].filter(Boolean);
}

/** The places of the last search that are worth a look, best first. */
export function candidates({ map, answer, pose }) {
  const places = (answer?.hypotheses ?? []).filter((place) => isOn(map, place));
  const unique = (pose?.state ?? answer?.verdict) === "Unique";
  return unique ? places.filter(({ probability }, i) => i === 0 || probability >= LIKELY) : places;
}

/** Those that have to be in view while it is not known which it is. */
export function contenders({ map, answer }) {
  const places = answer?.hypotheses ?? [];
  const likely = places.filter(({ probability }, i) => i <= (answer.alternatives ?? 0) || probability >= LIKELY);
  return likely.filter((place) => isOn(map, place));
}

const NO_MAP = "0".repeat(16);

/** Whether a place is on the map that is shown: of several, one is shown at a time. */
export const isOn = (map, { map_id }) => !map || map_id === map.map_id || map_id === NO_MAP;

/** The pose and its ellipse in a frame; the laser's where the base's is not known. */
export function inFrame(place, frame) {
  if (!place) return null;
  if (frame === "base_link" && place.base) return { ...place.base, ellipse: ellipseOf(place.base_covariance), frame };
  return place.laser ? { ...place.laser, ellipse: ellipseOf(place.laser_covariance), frame: "laser" } : null;
}

/** The ellipse of one standard deviation, of a covariance over x, y and yaw; null where there is none. */
function ellipseOf(covariance) {
  if (!covariance) return null;
  const [xx, xy, , , yy, , , , yaw] = covariance;
  const [mean, half] = [(xx + yy) / 2, Math.hypot((xx - yy) / 2, xy)];
  const [major_m, minor_m] = [mean + half, mean - half].map((variance) => Math.sqrt(Math.max(0, variance)));
  return { major_m, minor_m, angle: Math.atan2(2 * xy, xx - yy) / 2, yaw: Math.sqrt(Math.max(0, yaw)) };
}

/** Since when the state holds, seconds; null where that is not known. */
export function since({ pose, states }, now) {
  const period = states.at(-1);
  const seen = period ? (now - period.at) / 1000 : null;
  const measured = pose?.since_s > 0 ? pose.stamp_ns / 1e9 - pose.since_s : 0;
  // The monitor may have come later than the state.
  return states.length === 1 ? Math.max(seen, measured) : seen;
}
