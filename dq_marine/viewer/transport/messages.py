"""The messages of meshcat's protocol: small dictionaries, packed with MessagePack.

Protocol: https://github.com/meshcat-dev/meshcat, section "API".
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

from dq_marine.viewer.libraries import drawing_library
from dq_marine.viewer.placement import Placement
from dq_marine.viewer.transport.three_json import Json


@dataclass(frozen=True)
class Message:
    """One message to the page.

    Attributes:
        kind: what to do, such as `set_transform`.
        path: the thing it is about, such as `/world/vehicle`.
        content: the rest, as the protocol asks for this kind.
    """

    kind: str
    path: str = ""
    content: Json = field(default_factory=dict)

    def packed(self) -> bytes:
        """The message as the page reads it."""
        whole = {"type": self.kind, "path": self.path, **self.content}
        packed: bytes = drawing_library("umsgpack").packb(whole)
        return packed


CAPTURE_IMAGE = Message("capture_image")
"""Ask for a picture of everything drawn so far."""

TAKE_WORDS = Message("take_words")
"""Ask for what was said by the panels of pages since it was asked last."""


def show_panel(topic: str, content: Json) -> Message:
    """Have the panels of pages show something about a topic, in place of what they showed about it."""
    return Message("show_panel", topic, content)


def set_object(path: str, three_object: Json) -> Message:
    """Draw a three.js object at `path`, in place of the one that was there."""
    return Message("set_object", path, {"object": three_object})


def set_transform(path: str, placement: Placement) -> Message:
    """Move everything under `path`."""
    return Message("set_transform", path, {"matrix": placement.matrix_by_columns()})


def delete(path: str) -> Message:
    """Take away everything under `path`."""
    return Message("delete", path)


def set_property(path: str, name: str, value: Any) -> Message:
    """Set a property of the three.js object at `path`."""
    return Message("set_property", path, {"property": name, "value": value})


def set_animation(clips: Sequence[Json], *, play: bool) -> Message:
    """Animate things, over and over; a clip is `{"path": ..., "clip": ...}` for each thing."""
    options = {"play": play, "repetitions": float("inf")}
    return Message("set_animation", "", {"animations": list(clips), "options": options})
