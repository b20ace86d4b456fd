"""A number that counts the arithmetic done with it: the exact cost of a pure function, in operations."""

from __future__ import annotations

import operator


class Counted(float):
    """A float whose arithmetic is counted in `Counted.operations`."""

    operations = 0


def _counting(operation):
    def count(*operands):
        Counted.operations += 1
        return Counted(operation(*map(float, operands)))

    return count


for _name in ("add", "sub", "mul", "truediv"):
    _operation = getattr(operator, _name)
    setattr(Counted, f"__{_name}__", _counting(_operation))
    setattr(Counted, f"__r{_name}__", _counting(lambda b, a, op=_operation: op(a, b)))
for _name in ("neg", "abs"):
    setattr(Counted, f"__{_name}__", _counting(getattr(operator, _name)))


def counted(structure):
    """Nested tuples with every number counted."""
    if not isinstance(structure, tuple):
        return Counted(structure)
    parts = [counted(part) for part in structure]
    return type(structure)(*parts) if hasattr(structure, "_fields") else tuple(parts)


def operations_of(function, *arguments):
    """Arithmetic operations in one call of a pure function."""
    before = Counted.operations
    function(*arguments)
    return Counted.operations - before
