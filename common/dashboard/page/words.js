// Numbers and states in words. No page, no network.

export const ELLIPSE_95 = Math.sqrt(-2 * Math.log(0.05)); // deviations of an ellipse that holds 95 %
export const ANGLE_95 = 1.96; // deviations of an angle on either side

/** A number with a true minus, and none before zero. */
export function fixed(value, digits) {
  if (!Number.isFinite(value)) return "–";
  const text = value.toFixed(digits);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

/** A probability; the rest is not known so well that it could be none or all. */
export function percent(share) {
  if (!Number.isFinite(share)) return "–";
  if (share < 0.01) return "< 1 %";
  return share > 0.99 ? "> 99 %" : `${Math.round(share * 100)} %`;
}

export const degrees = (radians) => (radians * 180) / Math.PI;

/** A length of up to some metres. */
export const length = (metres) => (metres < 1 ? `${fixed(metres * 100, metres < 0.1 ? 1 : 0)} cm` : `${fixed(metres, 1)} m`);

/** How exact a pose is: the half axes and the angle that hold 95 %. */
export function exactness(ellipse) {
  const { major_m, minor_m, yaw } = ellipse;
  return { along: length(ELLIPSE_95 * major_m), across: length(ELLIPSE_95 * minor_m), turn: `${fixed(ANGLE_95 * degrees(yaw), 1)}°` };
}

/** How long something takes or lasts. */
export function duration(seconds) {
  const whole = Math.max(0, Math.floor(seconds));
  const [hours, minutes] = [Math.floor(whole / 3600), Math.floor(whole / 60) % 60];
  if (hours) return `${hours} h ${minutes} min`;
  return minutes ? `${minutes} min ${whole % 60} s` : `${whole} s`;
}

/** A time of day here. */
export const clock = (date) => date.toLocaleTimeString("en-GB");

/** A stamp as a day and a time here. */
export function stamp(seconds) {
  const date = new Date(seconds * 1000);
  const tenths = Math.floor((((seconds % 1) + 1) % 1) * 10);
  return `${date.toLocaleDateString("en-CA")} ${clock(date)}.${tenths}`;
}

export const sentence = (text) => (text && !/[.?!]$/.test(text) ? `${text}.` : text);

export const capital = (text) => text.slice(0, 1).toUpperCase() + text.slice(1);

/** What a state is called, what it means, and what to do where the tracker says nothing. */
export const STATES = {
  Unique: { word: "Unique", means: "The pose is known: one place fits.", todo: "" },
  Doubtful: { word: "Doubtful", means: "The pose is kept, but something speaks against it.", todo: "Drive on slowly, and watch whether it passes." },
  Searching: { word: "Searching", means: "The pose is not known yet.", todo: "Drive a few metres, or mark a region." },
  Lost: { word: "Lost", means: "The robot is not where it was; its place is searched.", todo: "Drive a few metres, or mark a region." },
  Ambiguous: { word: "Ambiguous", means: "Several places fit: this scan cannot tell which.", todo: "Drive a few metres, or mark a region." },
  PoorFit: { word: "Poor fit", means: "Even the best place fits badly.", todo: "Is it this map? Is the view blocked?" },
  NoScan: { word: "No scan", means: "No beam of the scan can be used.", todo: "Is the laser covered or dirty, or all beyond its range?" },
  NoData: { word: "No data", means: "No scan came.", todo: "" },
};

/** How grave a state is: 0 well, 1 a warning, 2 bad, 3 nothing known. */
export const gravity = (state) => ({ Unique: 0, Doubtful: 1, Searching: 1, Ambiguous: 1, Lost: 2, PoorFit: 2 })[state] ?? 3;
