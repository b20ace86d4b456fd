"""Titles of methods and cases, by name."""

from __future__ import annotations

from dq_marine.report.cases import CASES
from dq_marine.report.libraries import LIBRARIES
from dq_marine.report.methods import METHODS

OWN = tuple(name for name, method in METHODS.items() if method.family in ("DQVI", "Gauss", "Explicit"))
"""This package's own methods."""

KEEPING = tuple(name for name in OWN if METHODS[name].family != "Explicit")
"""Those that keep momentum and energy over any number of steps."""

RIVALS = tuple(name for name in METHODS if name not in OWN)
"""Baselines, which are compiled in the same way."""


def title_of(method: str) -> str:
    """Return how a method is called; a name that is not known is its own title."""
    known = METHODS.get(method) or LIBRARIES.get(method)
    return known.title if known else method


def case_title(case: str) -> str:
    """Return how a case is called."""
    return CASES[case].title if case in CASES else case


def order_of(method: str) -> int | None:
    """Return the order that a method is said to have."""
    return METHODS[method].order if method in METHODS else None


def in_order(methods: set[str]) -> list[str]:
    """Return methods in the order of the registry, unknown ones after them."""
    known = [name for name in (*METHODS, *LIBRARIES) if name in methods]
    return known + sorted(methods - set(known))
