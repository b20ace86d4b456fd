"""What pages say by their panels, and what their panels show: a websocket beside meshcat's, in the viewer's server.

It is under the same path that cannot be guessed, and tornado refuses a page of another origin. What comes through it is
small: a name and a value, of which the process that draws takes what it knows (`dq_marine.viewer.controls`).
"""

from __future__ import annotations

import json
import math
from collections import deque
from typing import Any

from dq_marine.viewer.transport.page_connection import PageConnection

POLICY_VIOLATION = 1008
"""Status of a websocket that is closed because of what came through it (RFC 6455, section 7.4.1)."""

LARGEST_WORD = 4096
"""Bytes in what a page says at a time."""

MOST_KEPT = 256
"""Words of pages that nobody has asked for yet; older ones are forgotten."""

MOST_NUMBERS = 16
"""In a word whose value is a list."""

LEFT = {"name": "left", "value": None}
"""What is noted when a page has gone: whatever it held down is let go."""


class PanelHub:
    """The panels of all connected pages: what they show, and what was said by them."""

    def __init__(self) -> None:
        self._sockets: set[PanelSocket] = set()
        self._shown: dict[str, str] = {}
        self._words: deque[dict[str, Any]] = deque(maxlen=MOST_KEPT)

    def show(self, topic: str, content: dict[str, Any]) -> None:
        """Have all panels show something about a topic, and those that connect later."""
        text = json.dumps(content)
        self._shown[topic] = text
        for socket in self._sockets:
            socket.write_message(text)

    def take_words(self) -> bytes:
        """Return what was said since the last call, oldest first, as a JSON list."""
        words = json.dumps(list(self._words)).encode()
        self._words.clear()
        return words

    def connect(self, socket: PanelSocket) -> None:
        """Tell a new page what there is to show."""
        self._sockets.add(socket)
        for text in self._shown.values():
            socket.write_message(text)

    def disconnect(self, socket: PanelSocket) -> None:
        """Forget a page."""
        self._sockets.discard(socket)
        self._words.append(LEFT)

    def hear(self, word: dict[str, Any]) -> None:
        """Keep what a page said until it is asked for."""
        self._words.append(word)


class PanelSocket(PageConnection):
    """The websocket of one page's panel."""

    def initialize(self, hub: PanelHub) -> None:
        """Called by tornado for each page."""
        self._hub = hub

    def open(self, *_: str, **__: str) -> None:
        """Join the hub."""
        super().open()
        self._hub.connect(self)

    def on_message(self, message: str | bytes) -> None:
        """Keep a word; close on anything else."""
        word = word_in(message)
        if word is None:
            self.close(POLICY_VIOLATION, "not a word of a panel")
        else:
            self._hub.hear(word)

    def on_close(self) -> None:
        """Leave the hub."""
        self._hub.disconnect(self)


def word_in(message: str | bytes) -> dict[str, Any] | None:
    """Return what a page said, a name and a plain value; None if it is anything else."""
    if len(message) > LARGEST_WORD:
        return None
    try:
        word = json.loads(message)
    except (ValueError, RecursionError):
        return None
    if not isinstance(word, dict) or set(word) != {"name", "value"} or not isinstance(word["name"], str):
        return None
    value = word["value"]
    plain = all(map(_is_number, value)) if isinstance(value, list) else _is_plain(value)
    return word if plain and not (isinstance(value, list) and len(value) > MOST_NUMBERS) else None


def _is_plain(value: Any) -> bool:
    return value is None or isinstance(value, str | bool) or _is_number(value)


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
