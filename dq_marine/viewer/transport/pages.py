"""The viewer's web pages: a live one, one that only has its picture taken, and the replay's.

Each is meshcat's page in the viewer's own dress. The caption takes its numbers from the scene itself,
so that it is right in every page, also while an animation runs or is scrubbed.
"""

from __future__ import annotations

from importlib import resources
from string import Template


def _file(name: str) -> str:
    """A file of the folder `page`, which the pages consist of."""
    return resources.files(__package__).joinpath("page", name).read_text(encoding="utf-8")


STYLE = """
  html, body { margin: 0; height: 100%; background: #05263a; overflow: hidden; }
  #meshcat-pane { width: 100vw; height: 100vh; overflow: hidden; }
  .dg.main { display: none !important; }  /* meshcat's own list of everything in the scene */
  #caption {
    position: absolute; left: 20px; top: 16px; color: #f2fbff; pointer-events: none;
    font: 15px/1.4 system-ui, sans-serif; text-shadow: 0 1px 3px #00131e;
  }
  #title { font-weight: 600; font-size: 17px; }
  #clock { font-weight: 600; font-size: 30px; font-variant-numeric: tabular-nums; }
  #notice { font-weight: 600; color: #ffd166; }
  #controls {
    position: absolute; left: 20px; right: 20px; bottom: 18px; display: flex; gap: 12px;
    align-items: center; padding: 8px 12px; border-radius: 10px; background: #00192acc;
  }
  #controls button, #controls select {
    font: 15px system-ui, sans-serif; color: #f2fbff; background: #0f5f86; border: 0;
    border-radius: 6px; padding: 6px 10px; cursor: pointer;
  }
  #controls [aria-pressed="false"] { opacity: 0.5; }
  #controls[hidden], #controls [hidden] { display: none; }
  #play { width: 84px; }
  #slider { flex: 1; cursor: pointer; accent-color: #37c5d8; }
"""

CAPTION = """
<div id="caption">
  <div id="title">$title</div>
  <div id="clock"></div>
  <div id="details"></div>
  <div id="notice"></div>
</div>
"""

CAPTION_SCRIPT = """
  const node = (...path) => viewer.scene_tree.find(path).object;
  const element = (id) => document.getElementById(id);
  const show = (id, text) => { element(id).textContent = text; };

  function update_caption() {
    const depth = node("world", "vehicle").position.z;
    const {cell, afloat} = node("world", "floor", "sand", "<object>").userData;
    const hundredths = (metres) => (Math.round(100 * metres) / 100 + 0).toFixed(2);  // no "-0.00"
    const place = afloat ? "height " + hundredths(-depth) : "depth " + hundredths(depth);
    show("clock", node("world", "clock").position.x.toFixed(1) + " s");
    show("details", place + " m" + (cell ? " · grid " + cell + " m" : ""));
    requestAnimationFrame(update_caption);
  }
  update_caption();
"""

LIVE_SCRIPT = """
  const viewer = new MeshCat.Viewer(document.getElementById("meshcat-pane"));
  viewer.connect(new URL("socket", location.href).href.replace(/^http/, "ws"));
  viewer.connection.addEventListener("close", () => show("notice", "The simulation has ended."));
"""

CONTROLS = """
<div id="controls">
  <button id="play"></button>
  <input id="slider" type="range" min="0" step="any" value="0" aria-label="time">
  <select id="speed" aria-label="speed">
    <option value="0.5">0.5 x</option>
    <option value="1" selected>1 x</option>
    <option value="2">2 x</option>
    <option value="5">5 x</option>
    <option value="20">20 x</option>
  </select>
  <button id="beams" title="show or hide the beams of range sensors (B)" aria-pressed="true">Beams</button>
</div>
"""

REPLAY_SCRIPT = """
  const viewer = new MeshCat.Viewer(document.getElementById("meshcat-pane"));
  const bytes = (base64) => Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
  for (const message of messages) {
    viewer.handle_command_bytearray(bytes(message));
  }
"""

CONTROLS_SCRIPT = """
  const animator = window.animator = viewer.animator;  // a page around this one may play and pause it
  const toggle = () => animator.playing ? animator.pause() : animator.play();
  const seek = (time) => { animator.pause(); animator.seek(time); animator.display_progress(time); };
  const trail = node("world", "trail", "<object>").geometry;

  element("play").onclick = toggle;
  element("slider").max = animator.duration;
  element("slider").oninput = (event) => seek(Number(event.target.value));
  element("speed").onchange = (event) => { animator.mixer.timeScale = Number(event.target.value); };
  document.addEventListener("keydown", (event) => {
    if (event.code === "Space") { event.preventDefault(); toggle(); }
  });
  element("controls").hidden = animator.duration === 0;

  function update_controls() {
    show("play", animator.playing ? "Pause" : "Play");
    element("slider").value = animator.time;
    end_at_vehicle(trail, times);
    requestAnimationFrame(update_controls);
  }

  function end_at_vehicle(trail, times) {  // a trail has one point for each recorded time
    const now = node("world", "clock").position.x + 0.001;  // the clock has single precision, hence the millisecond
    const later = times.findIndex((time) => time > now);
    const reached = later < 0 ? times.length : later;
    if (trail.drawRange.count !== reached) {
      trail.setDrawRange(0, reached);
      viewer.set_dirty();
    }
  }
  update_controls();
"""


def _page(title: str, body: str, *scripts: str) -> str:
    """A whole page around meshcat's pane."""
    return f"""<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><title>{title}</title><style>{STYLE}</style></head>
<body>
<div id="meshcat-pane"></div>
{body}
{"".join(scripts)}
</body>
</html>
"""


def _inline(script: str) -> str:
    return f"<script>{script}</script>\n"


SERVED_MESHCAT = '<script src="main.min.js"></script>\n'

PANEL_STYLE = f"<style>{_file('panel.css')}</style>\n"
LEGEND = f"<style>{_file('legend.css')}</style>\n{_file('legend.html')}"

EDGES = _inline(_file("edges.js"))
"""Before a page's viewer is made."""

SEA = (
    _inline(_file("sea.js"))
    + _inline(_file("dive.js"))
    + _inline(_file("wake.js"))
    + _inline(_file("beams.js"))
)

LIVE_PAGE = _page(
    "dq-marine",
    CAPTION.replace("$title", "") + LEGEND + PANEL_STYLE + _file("panel.html"),
    SERVED_MESHCAT,
    EDGES,
    _inline(LIVE_SCRIPT + CAPTION_SCRIPT),
    SEA,
    _inline(_file("hidden.js")),
    _inline(_file("lines.js")),
    _inline(_file("legend.js")),
    _inline(_file("glide.js")),
    _inline(_file("panel.js")),
    _inline(_file("view.js")),
    _inline(_file("pointing.js")),
    _inline(_file("pull.js")),
    _inline(_file("drag.js")),
    _inline(_file("pace.js")),
)
CAPTURE_PAGE = _page(
    "dq-marine",
    "",
    SERVED_MESHCAT,
    EDGES,
    _inline(_file("capture.js")),
    SEA,
    _inline(_file("hidden.js")),
    _inline(_file("lines.js")),
)

REPLAY_DATA_SCRIPT = """
  const messages = $messages;
  const times = $times;
"""

OVERLAY_DATA_SCRIPT = """
  const overlay = $overlay;
"""


def _literal(text: str) -> str:
    """A template that stands for a text: its dollars are doubled."""
    return text.replace("$", "$$")


def _replay_page(body: str, *scripts: str, data: str = REPLAY_DATA_SCRIPT) -> Template:
    """The page of a replay, which needs nothing from outside: meshcat and all data go into it."""
    return Template(
        _page(
            "$title",
            CAPTION + CONTROLS + _literal(LEGEND + body),
            _inline("$meshcat"),
            _inline(data),
            EDGES,
            _inline(REPLAY_SCRIPT + CAPTION_SCRIPT + CONTROLS_SCRIPT),
            SEA,
            _inline(_file("switch_beams.js")),
            _inline(_file("pace.js")),
            _inline(_literal(_file("legend.js"))),
            *map(_literal, scripts),
        )
    )


REPLAY_PAGE = _replay_page("")
OVERLAY_PAGE = _replay_page(
    f"<style>{_file('overlay.css')}</style>\n{_file('overlay.html')}",
    _inline(_file("overlay.js")),
    data=REPLAY_DATA_SCRIPT + OVERLAY_DATA_SCRIPT,
)
"""A replay with several flights in one scene, and plots of them."""
