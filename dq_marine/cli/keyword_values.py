"""Reading `--set KEY=VALUE`."""

from __future__ import annotations

import contextlib
import json
import re
import tomllib
from collections.abc import Sequence
from typing import Any

from dq_marine.errors import InvalidInputError

_KEY = re.compile(r"[A-Za-z_]\w*(\.[A-Za-z_]\w*)*")
_WORD = re.compile(r"[^\[\]{}\"'=,]+")
_NUMBERS = re.compile(r"[-+.\w]+(,[-+.\w]+)+")


def read_keywords(texts: Sequence[str], *, option: str = "--set") -> dict[str, Any]:
    """Return keywords from texts such as "current=0.3" or "reward.effort=0.05"; dots make nested dictionaries.

    The last of two that name the same keyword counts.

    Args:
        texts: what was typed.
        option: behind which, for the message.

    Raises:
        InvalidInputError: a text has no "=", or its value cannot be read.
    """
    keywords: dict[str, Any] = {}
    for text in texts:
        key, equals, value = text.partition("=")
        if not equals or not _KEY.fullmatch(key):
            raise InvalidInputError(
                f"{option} {text} does not name a keyword and its value; give KEY=VALUE, as in current=0.3"
            )
        *outer, last = key.split(".")
        table = keywords
        for part in outer:
            inner = table.get(part)
            table[part] = inner if isinstance(inner, dict) else {}
            table = table[part]
        table[last] = read_value(value, option=f"{option} {text}")
    return keywords


def read_value(text: str, *, option: str) -> Any:
    """Return a value written as TOML or JSON; numbers between commas are a list, a plain word is a text.

    Args:
        text: the value.
        option: what was typed, for the message.

    Raises:
        InvalidInputError: it is none of these.
    """
    try:
        content = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        content = {}
    if list(content) == ["value"]:
        return content["value"]
    for written in (text, f"[{text}]" if _NUMBERS.fullmatch(text) else text):
        try:
            return json.loads(written)
        except ValueError:
            continue
    with contextlib.suppress(ValueError):
        if "," in text:  # numbers as Python has them, such as .5 and +1
            return [float(part) for part in text.split(",")]
    if _WORD.fullmatch(text):
        return text
    raise InvalidInputError(
        f"""{option}: the value is neither TOML nor JSON; give a number, a word, or as in '[0.0, 0.0, 5.0]' or """
        """'[{"spectrum": "jonswap"}]', with quotes that keep the shell away"""
    )
