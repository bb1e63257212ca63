// What is drawn on the map, one mark each; `c` is the canvas, lengths are pixels.

import { ELLIPSE_95 } from "./words.js";

/** A pointed shape with its tip ahead, and a light edge around it. */
export function drawArrow(c, [x, y], yaw, size, color, halo) {
  c.save();
  c.translate(x, y);
  c.rotate(-yaw);
  c.beginPath();
  c.moveTo(size, 0);
  c.lineTo(-size * 0.72, size * 0.66);
  c.lineTo(-size * 0.36, 0);
  c.lineTo(-size * 0.72, -size * 0.66);
  c.closePath();
  c.lineJoin = "round";
  c.lineWidth = size > 10 ? 4 : 2.5;
  c.strokeStyle = halo;
  c.stroke();
  c.fillStyle = color;
  c.fill();
  c.restore();
}

/** The ellipse that holds 95 %. */
export function drawEllipse(c, [x, y], ellipse, scale, line, fill) {
  if (!ellipse) return;
  const radius = (metres) => Math.max(1, metres * ELLIPSE_95 * scale);
  c.beginPath();
  c.ellipse(x, y, radius(ellipse.major_m), radius(ellipse.minor_m), -ellipse.angle, 0, 2 * Math.PI);
  c.fillStyle = fill;
  c.fill();
  c.strokeStyle = line;
  c.lineWidth = 1;
  c.stroke();
}

/** A ring around what is inspected. */
export function drawRing(c, [x, y], radius, color, halo) {
  for (const [width, style] of [[5, halo], [2, color]]) {
    c.beginPath();
    c.arc(x, y, radius, 0, 2 * Math.PI);
    c.lineWidth = width;
    c.strokeStyle = style;
    c.stroke();
  }
}

/** A ring with words beside it: where something was. */
export function drawFlag(c, [x, y], text, colors) {
  drawRing(c, [x, y], 9, colors.ink, colors.halo);
  c.font = "600 12px system-ui, sans-serif";
  c.textAlign = "left";
  c.textBaseline = "middle";
  c.lineWidth = 4;
  c.strokeStyle = colors.halo;
  c.strokeText(text, x + 15, y);
  c.fillStyle = colors.ink;
  c.fillText(text, x + 15, y);
}

/** Lines of a round number of metres, named at the edges. */
export function drawGrid(c, camera, step, colors) {
  const [left, top] = camera.toMap(0, 0);
  const [right, bottom] = camera.toMap(camera.width, camera.height);
  const name = (metres) => String(Math.round(metres * 100) / 100).replace("-", "−");
  c.lineWidth = 1;
  c.strokeStyle = colors.grid;
  c.fillStyle = colors.soft;
  c.font = "11px system-ui, sans-serif";
  c.beginPath();
  c.textAlign = "left";
  c.textBaseline = "top";
  for (let x = Math.ceil(left / step) * step; x <= right; x += step) {
    const [px] = camera.toScreen(x, 0);
    c.moveTo(Math.round(px) + 0.5, 0);
    c.lineTo(Math.round(px) + 0.5, camera.height);
    c.fillText(name(x), px + 3, 2);
  }
  c.textBaseline = "bottom";
  for (let y = Math.ceil(bottom / step) * step; y <= top; y += step) {
    const [, py] = camera.toScreen(0, y);
    c.moveTo(0, Math.round(py) + 0.5);
    c.lineTo(camera.width, Math.round(py) + 0.5);
    c.fillText(name(y), 3, py - 2);
  }
  c.stroke();
}

/** A cross in the middle: what keys move. */
export function drawCross(c, camera, colors) {
  const [x, y] = [camera.width / 2, camera.height / 2];
  for (const [width, style] of [[4, colors.halo], [1.5, colors.ink]]) {
    c.beginPath();
    c.moveTo(x - 8, y);
    c.lineTo(x + 8, y);
    c.moveTo(x, y - 8);
    c.lineTo(x, y + 8);
    c.lineWidth = width;
    c.strokeStyle = style;
    c.stroke();
  }
}
