"""Nested pairs, and functions folded into one."""

from __future__ import annotations

from dq_marine.algebra.nesting import folded, nested


def test_pairs_end_in_an_empty_tuple() -> None:
    assert nested([]) == ()
    assert nested("abc") == ("a", ("b", ("c", ())))


def test_a_fold_takes_the_first_outermost() -> None:
    calls = []

    def link(name, rest):
        def call(numbers):
            calls.append((name, numbers[0]))
            return rest(numbers[1]) + 1

        return call

    together = folded(link, ["first", "second"], lambda numbers: len(numbers))
    assert together(nested([10, 20])) == 2
    assert calls == [("first", 10), ("second", 20)]
