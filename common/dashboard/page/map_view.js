// Draws the map and what was found in it.

import { Camera } from "./camera.js";
import { cellColors, fieldColors, palette } from "./colors.js";
import { STALE_S } from "./panel.js";

const MAX_SIDE = 8192; // pixels of an image along a side
const SIGMAS = 2.448; // of an ellipse that holds 95 %
const NEAR_M = 34; // what a view that begins shows at least
const BEAMS_MS = 500; // so long the beams of a scan are shown beside the tracker's pose
const LEASH = 0.3; // how far off the middle a followed robot may go, of the view

export class MapView {
  camera = new Camera();
  layers = { beams: true, hypotheses: true, track: true, field: false };
  follow = true;
  selection = null; // two corners of a region that is being chosen
  #levels = [];
  #fieldImage = null;
  #due = false;

  constructor(canvas, store) {
    this.canvas = canvas;
    this.store = store;
    this.theme("light");
    new ResizeObserver(() => this.#resize()).observe(canvas);
  }

  theme(name) {
    this.colors = palette(name);
    this.#paintMap();
    this.paintField();
  }

  /** Takes cells, or none. Shows all of them if the map is another one. */
  setCells(cells) {
    this.store.cells = cells;
    this.#levels = cells ? pyramid(cells, this.store.map.width, this.store.map.height) : [];
    this.#extent = cells ? knownExtent(this.#levels.at(-1)) : null;
    this.#paintMap();
    this.begin();
  }
  #extent = null;

  /** All that is known of the map. */
  fit() {
    const box = this.#box();
    if (box) this.camera.fit(box);
    this.follow = false;
    this.draw();
  }

  /** A small map as a whole, a large one around the robot. */
  begin() {
    const { camera } = this;
    const box = this.#box();
    if (!box) return this.draw();
    camera.fit(box);
    const near = Math.min(camera.width, camera.height) / NEAR_M;
    if (camera.scale < near) camera.scale = near;
    const best = this.store.best();
    if (best) [camera.x, camera.y] = [best.laser.x, best.laser.y];
    this.draw();
  }

  /** The outline of what is known, in the map's frame. */
  #box() {
    const { map } = this.store;
    if (!map || !this.#extent) return null;
    const { x, y, yaw } = map.map_from_grid;
    const [left, bottom, right, top] = this.#extent.map((cells) => cells * map.resolution_m);
    const turned = [[left, bottom], [right, bottom], [right, top], [left, top]].map(([a, b]) => [
      x + a * Math.cos(yaw) - b * Math.sin(yaw), y + a * Math.sin(yaw) + b * Math.cos(yaw)]);
    const [xs, ys] = [turned.map((p) => p[0]), turned.map((p) => p[1])];
    return { left: Math.min(...xs), right: Math.max(...xs), bottom: Math.min(...ys), top: Math.max(...ys) };
  }

  #resize() {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = Math.min(3, window.devicePixelRatio || 1);
    this.ratio = ratio;
    this.canvas.width = Math.max(1, Math.round(clientWidth * ratio));
    this.canvas.height = Math.max(1, Math.round(clientHeight * ratio));
    const first = this.camera.width <= 1;
    this.camera.width = clientWidth;
    this.camera.height = clientHeight;
    if (first) this.begin();
    this.draw();
  }

  #paintMap() {
    const table = cellColors(this.colors);
    for (const level of this.#levels) level.image = painted(level.cells, level.width, level.height, table);
    this.draw();
  }

  paintField() {
    const { field } = this.store;
    this.#fieldImage = null;
    if (field) {
      // Most of an image is about as high: what stands out is shown.
      const sorted = Uint8Array.from(field.pixels).filter((v) => v > 0).sort();
      const low = sorted[Math.floor(sorted.length * 0.8)] ?? 0;
      const table = fieldColors(this.colors, low);
      this.#fieldImage = painted(field.pixels, field.width, field.height, table);
    }
    this.draw();
  }

  /** Draws with the next frame of the screen. */
  draw() {
    if (this.#due) return;
    this.#due = true;
    requestAnimationFrame(() => {
      this.#due = false;
      this.#drawNow();
    });
  }

  #drawNow() {
    const { camera, colors, store, layers } = this;
    const best = store.best();
    if (this.follow && best) this.#keepInView(best.laser);
    const c = this.canvas.getContext("2d");
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.fillStyle = colors.ground;
    c.fillRect(0, 0, this.canvas.width, this.canvas.height);
    if (store.map) this.#drawCells(c);
    c.setTransform(this.ratio ?? 1, 0, 0, this.ratio ?? 1, 0, 0);
    this.#drawRegion(c);
    if (layers.track) this.#drawTrack(c);
    // While the tracker is sure, few scans are searched: beams of an old one lie elsewhere.
    const fresh = !store.pose || performance.now() - store.beamsAt < BEAMS_MS;
    if (layers.beams && store.beams && best && fresh) this.#drawBeams(c);
    if (layers.hypotheses) this.#drawOthers(c);
    if (best) this.#drawBest(c, best);
    this.ondrawn?.();
  }

  /** The view stays where it is as long as the robot is well within. */
  #keepInView({ x, y }) {
    const { camera } = this;
    const [right, up] = [camera.width, camera.height].map((side) => (LEASH * side) / camera.scale);
    camera.x = Math.min(x + right, Math.max(x - right, camera.x));
    camera.y = Math.min(y + up, Math.max(y - up, camera.y));
  }

  /** The map and the field, as images in the frame of the grid. */
  #drawCells(c) {
    const { map, field } = this.store;
    const { camera, ratio } = this;
    const { x, y, yaw } = map.map_from_grid;
    c.save();
    c.scale(ratio, ratio);
    c.translate(camera.width / 2, camera.height / 2);
    c.scale(camera.scale, -camera.scale);
    c.translate(x - camera.x, y - camera.y);
    c.rotate(yaw);
    const pixels = map.resolution_m * camera.scale * ratio;
    // The finest level may be coarser than the map, where that is large.
    const level = this.#levels.findLast(({ factor }) => factor * pixels <= 1.200) ?? this.#levels[0];
    if (level) {
      const side = map.resolution_m * level.factor;
      c.imageSmoothingEnabled = side * camera.scale * ratio < 3;
      c.imageSmoothingQuality = "high";
      c.drawImage(level.image, 0, 0, level.width * side, level.height * side);
    }
    if (this.layers.field && this.#fieldImage && field.map_id === map.id) {
      const side = map.resolution_m * field.block;
      c.imageSmoothingEnabled = true;
      c.drawImage(this.#fieldImage, 0, 0, field.width * side, field.height * side);
    }
    c.restore();
  }

  #drawRegion(c) {
    const corners = this.selection ?? this.store.region;
    if (corners.length < 2) return;
    const outline = corners.length === 2 ? rectangle(corners) : corners;
    c.beginPath();
    for (const [x, y] of outline) c.lineTo(...this.camera.toScreen(x, y));
    c.closePath();
    c.fillStyle = this.colors.accentSoft;
    if (this.selection) c.fill();
    c.setLineDash([7, 5]);
    c.lineWidth = 1.500;
    c.strokeStyle = this.colors.region;
    c.stroke();
    c.setLineDash([]);
  }

  /** Older parts are fainter; a leap is no way. */
  #drawTrack(c) {
    const { track } = this.store;
    c.lineWidth = 2;
    c.lineJoin = c.lineCap = "round";
    const part = Math.max(1, Math.ceil(track.length / 12));
    for (let from = 0; from < track.length; from += part) {
      c.beginPath();
      for (let i = Math.max(1, from); i < Math.min(track.length, from + part + 1); i++) {
        const [[x0, y0, v0], [x1, y1, v1]] = [track[i - 1], track[i]];
        if (v0 !== "U" || v1 !== "U" || Math.hypot(x1 - x0, y1 - y0) > 2) continue;
        c.moveTo(...this.camera.toScreen(x0, y0));
        c.lineTo(...this.camera.toScreen(x1, y1));
      }
      c.strokeStyle = `rgba(${this.colors.track},${0.15 + 0.6 * (from / track.length)})`;
      c.stroke();
    }
  }

  #drawBeams(c) {
    const { laser, bearing, range_m, fate } = this.store.beams;
    const from = this.camera.toScreen(laser.x, laser.y);
    const ends = bearing.map((angle, i) => this.camera.toScreen(
      laser.x + range_m[i] * Math.cos(laser.yaw + angle), laser.y + range_m[i] * Math.sin(laser.yaw + angle)));
    c.beginPath();
    for (const end of ends) {
      c.moveTo(...from);
      c.lineTo(...end);
    }
    c.strokeStyle = this.colors.ray;
    c.lineWidth = 1;
    c.stroke();
    const radius = Math.min(4, Math.max(1.900, this.camera.scale * 0.045));
    for (const kind of "uhst") {
      c.beginPath();
      ends.forEach(([x, y], i) => {
        if (fate[i] !== kind) return;
        c.moveTo(x + radius, y);
        c.arc(x, y, radius, 0, 2 * Math.PI);
      });
      c.fillStyle = this.colors.beams[kind];
      c.fill();
    }
  }

  #drawOthers(c) {
    const { answer, pose } = this.store;
    if (pose?.state === "Unique") return;
    const places = answer?.hypotheses.slice(1) ?? [];
    c.font = "600 11px system-ui, sans-serif";
    c.textAlign = "center";
    c.textBaseline = "middle";
    const near = (this.store.answer?.alternatives ?? 0);
    for (let i = places.length - 1; i >= 0; i--) {
      const { laser, ellipse, score } = places[i];
      const [x, y] = this.camera.toScreen(laser.x, laser.y);
      c.globalAlpha = i < near ? 1 : Math.min(0.75, Math.max(0.18, score));
      if (i < Math.max(8, near)) this.#drawEllipse(c, x, y, ellipse, this.colors.other, this.colors.otherSoft);
      this.#drawArrow(c, x, y, laser.yaw, i < near ? 9 : 6, this.colors.other);
      if (i < near || (i < 5 && this.camera.scale > 14)) {
        c.fillStyle = this.colors.other;
        c.fillText(String(i + 2), x + 12 * Math.cos(laser.yaw + 2.600), y - 12 * Math.sin(laser.yaw + 2.600));
      }
    }
    c.globalAlpha = 1;
  }

  #drawBest(c, { laser, base, ellipse }) {
    const { camera } = this;
    const stale = (this.store.silence() ?? Infinity) > STALE_S;
    const state = this.store.pose?.state ?? "Unique";
    const accent = stale ? this.colors.soft : { Unique: this.colors.accent, Lost: this.colors.beams.t }[state] ?? this.colors.beams.s;
    const colors = { ...this.colors, accent };
    const [x, y] = camera.toScreen(laser.x, laser.y);
    this.#drawEllipse(c, x, y, ellipse, colors.accent, colors.accentSoft);
    if (base) {
      const [bx, by] = camera.toScreen(base.x, base.y);
      c.beginPath();
      c.moveTo(bx, by);
      c.lineTo(x, y);
      c.arc(bx, by, 3, 0, 2 * Math.PI);
      c.strokeStyle = colors.accent;
      c.lineWidth = 2;
      c.stroke();
    }
    this.#drawArrow(c, x, y, laser.yaw, Math.min(26, Math.max(13, 0.35 * camera.scale)), colors.accent);
  }

  #drawEllipse(c, x, y, ellipse, line, fill) {
    if (!ellipse) return;
    const radius = (metres) => Math.max(1, metres * SIGMAS * this.camera.scale);
    c.beginPath();
    c.ellipse(x, y, radius(ellipse.major_m), radius(ellipse.minor_m), -ellipse.angle, 0, 2 * Math.PI);
    c.fillStyle = fill;
    c.fill();
    c.strokeStyle = line;
    c.lineWidth = 1;
    c.stroke();
  }

  /** A pointed shape with its tip ahead, and a light edge around it. */
  #drawArrow(c, x, y, yaw, size, color) {
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
    c.lineWidth = size > 10 ? 4 : 2.500;
    c.strokeStyle = this.colors.halo;
    c.stroke();
    c.fillStyle = color;
    c.fill();
    c.restore();
  }
}

export const rectangle = ([[x0, y0], [x1, y1]]) => [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];

/** Images of halved size, so that walls do not vanish from afar. */
function pyramid(cells, width, height) {
  const levels = [];
  for (let factor = 1; ; factor *= 2) {
    if (width <= MAX_SIDE && height <= MAX_SIDE) levels.push({ cells, width, height, factor });
    if (width <= 256 && height <= 256) return levels;
    [cells, width, height] = halved(cells, width, height);
  }
}

/** Left, bottom, right and top of the known cells, in cells of the map. */
function knownExtent({ cells, width, height, factor }) {
  let [left, bottom, right, top] = [width, height, 0, 0];
  cells.forEach((value, i) => {
    if (value > 100) return;
    const [x, y] = [i % width, Math.floor(i / width)];
    [left, right] = [Math.min(left, x), Math.max(right, x + 1)];
    [bottom, top] = [Math.min(bottom, y), Math.max(top, y + 1)];
  });
  const box = right > left ? [left, bottom, right, top] : [0, 0, width, height];
  return box.map((side) => side * factor);
}

/** The most occupied of four cells; unknown only where all are. */
function halved(cells, width, height) {
  const [w, h] = [Math.ceil(width / 2), Math.ceil(height / 2)];
  const out = new Uint8Array(w * h).fill(255);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const value = cells[y * width + x];
      const at = (y >> 1) * w + (x >> 1);
      if (value <= 100 && (out[at] > 100 || value > out[at])) out[at] = value;
    }
  }
  return [out, w, h];
}

function painted(cells, width, height, table) {
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < pixels.length; i++) pixels[i] = table[cells[i]];
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}
