"""Reading `--with "NAME: KEY=VALUE ..."`: settings by name."""

from __future__ import annotations

import re
import shlex
from collections.abc import Sequence
from typing import Any

from dq_marine.cli.keyword_values import read_keywords
from dq_marine.errors import InvalidInputError

_NEXT = re.compile(r",\s*(?=[A-Za-z_][\w.]*=)")
"""A comma before another keyword; others belong to values."""


def read_variants(texts: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Return keywords by the name of the settings, from texts such as "order 8: scheme=galerkin, order=8".

    Keywords are divided by commas or spaces, and quotes keep spaces in a value. Without a name the keywords are it.

    Raises:
        InvalidInputError: two have the same name, there is no keyword, or a value cannot be read.
    """
    variants: dict[str, dict[str, Any]] = {}
    for text in texts:
        name, colon, rest = text.partition(":")
        if not colon or "=" in name:
            name, rest = text, text
        name = name.strip()
        if not name or name in variants:
            raise InvalidInputError(
                f"--with {text}: there are two settings called {name!r}, or it is empty; name each"
            )
        keywords = read_keywords(_words(rest, text), option="--with")
        if not keywords:
            raise InvalidInputError(
                f'--with {text} changes nothing; give KEY=VALUE, as in "order 2: order=2"'
            )
        variants[name] = keywords
    return variants


def _words(rest: str, text: str) -> list[str]:
    try:
        return [word for part in _NEXT.split(rest) for word in shlex.split(part)]
    except ValueError as error:
        raise InvalidInputError(f"--with {text}: {error}; close it, or leave it out") from error
