"""Several replays in one HTML file, beside one another, which play and pause together."""

from __future__ import annotations

import html
import math
import os
from collections.abc import Mapping
from pathlib import Path
from string import Template

from dq_marine.errors import InvalidInputError
from dq_marine.util.files import check_folder, write_whole
from dq_marine.viewer.replay import Replay

PAGE = Template("""<!DOCTYPE html>
<html lang="en">
<head><meta charset="utf-8"><meta name="viewport" content="width=device-width, initial-scale=1">
<title>$title</title>
<style>
  html, body { margin: 0; height: 100%; background: #05263a; color: #f2fbff; font: 15px/1.4 system-ui, sans-serif; }
  body { display: flex; flex-direction: column; }
  header { display: flex; flex-wrap: wrap; gap: 12px; align-items: center; padding: 10px 16px; }
  h1 { font-size: 18px; margin: 0; flex: 1 1 auto; }
  h2 { font-size: 15px; font-weight: 600; margin: 0; padding: 6px 4px; }
  button { font: inherit; color: inherit; background: #0f5f86; border: 0; border-radius: 6px; padding: 6px 12px;
    cursor: pointer; }
  main { flex: 1; display: grid; gap: 6px; min-height: 0;
    grid-template-columns: repeat(auto-fit, minmax(max(min(340px, 100%), $share%), 1fr)); }
  section { display: flex; flex-direction: column; min-height: 42vh; }
  @media (max-width: 700px) { section { min-height: 60vh; } }
  iframe { flex: 1; border: 0; width: 100%; }
</style></head>
<body>
<header>
  <h1>$title</h1>
  <button id="play">Play all</button><button id="pause">Pause all</button><button id="restart">From the start</button>
</header>
<main>
$panels
</main>
<script>
  const each = (act) => () => {
    for (const frame of document.querySelectorAll("iframe")) {
      const animator = frame.contentWindow.animator;
      if (animator && animator.duration > 0) { act(animator); }
    }
  };
  document.getElementById("play").onclick = each((animator) => animator.play());
  document.getElementById("pause").onclick = each((animator) => animator.pause());
  document.getElementById("restart").onclick = each((animator) => {
    animator.pause(); animator.seek(0); animator.display_progress(0); animator.play();
  });
</script>
</body>
</html>
""")

MOST_BESIDE = 3
"""Replays in a row: in narrower ones a vehicle is cut off. Where there are more, rows are of about one length."""

PANEL = Template('<section><h2>$name</h2><iframe title="$name" srcdoc="$page"></iframe></section>')


def save_side_by_side(
    path: str | os.PathLike[str],
    replays: Mapping[str, Replay | str | os.PathLike[str]],
    *,
    title: str = "dq-marine",
) -> None:
    """Write one page of several replays: open it in any browser, with no other file and no network.

    The file appears complete or not at all; an older one of the same name is replaced.

    Args:
        path: of the HTML file; its folder must exist.
        replays: replays, or files that `save_replay` has written, by what stands above each.
        title: plain text, above all of them.

    Raises:
        InvalidInputError: no replays, one that cannot be read, or a path that cannot be written.
    """
    target = Path(path)
    if target.is_dir():
        raise InvalidInputError(f"{target} is a folder; give the path of a file in it")
    check_folder(target)
    if not replays:
        raise InvalidInputError("replays is empty; give at least one file that save_replay has written")
    panels = [
        PANEL.substitute(name=html.escape(name), page=html.escape(_page_of(name, replay)))
        for name, replay in replays.items()
    ]
    columns = math.ceil(len(panels) / math.ceil(len(panels) / MOST_BESIDE))
    share = (
        f"{100.0 / (columns + 0.5):.1f}"  # of the width that a replay needs at least: one more does not fit
    )
    write_whole(target, PAGE.substitute(title=html.escape(title), share=share, panels="\n".join(panels)))


def _page_of(name: str, replay: Replay | str | os.PathLike[str]) -> str:
    if isinstance(replay, Replay):
        return replay.page
    try:
        return Path(replay).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise InvalidInputError(
            f"the replay {name!r}, {replay}, cannot be read: {error}; give a file that save_replay has written"
        ) from error
