// The cells of a map as images, coarser ones for views from afar.

const MAX_SIDE = 8192; // pixels of an image along a side

/** Cells of halved size, so that walls do not vanish from afar. */
export function pyramid(cells, width, height) {
  const levels = [];
  for (let factor = 1; ; factor *= 2) {
    if (width <= MAX_SIDE && height <= MAX_SIDE) levels.push({ cells, width, height, factor });
    if (width <= 256 && height <= 256) return levels;
    [cells, width, height] = halved(cells, width, height);
  }
}

/** Left, bottom, right and top of the known cells, in cells of the map. */
export function knownExtent({ cells, width, height, factor }) {
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

/** An image with a colour for each value. */
export function painted(cells, width, height, table) {
  const image = new ImageData(width, height);
  const pixels = new Uint32Array(image.data.buffer);
  for (let i = 0; i < pixels.length; i++) pixels[i] = table[cells[i]];
  const canvas = document.createElement("canvas");
  [canvas.width, canvas.height] = [width, height];
  canvas.getContext("2d").putImageData(image, 0, 0);
  return canvas;
}
