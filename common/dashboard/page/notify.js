// A notification of the browser where the robot is lost or no data comes.

import { $, write } from "./dom.js";

const KEY = "backcast-notify";
const GRAVE = { Lost: "lost", NoData: "no data", Disconnected: "disconnected" };
let before = "";

const isPossible = () => "Notification" in window && window.isSecureContext;
const isOn = () => isPossible() && localStorage.getItem(KEY) === "on" && Notification.permission === "granted";

export function start() {
  $("notify").onclick = toggle;
  show();
}

async function toggle() {
  if (isOn()) localStorage.removeItem(KEY);
  else if ((await Notification.requestPermission()) === "granted") localStorage.setItem(KEY, "on");
  show();
}

function show() {
  $("notify").setAttribute("aria-pressed", isOn());
  $("notify").disabled = !isPossible() || Notification.permission === "denied";
  if (!isPossible()) write("notify-note", "Notifications need HTTPS or this machine's own browser.");
  else write("notify-note", Notification.permission === "denied" ? "The browser does not allow notifications of this page." : "");
}

/** Tells of what became grave, once. */
export function tell(robot, { state, word, why, kind, silence }) {
  const now = word === "Disconnected" ? "Disconnected" : !kind && word === "No data" && silence !== null ? "NoData" : state ?? "";
  if (now !== before && GRAVE[now] && before && isOn()) {
    new Notification(`${robot}: ${GRAVE[now]}`, { body: why, tag: `backcast-${robot}` });
  }
  if (word !== "Paused") before = now;
}
