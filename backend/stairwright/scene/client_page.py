"""viser's single-file client, adapted: served by us, embeddable, with the design's background.

The client takes its WebSocket's address from the page's own, so each session has its own path. The
file is viser's own build; only a head block is added, for the reasons given beside each part.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import viser

from stairwright.errors import StairwrightError

# Dark and light backdrops of the design; the canvas itself is transparent. Embedded, viser's panel
# and notices are hidden: the page around it has its own. The scene's own window keeps them. What
# waits for its theme is see-through.
_STYLE = """
html, body { background: #0f1317; }
html[data-mantine-color-scheme="light"], html[data-mantine-color-scheme="light"] body
  { background: #f4f7f9; }
canvas[data-engine]
  { background: radial-gradient(120% 90% at 50% 20%, #1a2128 0%, #12171c 55%, #0d1114 100%); }
[data-mantine-color-scheme="light"] canvas[data-engine]
  { background: radial-gradient(120% 90% at 50% 15%, #ffffff 0%, #f4f7f9 55%, #e6ebef 100%); }
html[data-awaits] { background: transparent; }
html[data-awaits] body { opacity: 0; background: transparent; }
html[data-embedded] [data-floating-window], html[data-embedded] [data-dock-group],
/* in frames narrower than a phone the panel is a sheet of another kind */
html[data-embedded] .mantine-Paper-root,
html[data-embedded] .mantine-Notifications-root { display: none !important; }
"""

# 1. `?embedded=1` marks the document. 2. `?websocket=` and `?playbackPath=` would make the client
# trust another server, so they are removed, also where the client writes its own address back.
# 3. A frame that never had the focus would never reconnect: being visible counts as focus.
# 4. The client is drawn light until the server has told it the theme: dark pages would flash white.
# With `?theme=` it is shown once it has that theme, or in any after some seconds on the screen: a
# frame that is not displayed draws nothing yet.
_SCRIPT = """
(function () {
  var q = new URLSearchParams(location.search);
  if (q.get("embedded") === "1") document.documentElement.dataset.embedded = "";
  function clean(url) {
    var u = new URL(url === undefined || url === null ? location.href : url, location.href);
    u.searchParams.delete("websocket");
    u.searchParams.delete("playbackPath");
    return u.pathname + u.search + u.hash;
  }
  var replace = history.replaceState.bind(history);
  history.replaceState = function (state, title, url) { replace(state, title, clean(url)); };
  history.replaceState(null, "", location.href);
  document.hasFocus = function () { return !document.hidden; };
  document.addEventListener("visibilitychange", function () {
    window.dispatchEvent(new Event(document.hidden ? "blur" : "focus"));
  });
  var root = document.documentElement, theme = q.get("theme");
  if (theme !== "dark" && theme !== "light") return;
  root.dataset.awaits = "";
  function show() { watch.disconnect(); delete root.dataset.awaits; }
  var watch = new MutationObserver(function () {
    if (root.dataset.mantineColorScheme === theme && document.querySelector("canvas[data-engine]"))
      show();
  });
  watch.observe(root, { attributes: true, childList: true, subtree: true });
  var displayed = new ResizeObserver(function () {
    if (!innerWidth) return;
    displayed.disconnect();
    setTimeout(show, 5000);
  });
  displayed.observe(root);
})();
"""

# The client may only talk to the server that it came from.
_POLICY = (
    "default-src 'self' data: blob:; connect-src 'self' data: blob:; "
    "script-src 'self' 'unsafe-inline' 'unsafe-eval' 'wasm-unsafe-eval' blob:; "
    "style-src 'self' 'unsafe-inline'; object-src 'none'; base-uri 'none'; form-action 'none'"
)


@cache
def _build() -> str:
    path = Path(viser.__file__).parent / "client" / "build" / "index.html"
    text = path.read_text(encoding="utf-8")
    if "<head>" not in text:
        raise StairwrightError(f"viser {viser.__version__} ships a client without a <head>")
    return text


def client_html(title: str) -> str:
    """The whole client as one HTML document, to be served under a path of its own."""
    head = (
        f'<head><meta http-equiv="Content-Security-Policy" content="{_POLICY}">'
        f"<style>{_STYLE}</style><script>{_SCRIPT}</script>"
    )
    return (
        _build()
        .replace("<head>", head, 1)
        .replace("<title>Viser</title>", f"<title>{title}</title>", 1)
    )
