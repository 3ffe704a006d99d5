// The design's tokens, dark and light.

const rgb = (text) => [1, 3, 5].map((i) => parseInt(text.slice(i, i + 2), 16) / 255);
const THEMES = {
  dark: {
    front: rgb("#5fb0f5"), rear: rgb("#f2a541"), trunk: rgb("#dfe4ea"), trim: rgb("#4a545f"),
    tyre: rgb("#3a4149"), treads: rgb("#8290a0"), risers: rgb("#697684"), flanks: rgb("#454f5a"),
    edge: rgb("#b4c0cd"), grid: rgb("#2b343d"), force: rgb("#cfc65c"), path: rgb("#c4ccd5"),
    actual: "#e9edf2", band: 0.34, tick: "#7f8b98", line: "#262d35", hex: ["#5fb0f5", "#f2a541"],
  },
  light: {
    front: rgb("#0f6cbd"), rear: rgb("#b85f00"), trunk: rgb("#5b6673"), trim: rgb("#39424b"),
    tyre: rgb("#2c333a"), treads: rgb("#ccd4dc"), risers: rgb("#bcc6cf"), flanks: rgb("#adb8c2"),
    edge: rgb("#5d6b7a"), grid: rgb("#cbd4dc"), force: rgb("#857900"), path: rgb("#3d4752"),
    actual: "#121920", band: 0.3, tick: "#667381", line: "#d9dfe5", hex: ["#0f6cbd", "#b85f00"],
  },
};
let theme = matchMedia("(prefers-color-scheme: light)").matches ? "light" : "dark";
