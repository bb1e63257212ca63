// Draws the map and what was found in it.

import { Camera } from "./camera.js";
import { cellColors, fieldColors, palette } from "./colors.js";
import { knownExtent, painted, pyramid } from "./map_images.js";
import { drawArrow, drawCross, drawEllipse, drawFlag, drawGrid, drawRing } from "./marks.js";
import { candidates, contenders, inFrame, situation } from "./situation.js";

const NEAR_M = 34; // what a view that begins shows at least
const BEAMS_MS = 500; // so long the beams of a scan are shown beside the tracker's pose
const LEASH = 0.3; // how far off the middle a followed robot may go, of the view
const NARROW_PX = 480; // buttons cover the sides of such a view
const AROUND_M = 4; // what is shown around places that are compared
const REACH = { place: 22, beam: 14 }; // pixels, from a click to what is meant

export class MapView {
  camera = new Camera();
  layers = { beams: true, hypotheses: true, track: true, field: false, grid: true };
  follow = true;
  frame = "base_link"; // whose pose is shown
  inspected = null; // x and y in the map
  flags = []; // where something was: x, y and text
  cross = false; // whether the middle is marked
  selection = null; // where a drag that chooses something begins and ends
  choosing = ""; // what it chooses: a region, or the pose of a hint
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
    this.#nearScale = 0;
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
    const { known } = situation(store);
    const best = known ? inFrame(store.best(), this.frame) : null;
    if (this.follow) this.#followRobot(best);
    const c = this.canvas.getContext("2d");
    c.setTransform(1, 0, 0, 1, 0, 0);
    c.fillStyle = colors.ground;
    c.fillRect(0, 0, this.canvas.width, this.canvas.height);
    if (store.map) this.#drawCells(c);
    c.setTransform(this.ratio ?? 1, 0, 0, this.ratio ?? 1, 0, 0);
    if (layers.grid) drawGrid(c, camera, camera.step(), colors);
    this.#drawRegion(c);
    if (layers.track) this.#drawTrack(c);
    if (layers.beams && known) this.#drawScan(c);
    if (this.beamsShown()) this.#drawBeams(c, known ? 1 : 0.5);
    if (layers.hypotheses) this.#drawOthers(c, known);
    if (best) this.#drawBest(c, best);
    for (const { x, y, text } of this.flags) drawFlag(c, camera.toScreen(x, y), text, colors);
    if (this.inspected) drawRing(c, camera.toScreen(...this.inspected), 14, colors.ink, colors.halo);
    if (this.cross) drawCross(c, camera, colors);
    this.ondrawn?.();
  }

  /** While the tracker is sure, few scans are searched: beams of an old one lie elsewhere. */
  beamsShown() {
    const { store, layers } = this;
    const fresh = !store.pose || performance.now() - store.beamsAt < BEAMS_MS;
    return layers.beams && store.beams && store.best() && fresh;
  }

  /** Keeps the robot in view or, where that is not known, all places where it may be. */
  #followRobot(best) {
    if (best) {
      if (this.#nearScale) this.camera.scale = this.#nearScale;
      this.#nearScale = 0;
      return this.#keepInView(best);
    }
    const places = contenders(this.store).map((place) => inFrame(place, this.frame));
    if (!places.length || !this.#extent || this.camera.width <= 1) return;
    if (places.every(({ x, y }) => this.camera.sees(x, y)) && this.#nearScale) return;
    this.#nearScale ||= this.camera.scale;
    this.fitPoints(places);
  }
  #nearScale = 0; // from before all places were shown

  /** All of some points, and what is around them. */
  fitPoints(points) {
    const [xs, ys] = [points.map(({ x }) => x), points.map(({ y }) => y)];
    this.camera.fit({
      left: Math.min(...xs) - AROUND_M, right: Math.max(...xs) + AROUND_M,
      bottom: Math.min(...ys) - AROUND_M, top: Math.max(...ys) + AROUND_M,
    });
  }

  /** What is drawn there: the number of a place or of a beam, or nothing. */
  pick(px, py) {
    const { camera, store, layers } = this;
    const distance = (x, y) => {
      const [sx, sy] = camera.toScreen(x, y);
      return Math.hypot(sx - px, sy - py);
    };
    const nearest = (points, reach) => {
      const near = points.map((point, i) => ({ i, off: point ? distance(point.x, point.y) : Infinity }));
      return near.filter(({ off }) => off <= reach).sort((a, b) => a.off - b.off)[0]?.i;
    };
    const { known } = situation(store);
    if (known && store.pose) {
      const pose = inFrame(store.best(), this.frame);
      if (nearest([pose], REACH.place) === 0) return { kind: "pose" };
    }
    const unique = store.pose?.state === "Unique";
    const place = layers.hypotheses && !unique
      ? nearest(candidates(store).map((place) => inFrame(place, this.frame)), REACH.place) : undefined;
    if (place !== undefined) return { kind: "place", i: place };
    const beam = this.beamsShown() ? nearest(beamEnds(store.beams), REACH.beam) : undefined;
    return beam === undefined ? null : { kind: "beam", i: beam };
  }

  /** The view stays where it is as long as the robot is well within. */
  #keepInView({ x, y }) {
    const { camera } = this;
    const leash = camera.width < NARROW_PX ? LEASH / 2 : LEASH;
    const [right, up] = [camera.width, camera.height].map((side) => (leash * side) / camera.scale);
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
    if (this.choosing === "hint" && this.selection) return this.#drawHint(c, ...this.selection);
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

  /** The robot as it is pointed at: where the drag began, looking to where it is. */
  #drawHint(c, from, to) {
    const [at, end] = [from, to].map(([x, y]) => this.camera.toScreen(x, y));
    c.beginPath();
    c.moveTo(...at);
    c.lineTo(...end);
    c.lineWidth = 2;
    c.strokeStyle = this.colors.region;
    c.stroke();
    drawArrow(c, at, headingOf([from, to]), 18, this.colors.region, this.colors.halo);
  }

  /** The newest scan of each laser, at the pose of the newest scan. */
  #drawScan(c) {
    const { scans, scanPose } = this.store;
    c.fillStyle = this.colors.accent;
    for (const { mount, x, y } of scans.values()) {
      const { base, laser } = scanPose ?? {};
      const from = base && mount ? composed(base, mount) : laser;
      if (!from) continue;
      const [cos, sin] = [Math.cos(from.yaw), Math.sin(from.yaw)];
      x.forEach((ahead, i) => {
        const [px, py] = this.camera.toScreen(from.x + ahead * cos - y[i] * sin, from.y + ahead * sin + y[i] * cos);
        c.fillRect(px - 1, py - 1, 2, 2);
      });
    }
  }

  /** Older parts are fainter; a leap is no way. */
  #drawTrack(c) {
    const { track } = this.store;
    const at = this.#onRobot();
    c.lineWidth = 2;
    c.lineJoin = c.lineCap = "round";
    const part = Math.max(1, Math.ceil(track.length / 12));
    for (let from = 0; from < track.length; from += part) {
      c.beginPath();
      for (let i = Math.max(1, from); i < Math.min(track.length, from + part + 1); i++) {
        if (track[i - 1][2] !== "U" || track[i][2] !== "U") continue;
        const [[x0, y0], [x1, y1]] = [at(track[i - 1]), at(track[i])];
        if (Math.hypot(x1 - x0, y1 - y0) > 2) continue;
        c.moveTo(...this.camera.toScreen(x0, y0));
        c.lineTo(...this.camera.toScreen(x1, y1));
      }
      c.strokeStyle = `rgba(${this.colors.track},${0.15 + 0.6 * (from / track.length)})`;
      c.stroke();
    }
  }

  /** From a point of the laser's path to that of the frame that is shown. */
  #onRobot() {
    const best = this.store.best();
    if (this.frame === "laser" || !best?.base) return ([x, y]) => [x, y];
    const { laser, base } = best;
    const [dx, dy] = [base.x - laser.x, base.y - laser.y];
    const [cos, sin] = [Math.cos(laser.yaw), Math.sin(laser.yaw)];
    const [ahead, left] = [dx * cos + dy * sin, dy * cos - dx * sin];
    return ([x, y, , yaw]) => [x + ahead * Math.cos(yaw) - left * Math.sin(yaw), y + ahead * Math.sin(yaw) + left * Math.cos(yaw)];
  }

  #drawBeams(c, alpha) {
    const { laser, fate } = this.store.beams;
    const from = this.camera.toScreen(laser.x, laser.y);
    const ends = beamEnds(this.store.beams).map(({ x, y }) => this.camera.toScreen(x, y));
    c.globalAlpha = alpha;
    c.beginPath();
    for (const end of ends) {
      c.moveTo(...from);
      c.lineTo(...end);
    }
    c.strokeStyle = this.colors.ray;
    c.lineWidth = 1;
    c.stroke();
    const radius = Math.min(4, Math.max(1.9, this.camera.scale * 0.045));
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
    c.globalAlpha = 1;
  }

  /** The places beside the pose; where that is not known all of them, large as it would be. */
  #drawOthers(c, known) {
    const { store, camera, colors } = this;
    if (store.pose?.state === "Unique") return;
    const equal = known ? store.answer?.alternatives ?? 0 : contenders(store).length;
    const first = known && !store.pose ? 1 : 0;
    const places = candidates(store);
    c.font = "600 12px system-ui, sans-serif";
    c.textAlign = "center";
    c.textBaseline = "middle";
    for (let i = places.length - 1; i >= first; i--) {
      const { x, y, yaw, ellipse } = inFrame(places[i], this.frame);
      const at = camera.toScreen(x, y);
      const leads = i < equal + first;
      c.globalAlpha = leads ? 1 : Math.min(0.75, Math.max(0.18, places[i].score));
      if (leads || i < 8) drawEllipse(c, at, ellipse, camera.scale, colors.other, colors.otherSoft);
      drawArrow(c, at, yaw, leads ? (known ? 9 : 13) : 6, colors.other, colors.halo);
      if (leads || (i < 5 && camera.scale > 14)) {
        const beside = [at[0] + 18 * Math.cos(yaw + 2.6), at[1] - 18 * Math.sin(yaw + 2.6)];
        c.lineWidth = 3;
        c.strokeStyle = colors.halo;
        c.strokeText(String(i + 1), ...beside);
        c.fillStyle = colors.other;
        c.fillText(String(i + 1), ...beside);
      }
    }
    c.globalAlpha = 1;
  }

  /** The pose, and a line to the other frame. */
  #drawBest(c, best) {
    const { camera, colors, store } = this;
    const color = store.pose?.state === "Doubtful" ? colors.beams.s : colors.accent;
    const at = camera.toScreen(best.x, best.y);
    drawEllipse(c, at, best.ellipse, camera.scale, color, colors.accentSoft);
    const { laser, base } = store.best();
    const other = best.frame === "laser" ? base : laser;
    if (other) {
      const [x, y] = camera.toScreen(other.x, other.y);
      c.beginPath();
      c.moveTo(...at);
      c.lineTo(x, y);
      c.arc(x, y, 3, 0, 2 * Math.PI);
      c.strokeStyle = color;
      c.lineWidth = 2;
      c.stroke();
    }
    drawArrow(c, at, best.yaw, Math.min(26, Math.max(13, 0.35 * camera.scale)), color, colors.halo);
  }
}

/** A pose that is given in the frame of another one. */
const composed = ({ x, y, yaw }, inner) => ({
  x: x + inner.x * Math.cos(yaw) - inner.y * Math.sin(yaw),
  y: y + inner.x * Math.sin(yaw) + inner.y * Math.cos(yaw),
  yaw: yaw + inner.yaw });

/** The heading from where a drag begins to where it ends. */
export const headingOf = ([[x0, y0], [x1, y1]]) => Math.atan2(y1 - y0, x1 - x0);

const rectangle = ([[x0, y0], [x1, y1]]) => [[x0, y0], [x1, y0], [x1, y1], [x0, y1]];

/** Where the beams of a scan end. */
export const beamEnds = ({ laser, bearing, range_m }) => bearing.map((angle, i) => ({
  x: laser.x + range_m[i] * Math.cos(laser.yaw + angle), y: laser.y + range_m[i] * Math.sin(laser.yaw + angle) }));
