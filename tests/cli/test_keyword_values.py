"""`--set KEY=VALUE`: what values mean, and what is refused."""

from __future__ import annotations

from typing import Any

import pytest

from dq_marine.cli.keyword_values import read_keywords
from dq_marine.errors import InvalidInputError


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("0.3", 0.3),
        ("3", 3),
        ("1e-3", 1e-3),
        ("-2", -2),
        ("true", True),
        ("null", None),
        ("thrusters", "thrusters"),
        ("ships/my-ship.toml", "ships/my-ship.toml"),
        ('"a = b"', "a = b"),
        ("'single'", "single"),
        ("0.2,-0.1,0", [0.2, -0.1, 0]),
        (".5,+1, 2", [0.5, 1.0, 2.0]),
        ("[0.2, -0.1, 0.0]", [0.2, -0.1, 0.0]),
        ("{effort = 0.05}", {"effort": 0.05}),
        ('{"effort": 0.05}', {"effort": 0.05}),
        ('[{"kind": "wind", "speed": 8}]', [{"kind": "wind", "speed": 8}]),
        ('[{kind = "wind", gusts = true}]', [{"kind": "wind", "gusts": True}]),
    ],
)
def test_values_are_toml_json_or_words(text: str, value: Any) -> None:
    assert read_keywords([f"key={text}"]) == {"key": value}


def test_dots_reach_into_tables_and_the_last_counts() -> None:
    texts = ["reward.effort=0.05", "reward.attitude=1", "current=0.1", "current=0.2", "a.b.c=1"]
    assert read_keywords(texts) == {
        "reward": {"effort": 0.05, "attitude": 1},
        "current": 0.2,
        "a": {"b": {"c": 1}},
    }
    assert read_keywords(["reward=1", "reward.effort=2"]) == {"reward": {"effort": 2}}


@pytest.mark.parametrize("text", ["current", "=0.3", "a b=1", ".a=1", "a.=1", "1a=2", "", "a-b=1"])
def test_what_names_no_keyword_is_refused(text: str) -> None:
    with pytest.raises(InvalidInputError, match="give KEY=VALUE, as in current=0"):
        read_keywords([text])


@pytest.mark.parametrize("value", ["", "[1, 2", '{"a": }', "a=b", '"open', "1\nb = 2", "a,b,c"])
def test_what_is_neither_toml_nor_json_is_refused(value: str) -> None:
    with pytest.raises(InvalidInputError, match="neither TOML nor JSON"):
        read_keywords([f"key={value}"])
