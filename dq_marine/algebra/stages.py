"""Numbers of a body at several stages of a step at once: one number for each stage.

A collocation method evaluates the same functions at all its stages. Here a number at all stages is a `Stages`, one of
its parts for each stage, and a twist or a pose at all stages is a named tuple of those. Functions that know only
ordinary numbers are called by `each_stage`. Backends replace these functions by their own: for one body, compiled code
has the stages side by side in a SIMD vector, so that all stages cost about as much as one.

Sums over stages are taken in pairs, ((x1 + x2) + (x3 + x4)), by every backend alike: results have the same bits.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from dq_marine.algebra.nesting import alike

Weights: TypeAlias = tuple[float, ...]
"""A number for each stage, of the method."""


class Stages(tuple[Any, ...]):
    """A number, or a condition, for each stage of a step."""

    __slots__ = ()


def each_stage(weights: Weights, function: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """Return function(*arguments) at every stage.

    Args:
        weights: any weights of the method; they tell how many stages there are.
        function: of ordinary numbers; it may decide as all pure functions do (see `algebra.selection`).
        arguments: (nested tuples of) stages, and of ordinary numbers, which are the same at all stages.
    """
    results = [function(*(_at(part, j) for part in arguments)) for j in range(len(weights))]
    return stages_together(tuple(results))


def for_each(cases: tuple[Any, ...], function: Callable[[Any, Any], Any], others: Any) -> tuple[Any, ...]:
    """Return function(case, others) of every case: of what is computed for one body several times, as beams are.

    Args:
        cases: one or more (nested tuples of) numbers, all alike.
        function: of ordinary numbers; it may decide as all pure functions do (see `algebra.selection`).
        others: (nested tuples of) ordinary numbers, the same for all cases.
    """
    return tuple(function(case, others) for case in cases)


def stage_constants(weights: Weights, like: float) -> Any:
    """Return stages that hold these numbers, the same for every body, in as many lanes as `like` has."""
    return Stages(weights)


def stage_sum(weights: Weights, structure: Any) -> Any:
    """Return sum_j w_j x_j of (nested tuples of) stages: ordinary numbers."""
    if isinstance(structure, Stages):
        return paired_sum([weight * part for weight, part in zip(weights, structure, strict=True)])
    if isinstance(structure, tuple):
        return alike(structure, [stage_sum(weights, part) for part in structure])
    return paired_sum([weight * structure for weight in weights])


def stage_product(matrix: tuple[Weights, ...], structure: Any) -> Any:
    """Return y_i = sum_j A_ij x_j of (nested tuples of) stages: stages."""
    return stages_together(tuple(stage_sum(row, structure) for row in matrix))


def weighted_sum(weights: Weights, structures: tuple[Any, ...]) -> Any:
    """Return sum_j w_j x_j of (nested tuples of) ordinary numbers: of rates that were found one after the other.

    Args:
        weights: one for each structure.
        structures: one or more, all alike.
    """
    first = structures[0]
    if isinstance(first, tuple):
        return alike(first, [weighted_sum(weights, parts) for parts in zip(*structures, strict=True)])
    return paired_sum([weight * part for weight, part in zip(weights, structures, strict=True)])


def weighted_step(start: Any, h: float, weights: Weights, rates: tuple[Any, ...]) -> Any:
    """Return x + sum_j (h w_j) k_j of (nested tuples of) ordinary numbers.

    Args:
        start: x.
        h: how long the step is.
        weights: one for each rate.
        rates: one or more k_j, nested as x is.
    """
    if isinstance(start, tuple):
        pairs = zip(start, zip(*rates, strict=True), strict=True)
        return alike(start, [weighted_step(part, h, weights, parts) for part, parts in pairs])
    return start + paired_sum([(h * weight) * rate for weight, rate in zip(weights, rates, strict=True)])


def stages_apart(weights: Weights, structure: Any) -> tuple[Any, ...]:
    """Return one structure of ordinary numbers for each stage."""
    return tuple(_at(structure, j) for j in range(len(weights)))


def stages_together(structures: tuple[Any, ...]) -> Any:
    """Return the structure of stages whose parts these structures of ordinary numbers are: `stages_apart` undone."""
    first = structures[0]
    if isinstance(first, tuple):
        return alike(first, [stages_together(parts) for parts in zip(*structures, strict=True)])
    return Stages(structures)


def paired_sum(terms: Sequence[Any]) -> Any:
    """Return the sum of terms, that of the first half added to that of the second."""
    if len(terms) == 1:
        return terms[0]
    half = (len(terms) + 1) // 2
    return paired_sum(terms[:half]) + paired_sum(terms[half:])


def _at(structure: Any, j: int) -> Any:
    """Return one stage of (nested tuples of) stages; what is no stages stays."""
    if isinstance(structure, Stages):
        return structure[j]
    if isinstance(structure, tuple):
        return alike(structure, [_at(part, j) for part in structure])
    return structure
