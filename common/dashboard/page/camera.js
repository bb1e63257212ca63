// Where one looks: from metres in the map to pixels on the screen, y upward.

const MIN_SCALE = 0.5; // pixels a metre
const MAX_SCALE = 2000;

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

  /** Shows all of a box, with some air. */
  fit({ left, bottom, right, top }) {
    this.x = (left + right) / 2;
    this.y = (bottom + top) / 2;
    const scale = 0.92 * Math.min(this.width / (right - left), this.height / (top - bottom));
    this.scale = Math.min(MAX_SCALE, Math.max(MIN_SCALE, scale));
  }
}
