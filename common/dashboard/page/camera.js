// Where one looks: from metres in the map to pixels on the screen, y upward.

const MIN_SCALE = 0.5; // pixels a metre
const MAX_SCALE = 2000;
const STEPS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000];
const LEAST_STEP = 60; // pixels

export class Camera {
  x = 0;
  y = 0;
  scale = 40;
  width = 1;
  height = 1;

  toScreen(x, y) {
    return [(x - this.x) * this.scale + this.width / 2, this.height / 2 - (y - this.y) * this.scale];
  }

  toMap(px, py) {
    return [(px - this.width / 2) / this.scale + this.x, (this.height / 2 - py) / this.scale + this.y];
  }

  pan(dx, dy) {
    this.x -= dx / this.scale;
    this.y += dy / this.scale;
  }

  zoom(factor, px = this.width / 2, py = this.height / 2) {
    const [x, y] = this.toMap(px, py);
    this.scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, this.scale * factor));
    const [nx, ny] = this.toMap(px, py);
    this.x += x - nx;
    this.y += y - ny;
  }

  /** Whether a point is in view, and not at its edge. */
  sees(x, y) {
    const [px, py] = this.toScreen(x, y);
    const [dx, dy] = [0.04 * this.width, 0.04 * this.height];
    return px > dx && px < this.width - dx && py > dy && py < this.height - dy;
  }

  /** A round number of metres that is not small on the screen. */
  step() {
    return STEPS.find((metres) => metres * this.scale >= LEAST_STEP) ?? STEPS.at(-1);
  }

  /** Shows all of a box, with some air. */
  fit({ left, bottom, right, top }) {
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
    const scale = 0.92 * Math.min(this.width / (right - left), this.height / (top - bottom));
    this.scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, scale));
  }
}
