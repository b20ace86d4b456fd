"""What a page says is taken only where it is about a control of the panel, and a value that this one can have."""

from __future__ import annotations

import json
import math
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from dq_marine.errors import InvalidInputError
from dq_marine.viewer.controls import (
    LEFT,
    Axis,
    Button,
    Choice,
    Event,
    Group,
    Number,
    Panel,
    Place,
    Pull,
    Slider,
    Stick,
    Switch,
)

CONTROLS = (
    Button("go", "Go", key="KeyG"),
    Switch("on", "on", False),
    Choice("who", "who", ("one", "two"), "one"),
    Slider("speed", "speed", 0.5, 2.0, 1.0, 0.1, "x"),
    Number("seed", "seed", 0, 100, 3),
    Stick("stick", "stick", (Axis("a", "KeyA", "KeyD"), Axis("b", "KeyS", "KeyW", (1, -1)))),
    Place("goal", "goal", ("n", "e", "d"), (-1.0, -2.0, 0.0), (1.0, 2.0, 9.0), (0.0, 0.0, 5.0), 0.01),
    Pull("pull", "pull", "/world/vehicle", 2.0, 1e3),
)
PANEL = Panel([Group("all", CONTROLS)])


def read(name: str, value: Any) -> list[Event]:
    return PANEL.read([{"name": name, "value": value}])


@pytest.mark.parametrize(
    ("name", "value", "taken"),
    [
        ("go", None, None),
        ("go", 7, None),
        ("on", True, True),
        ("who", "two", "two"),
        ("speed", 1.5, 1.5),
        ("speed", 99, 2.0),
        ("speed", -1e300, 0.5),
        ("seed", 12.0, 12),
        ("seed", 1e9, 100),
        ("stick", [0.5, -3], (0.5, -1.0)),
        ("goal", [0.5, -3, 4], (0.5, -2.0, 4.0)),
        ("pull", None, None),
        ("pull", [1, 0, -2.0, 1e3, 5, 0.5], ((1.0, 0.0, -2.0), (1e3, 5.0, 0.5))),
    ],
)
def test_values_are_taken_within_their_bounds(name: str, value: Any, taken: Any) -> None:
    assert read(name, value) == [Event(name, taken)]


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("unknown", None),
        ("on", 1),
        ("on", "true"),
        ("who", "three"),
        ("who", None),
        ("speed", "1"),
        ("speed", True),
        ("speed", math.nan),
        ("seed", [1]),
        ("stick", [0.0]),
        ("stick", [0.0, "x"]),
        ("stick", 0.0),
        ("goal", [0.0, 0.0]),
        ("goal", [0.0, 0.0, "x"]),
        ("goal", None),
        ("pull", 1.0),
        ("pull", [0.0] * 5),
        ("pull", [0.0] * 5 + [math.nan]),
        ("pull", [0.0] * 5 + [math.inf]),
        ("pull", [2.1] + [0.0] * 5),
        ("pull", [0.0] * 5 + [1001.0]),
        ("pull", [0.0] * 5 + [True]),
    ],
)
def test_what_means_nothing_is_passed_over(name: str, value: Any) -> None:
    assert read(name, value) == []


PLAIN = (
    st.none() | st.booleans() | st.floats() | st.integers() | st.text() | st.lists(st.floats(), max_size=6)
)


@given(st.sampled_from([control.name for control in CONTROLS]), PLAIN)
def test_no_value_of_a_page_gets_past_the_bounds(name: str, value: Any) -> None:
    for event in read(name, value):
        control = next(control for control in CONTROLS if control.name == name)
        match control:
            case Button():
                assert event.value is None
            case Switch():
                assert isinstance(event.value, bool)
            case Choice():
                assert event.value in control.options
            case Slider() | Number():
                assert control.least <= event.value <= control.most
            case Stick():
                assert all(-1.0 <= position <= 1.0 for position in event.value)
            case Place():
                within = zip(control.least, event.value, control.most, strict=True)
                assert all(least <= one <= most for least, one, most in within)
            case Pull():
                point, hand = event.value or ((0.0,) * 3, (0.0,) * 3)
                assert all(abs(one) <= control.reach for one in point)
                assert all(abs(one) <= control.farthest for one in hand)


def test_a_page_that_leaves_is_an_event_in_its_place() -> None:
    words = [{"name": "go", "value": None}, {"name": LEFT, "value": None}, {"name": "on", "value": True}]
    assert PANEL.read(words) == [Event("go"), Event(LEFT), Event("on", True)]


def test_names_are_unique() -> None:
    for name in ("go", LEFT):
        with pytest.raises(InvalidInputError, match=f"{name!r}; rename"):
            Panel([Group("a", (Button("go", "Go"),)), Group("b", (Button(name, "Once more"),))])


def test_a_description_is_json() -> None:
    described = json.loads(json.dumps(PANEL.described()))
    assert [control["kind"] for control in described[0]["controls"]] == [one.kind for one in CONTROLS]
    assert described[0]["controls"][5]["axes"][1] == {
        "label": "b",
        "minus": "KeyS",
        "plus": "KeyW",
        "pad": [1, -1],
    }
