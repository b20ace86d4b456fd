"""Reading `--with "NAME: KEY=VALUE ..."`: settings by name."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Any

from dq_marine.cli.keyword_values import read_keywords
from dq_marine.errors import InvalidInputError

_NEXT = re.compile(r"[,\s]\s*(?=[A-Za-z_][\w.]*=)")
"""A comma or a space before another keyword; others belong to values."""


def read_variants(texts: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Return keywords by the name of the settings, from texts such as "order 8: scheme=galerkin, order=8".

    Keywords are divided by commas or spaces. Without a name they are the name, too.

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
        if not rest.strip():
            raise InvalidInputError(
                f'--with {text} changes nothing; give KEY=VALUE, as in "order 2: order=2"'
            )
        keywords = [one.strip() for one in _NEXT.split(rest.strip())]
        variants[name] = read_keywords(keywords, option="--with")
    return variants
