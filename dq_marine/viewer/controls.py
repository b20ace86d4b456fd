"""The controls of a live page's panel, as plain data, and what comes back when a person uses them.

A page is not trusted: `Panel.read` takes a word of a page only if it is about a control of the panel, and its value is
one that this control can have.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, ClassVar

from dq_marine.errors import InvalidInputError

LEFT = "left"
"""Name of the event that a page has gone."""


@dataclass(frozen=True)
class Event:
    """What a person did: the name of the control, and its value; None for a button."""

    name: str
    value: Any = None


@dataclass(frozen=True)
class Button:
    """Something to press.

    Attributes:
        name: of the event.
        label: on the button.
        key: that does the same, by its place on the keyboard (`KeyboardEvent.code`); "" for none.
    """

    kind: ClassVar[str] = "button"
    name: str
    label: str
    key: str = ""

    def read(self, value: Any) -> Any:
        """Return None, whatever came."""
        return None


@dataclass(frozen=True)
class Switch:
    """Something that is on or off; its event's value is a bool.

    Attributes:
        value: at first.
    """

    kind: ClassVar[str] = "switch"
    name: str
    label: str
    value: bool
    key: str = ""

    def read(self, value: Any) -> Any:
        """Return a bool; `ValueError` if it is none."""
        if not isinstance(value, bool):
            raise ValueError
        return value


@dataclass(frozen=True)
class Choice:
    """One of several texts.

    Attributes:
        options: the texts.
        value: at first.
    """

    kind: ClassVar[str] = "choice"
    name: str
    label: str
    options: tuple[str, ...]
    value: str

    def read(self, value: Any) -> Any:
        """Return one of the options; `ValueError` if it is none of them."""
        if value not in self.options:
            raise ValueError
        return value


@dataclass(frozen=True)
class Slider:
    """A number between two others.

    Attributes:
        least: the smallest.
        most: the largest.
        value: at first.
        step: between values that can be chosen.
        unit: "" for a pure number.
        logarithmic: whether equal ways of the slider are equal ratios.
    """

    kind: ClassVar[str] = "slider"
    name: str
    label: str
    least: float
    most: float
    value: float
    step: float
    unit: str = ""
    logarithmic: bool = False

    def read(self, value: Any) -> Any:
        """Return a number within the bounds; `ValueError` if it is no number."""
        return min(max(_number(value), self.least), self.most)


@dataclass(frozen=True)
class Number:
    """A whole number to type.

    Attributes:
        least: the smallest.
        most: the largest.
        value: at first.
    """

    kind: ClassVar[str] = "number"
    name: str
    label: str
    least: int
    most: int
    value: int

    def read(self, value: Any) -> Any:
        """Return a whole number within the bounds; `ValueError` if it is no number."""
        return min(max(round(_number(value)), self.least), self.most)


@dataclass(frozen=True)
class Axis:
    """One axis of a stick.

    Attributes:
        label: what it does, at -1 and at 1.
        minus: key that pulls it to -1, by its place on the keyboard.
        plus: key that pushes it to 1.
        pad: number of the gamepad's axis, in the standard layout of browsers, and its sign; () for none.
    """

    label: str
    minus: str
    plus: str
    pad: tuple[int, int] | tuple[()] = ()


@dataclass(frozen=True)
class Stick:
    """Axes that are held by keys, a gamepad or the mouse and spring back to 0; the event's value is their positions."""

    kind: ClassVar[str] = "stick"
    name: str
    label: str
    axes: tuple[Axis, ...]

    def read(self, value: Any) -> Any:
        """Return a position in [-1, 1] for each axis; `ValueError` if they are not numbers, or not so many."""
        if not isinstance(value, list) or len(value) != len(self.axes):
            raise ValueError
        return tuple(min(max(_number(one), -1.0), 1.0) for one in value)


@dataclass(frozen=True)
class Place:
    """A position in the scene, by a slider for each coordinate or by dragging a thing; the event's value is all three.

    Attributes:
        axes: what the coordinates are called, in the world's order: north, east and down.
        least: the smallest of each [m].
        most: the largest of each [m].
        value: at first [m].
        step: between values that can be chosen [m].
        thing: path of what can be dragged in the scene; "" for nothing.
    """

    kind: ClassVar[str] = "place"
    name: str
    label: str
    axes: tuple[str, str, str]
    least: tuple[float, float, float]
    most: tuple[float, float, float]
    value: tuple[float, float, float]
    step: float
    thing: str = ""

    def read(self, value: Any) -> Any:
        """Return three numbers within the bounds; `ValueError` if they are not numbers, or not so many."""
        if not isinstance(value, list) or len(value) != len(self.axes):
            raise ValueError
        bounds = zip(map(_number, value), self.least, self.most, strict=True)
        return tuple(min(max(one, least), most) for one, least, most in bounds)


@dataclass(frozen=True)
class Pull:
    """A hold on a thing in the scene, which a person pulls by a point; the event's value is that point and the hand.

    Both are triples [m], the point in the thing's axes and the hand in the world's; None once it is let go.

    Attributes:
        thing: path of what can be held.
        reach: largest coordinate of a point that can be held [m].
        farthest: largest coordinate of the hand [m].
        key: that lets plain dragging pull, where else Ctrl or Alt is held down.
    """

    kind: ClassVar[str] = "pull"
    name: str
    label: str
    thing: str
    reach: float
    farthest: float
    key: str = ""

    def read(self, value: Any) -> Any:
        """Return None, or point and hand; `ValueError` if they are not six numbers, or one is beyond its bound."""
        if value is None:
            return None
        if not isinstance(value, list) or len(value) != 6:
            raise ValueError
        numbers = tuple(map(_number, value))
        point, hand = numbers[:3], numbers[3:]
        if max(map(abs, point)) > self.reach or max(map(abs, hand)) > self.farthest:
            raise ValueError
        return point, hand


Control = Button | Switch | Choice | Slider | Number | Stick | Place | Pull


@dataclass(frozen=True)
class Group:
    """Controls that stand together under a heading.

    Attributes:
        note: a sentence for the person, between heading and controls; "" for none.
        opened: whether the controls are shown at first, and not the heading alone.
    """

    label: str
    controls: tuple[Control, ...]
    note: str = ""
    opened: bool = True


class Panel:
    """The controls of a page, by name."""

    def __init__(self, groups: Sequence[Group]) -> None:
        """Take the controls.

        Raises:
            InvalidInputError: two of them have one name.
        """
        self.groups = tuple(groups)
        self._controls: dict[str, Control] = {}
        for control in (control for group in self.groups for control in group.controls):
            if control.name in self._controls or control.name == LEFT:
                raise InvalidInputError(
                    f"two controls of the panel are called {control.name!r}; rename one of them"
                )
            self._controls[control.name] = control

    def described(self) -> list[dict[str, Any]]:
        """Return what the page needs to show them, for JSON."""
        return [
            {
                "label": group.label,
                "note": group.note,
                "opened": group.opened,
                "controls": [{"kind": control.kind, **asdict(control)} for control in group.controls],
            }
            for group in self.groups
        ]

    def read(self, words: Iterable[dict[str, Any]]) -> list[Event]:
        """Return the events that the words of pages mean; words that mean none are passed over."""
        return [event for word in words if (event := self._event(word)) is not None]

    def _event(self, word: dict[str, Any]) -> Event | None:
        name = word["name"]
        if name == LEFT:
            return Event(LEFT)
        if name not in self._controls:
            return None
        try:
            return Event(name, self._controls[name].read(word["value"]))
        except ValueError:
            return None


def _number(value: Any) -> float:
    """Return a finite number; `ValueError` if it is none."""
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError
    return float(value)
