// What changes something: the token, requests, and pictures.

import { $ } from "./dom.js";

const KEY = "backcast-token";

/** Takes a token from the address, and out of it. */
export function takeToken() {
  const token = new URLSearchParams(location.hash.slice(1)).get("token");
  if (!token) return;
  sessionStorage.setItem(KEY, token);
  history.replaceState(null, "", location.pathname + location.search);
}

/** The token, asked for where it is not known; empty if nobody gives one. */
function askToken() {
  const known = sessionStorage.getItem(KEY);
  if (known) return Promise.resolve(known);
  const dialog = $("token-dialog");
  $("token").value = "";
  dialog.returnValue = "";
  dialog.showModal();
  return new Promise((resolve) => {
    dialog.addEventListener("close", () => {
      const token = dialog.returnValue === "ok" ? $("token").value.trim() : "";
      if (token) sessionStorage.setItem(KEY, token);
      resolve(token);
    }, { once: true });
  });
}

/** Asks the monitor for something; says beside the buttons what came of it. */
export async function ask(robot, method, what, body, done) {
  const token = await askToken();
  if (!token) return;
  const say = (text) => { $("actions-note").textContent = text; };
  say("…");
  try {
    const response = await fetch(`/api/v1/robots/${encodeURIComponent(robot)}/${what}`, {
      method,
      headers: { authorization: `Bearer ${token}`, ...(body && { "content-type": "application/json" }) },
      body: body && JSON.stringify(body),
    });
    if (response.status === 401 || response.status === 403) sessionStorage.removeItem(KEY);
    say(response.ok ? done : (await response.json()).error);
  } catch {
    say("The monitor does not answer.");
  }
}

/** Saves what the map shows, with a line that says what it is. */
export function savePicture(canvas, colors, title, ratio) {
  const strip = Math.round(40 * ratio);
  const copy = document.createElement("canvas");
  copy.width = canvas.width;
  copy.height = canvas.height + strip;
  const c = copy.getContext("2d");
  c.fillStyle = colors.ground;
  c.fillRect(0, 0, copy.width, copy.height);
  c.drawImage(canvas, 0, 0);
  c.fillStyle = colors.ink;
  c.font = `${Math.round(14 * ratio)}px system-ui, sans-serif`;
  c.textBaseline = "middle";
  c.fillText(title, 16 * ratio, canvas.height + strip / 2);
  copy.toBlob((blob) => {
    const link = document.createElement("a");
    link.href = URL.createObjectURL(blob);
    link.download = `backcast-${new Date().toISOString().replaceAll(":", "-").slice(0, 19)}.png`;
    link.click();
    setTimeout(() => URL.revokeObjectURL(link.href), 10000);
  }, "image/png");
}
