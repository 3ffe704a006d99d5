// Before the first paint, so that a reload never flashes the other theme.
try {
  const saved = localStorage.getItem("stairwright.theme");
  const light = matchMedia("(prefers-color-scheme: light)").matches;
  document.documentElement.dataset.theme = saved || (light ? "light" : "dark");
} catch {
  document.documentElement.dataset.theme = "dark";
}
