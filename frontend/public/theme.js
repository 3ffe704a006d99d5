// Before the first paint, so that a reload never flashes the other theme.
let saved = null;
try {
  saved = localStorage.getItem("stairwright.theme");
} catch {
  // Private windows may refuse: the system's theme then.
}
const light = matchMedia("(prefers-color-scheme: light)").matches;
const chosen = saved === "light" || saved === "dark";
document.documentElement.dataset.theme = chosen ? saved : light ? "light" : "dark";
