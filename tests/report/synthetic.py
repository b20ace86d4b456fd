"""Rows as the studies measure them, made up so that theory holds: small, quick, and easy to doctor."""

from __future__ import annotations

import math
from typing import Any

from dq_marine.report.methods import METHODS
from dq_marine.report.plan import Rows
from dq_marine.report.showing.curves import curves_of
from dq_marine.report.showing.stability_view import BOUNDS, CEILING

CASE = "munk_spheroid"
LEVELS = [20 * 2**level for level in range(9)]


def error_rows(case: str = CASE, orders: dict[str, float] | None = None) -> Rows:
    """Errors that fall with the methods' own orders, or with others, down to round-off."""
    rows: Rows = []
    for name, method in METHODS.items():
        order = (orders or {}).get(name, float(method.order))
        for steps in LEVELS:
            step = 5.0 / steps
            error = max(0.02 * (4.0 * step) ** order, 1e-14)
            rows.append(
                {
                    "kind": "error",
                    "case": case,
                    "method": name,
                    "steps": steps,
                    "step": step,
                    "evaluations": method.evaluations / step,
                    "outcome": "done",
                    "known_to": 1e-14,
                    "position": 0.5 * error,
                    "attitude": error,
                    "velocity": 2.0 * error,
                }
            )
    rows[0] |= {"outcome": "wrong_branch", "position": None, "attitude": None, "velocity": None}
    return rows


def time_rows(case: str = CASE, nanoseconds: float = 100.0) -> Rows:
    """Times that grow with steps and evaluations."""
    return [
        {
            "kind": "time",
            "case": case,
            "method": name,
            "steps": steps,
            "best_ns": nanoseconds * method.evaluations * steps / 5.0,
            "median_ns": 1.1 * nanoseconds * method.evaluations * steps / 5.0,
        }
        for name, method in METHODS.items()
        for steps in LEVELS
    ]


def work_precision(**options: Any) -> Rows:
    """Rows of errors and of times."""
    return error_rows(**options) + time_rows()


def long_run(drift: float = 0.0) -> Rows:
    """DQVI that keeps everything but for a drift, RK4 that loses energy, Euler that blows up."""
    rows: Rows = []
    for name in ("dqvi2", "dqvi4", "rk4_quaternion", "explicit_euler"):
        for step in (0.02, 0.1):
            for steps in (1, 10, 100, 1000, 9500, 10000):
                row = {
                    "case": "kirchhoff_bluerov2",
                    "title": "BlueROV2 Heavy, free",
                    "method": name,
                    "step": step,
                    "steps": steps,
                    "time": steps * step,
                    "outcome": "done",
                }
                if name == "explicit_euler" and steps == 10000:
                    rows.append(row | {"outcome": "blew up"})
                    continue
                own = name.startswith("dqvi")
                energy = 1e-4 + drift * steps if own else -1e-7 * steps
                momentum = 1e-14 if own else 1e-8 * steps
                rows.append(
                    row
                    | {"energy_error": energy, "linear_momentum_error": momentum}
                    | {"angular_momentum_error": momentum}
                )
    return rows


def stability() -> Rows:
    """Bounds exactly as theory has them."""
    rows: Rows = []
    for kind, bounds in BOUNDS.items():
        for name, bound in bounds.items():
            for stiffness in (1.0, 100.0):
                limit = bound / stiffness
                free = limit > CEILING
                rows.append(
                    {
                        "kind": kind,
                        "method": name,
                        "stiffness": stiffness,
                        "largest_step": None if limit == 0.0 else min(limit, CEILING),
                        "failing_step": None if free else (0.02 if limit == 0.0 else 1.001 * limit),
                        "failure": "" if free else "blew up",
                    }
                )
    return rows


def extreme() -> Rows:
    """Eight motions: DQVI refuses half of them, RK4 blows up in half of them, Euler is wrong in silence."""
    rows: Rows = []
    fates = {
        "dqvi2": ("accurate", "refused"),
        "rk4_quaternion": ("bounded", "blew up"),
        "explicit_euler": ("bounded", "wrong in silence"),
    }
    for name, fate in fates.items():
        for cell in range(8):
            row = {
                "spin": float(cell % 2),
                "speed": 0.1,
                "mass": 1.0,
                "condition": 1.0 + cell // 2,
                "step": 0.1,
                "distance": 0.0,
                "cell": cell,
                "method": name,
                "outcome": fate[cell % 2],
                "reason": "wrong_branch" if fate[cell % 2] == "refused" else "",
                "has_reference": True,
            }
            if name == "dqvi2":
                row |= {"branch_steps": 5, "branch_whole": 4, "branch_split": 1, "branch_other": 0}
            rows.append(row)
    return rows


def terms() -> Rows:
    """Two scenes, two backends."""
    rows: Rows = []
    for backend, best in (("one body", 200.0), ("batch", 30.0)):
        for factor, name in ((1.0, "inertia alone"), (1.1, "current"), (1.6, "everything")):
            row = {"backend": backend, "terms": name, "best_ns": factor * best, "median_ns": factor * best}
            rows.append(row | ({"iterations": 2.0} if backend == "one body" else {"bodies": 512}))
    return rows


def solver() -> Rows:
    """An ordinary run without fallback, an extreme one with."""
    counts = [
        ("ordinary", "direct", 2, 900),
        ("ordinary", "direct", 3, 100),
        ("extreme", "direct", 4, 50),
        ("extreme", "fallbacks", 40, 7),
        ("extreme", "fallbacks", 600, 1),
        ("extreme", "wrong_branch", 0, 3),
    ]
    return [
        {"scene": scene, "method": "dqvi2", "how": how, "iterations": iterations, "steps": steps}
        for scene, how, iterations, steps in counts
    ]


def results() -> dict[str, Rows]:
    """Rows of all studies, by name."""
    return {
        "work_precision": work_precision(),
        "long_run": long_run(),
        "stability_map": stability(),
        "extreme": extreme(),
        "terms": terms(),
        "solver": solver(),
    }


def slope_between(rows: Rows, method: str) -> float:
    """The slope of the first two errors that are not round-off."""
    first, second = curves_of(rows, CASE)[method].points[1:3]
    return math.log(first["attitude"] / second["attitude"]) / math.log(first["step"] / second["step"])
