"""What to choose when: read off the measured rows, by the same rules whatever they say."""

from __future__ import annotations

import math
from dataclasses import dataclass

from dq_marine.report.names import OWN, in_order, title_of
from dq_marine.report.plan import Rows, distinct, find
from dq_marine.report.presentation import Table, duration, factor, listed, number, power
from dq_marine.report.showing.curves import Curve, curves_of
from dq_marine.report.showing.extreme_view import FAILED, WRONG
from dq_marine.report.showing.long_run_view import KEPT_ENERGY, KEPT_MOMENTUM, largest
from dq_marine.report.showing.rates import kind_of

TARGETS = (1e-2, 1e-4, 1e-6, 1e-8)
NOBODY = "none of them"


@dataclass(frozen=True)
class Choice:
    """A line of advice: what is wanted, what to take, and what was measured."""

    wanted: str
    take: str
    measured: str


def advice(results: dict[str, Rows]) -> Table | None:
    """Return what to choose when; None if nothing was measured that says so."""
    choices = [
        *cost_choices(results.get("work_precision", [])),
        *long_choices(results.get("long_run", [])),
        *stiff_choices(results.get("stability_map", [])),
        *extreme_choices(results.get("extreme", [])),
    ]
    lines = [[choice.wanted, choice.take, choice.measured] for choice in choices]
    return Table("What to choose when", ["wanted", "take", "because"], lines, words=True) if lines else None


def cost_choices(rows: Rows) -> list[Choice]:
    """Return the fastest method by kind of motion and error."""
    kinds: dict[str, list[str]] = {}
    for name in distinct(rows, "case"):
        kinds.setdefault(kind_of(name), []).append(name)
    found = []
    for kind, members in kinds.items():
        curves = [curves_of(rows, name) for name in members]
        found += [fastest(f"{kind}, attitude to {power(target)} rad", curves, target) for target in TARGETS]
    return [choice for choice in found if choice is not None]


def fastest(wanted: str, curves: list[dict[str, Curve]], target: float) -> Choice | None:
    """Return the method that is fastest over some cases, by the geometric mean of its times."""
    costs = {name: mean_cost(name, curves, target) for name in set().union(*curves)} if curves else {}
    reached = {name: cost for name, cost in costs.items() if cost is not None}
    if not reached:
        return Choice(wanted, NOBODY, "no method reaches it in every case") if curves else None
    best = min(reached, key=lambda name: reached[name])
    own = min((name for name in reached if name in OWN), key=lambda name: reached[name], default=None)
    cases = f"{len(curves)} cases" if len(curves) > 1 else "1 case"
    measured = f"{duration(reached[best] * 1e-9)} a simulated second, mean of {cases}"
    if own is None:
        measured += "; no method of this package gets there"
    elif own != best:
        measured += f"; {title_of(own)}: {factor(reached[own] / reached[best])} that"
    else:
        others = {name: cost for name, cost in reached.items() if name not in OWN}
        second = min(others, key=lambda name: others[name], default=None)
        measured += (
            f"; {title_of(second)}: {factor(others[second] / reached[best])} that"
            if second
            else "; no other gets there"
        )
    return Choice(wanted, title_of(best), measured)


def mean_cost(name: str, curves: list[dict[str, Curve]], target: float) -> float | None:
    """Return the geometric mean of a method's times for an attitude error [ns], None if it misses it anywhere."""
    costs = [by_name[name].cost_at("attitude", target) if name in by_name else None for by_name in curves]
    known = [cost for cost in costs if cost is not None]
    if len(known) < len(costs):
        return None
    return math.exp(sum(math.log(cost) for cost in known) / len(known))


def long_choices(rows: Rows) -> list[Choice]:
    """Return who keeps energy and momentum over long runs, by step size."""
    found = []
    for step in distinct(rows, "step"):
        own = find(rows, step=step)
        keepers = [name for name in in_order(set(distinct(own, "method"))) if keeps(find(own, method=name))]
        steps = max(row["steps"] for row in own)
        found.append(
            Choice(
                f"{steps:,} steps of h = {step:g} s without damping, energy and momentum kept",
                listed([title_of(name) for name in keepers]) or NOBODY,
                f"energy within {KEPT_ENERGY:.0%} and linear momentum to {power(KEPT_MOMENTUM)} in every run; "
                "no other does",
            )
        )
    return found


def keeps(rows: Rows) -> bool:
    """Whether a method keeps energy and momentum in all runs."""
    runs = [find(rows, case=case) for case in distinct(rows, "case")]
    return all(
        largest(run, "energy_error") <= KEPT_ENERGY and largest(run, "linear_momentum_error") <= KEPT_MOMENTUM
        for run in runs
    )


def stiff_choices(rows: Rows) -> list[Choice]:
    """Return who takes any step under any damping."""
    damped = find(rows, kind="damping")
    if not damped:
        return []
    failing = {row["method"] for row in damped if row["failing_step"] is not None}
    free = [name for name in in_order(set(distinct(damped, "method"))) if name not in failing]
    stiffest = max(row["stiffness"] for row in damped)
    longest = max(row["largest_step"] or 0.0 for row in damped)
    edges = [row["failing_step"] * row["stiffness"] for row in damped if row["failing_step"] is not None]
    others = f"all others fail before h lambda = {number(max(edges), 3)}" if edges else "no method fails"
    return [
        Choice(
            "damping of unknown stiffness, steps that are not chosen by it",
            listed([title_of(name) for name in free]) or NOBODY,
            f"no failure with damping rates to {stiffest:g}/s and steps to {longest:g} s; {others}",
        )
    ]


def extreme_choices(rows: Rows) -> list[Choice]:
    """Return who loses least of the extreme motions."""
    if not rows:
        return []
    names = in_order(set(distinct(rows, "method")))
    lost = {name: sum(row["outcome"] in (WRONG, FAILED) for row in find(rows, method=name)) for name in names}
    least = min(lost.values())
    best = [name for name in names if lost[name] == least]
    total = len(set(distinct(rows, "cell")))
    baseline = min(names, key=lambda name: (name in OWN, lost[name]))
    return [
        Choice(
            "inputs that may be anything, and no garbage out",
            listed([title_of(name) for name in best]),
            f"{least} of {total:,} extreme motions lost; of the baselines {title_of(baseline)} loses fewest, "
            f"{lost[baseline]:,}",
        )
    ]
