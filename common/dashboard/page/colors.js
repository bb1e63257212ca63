// The colours of the map. The page around it has its own, in style.css.

const LIGHT = {
  unknown: [228, 233, 232], free: [252, 253, 253], wall: [38, 48, 47],
  ground: "#e4e9e8", accent: "#0d7a72", accentSoft: "rgba(13,122,114,.15)", halo: "#ffffff",
  track: "13,122,114", other: "#6b4fb0", otherSoft: "rgba(107,79,176,.14)", region: "#0d7a72",
  ink: "#18211f", soft: "#53605d", grid: "rgba(60,80,76,.10)",
  beams: { h: "#0f9488", s: "#d08a00", t: "#cf3a64", u: "#8796a5" },
  ray: "rgba(15,148,136,.10)", field: [[255, 236, 170], [240, 130, 60], [160, 20, 70]],
};
const DARK = {
  unknown: [13, 19, 20], free: [31, 41, 43], wall: [186, 202, 199],
  ground: "#0d1314", accent: "#48d6c5", accentSoft: "rgba(72,214,197,.20)", halo: "#0d1314",
  track: "72,214,197", other: "#b39bff", otherSoft: "rgba(179,155,255,.16)", region: "#48d6c5",
  ink: "#e3ebe9", soft: "#a5b3b0", grid: "rgba(200,225,220,.08)",
  beams: { h: "#3fd2c0", s: "#f0b647", t: "#ff7193", u: "#7f93a3" },
  ray: "rgba(72,214,197,.09)", field: [[70, 30, 100], [220, 80, 70], [255, 220, 130]],
};

export const FATES = { h: "on the map", s: "not on the map", t: "through a wall", u: "unknown" };

/** The colours of a theme, `light` or `dark`. */
export const palette = (theme) => (theme === "dark" ? DARK : LIGHT);

const mix = (a, b, t) => a.map((from, i) => Math.round(from + (b[i] - from) * t));
const packed = ([r, g, b], a = 255) => ((a << 24) | (b << 16) | (g << 8) | r) >>> 0;

/** A colour for each value of a cell, as one number a pixel. */
export function cellColors(colors) {
  const table = new Uint32Array(256).fill(packed(colors.unknown));
  for (let percent = 0; percent <= 100; percent++) {
    table[percent] = packed(mix(colors.free, colors.wall, percent / 100));
  }
  return table;
}

/** A colour for each intensity from `low` on, below which nothing is shown. */
export function fieldColors(colors, low) {
  const [first, middle, last] = colors.field;
  const table = new Uint32Array(256);
  for (let value = 0; value < 256; value++) {
    const t = Math.max(0, (value - low) / Math.max(1, 255 - low));
    const color = t < 0.5 ? mix(first, middle, t * 2) : mix(middle, last, t * 2 - 1);
    table[value] = packed(color, Math.round(185 * Math.min(1, t * 1.800)));
  }
  return table;
}
