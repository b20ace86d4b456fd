"""What a compiled function is made of: the key and the fingerprint by which it is found on disk again."""

from __future__ import annotations

import functools
import hashlib
import inspect
import marshal
from collections.abc import Callable, Iterable
from pathlib import Path
from types import CodeType, FunctionType
from typing import Any

import numpy as np

CONSTANT_TYPES = (bool, int, float, complex, str, tuple, np.ndarray)
"""What compiled code takes as it stood when it was compiled."""

BACKEND = Path(__file__).parent


def outside_values(function: Callable[..., Any]) -> list[Any]:
    """Return what a function closes over or uses by a name of its module; compiled code takes it as constant."""
    cells = [cell.cell_contents for cell in getattr(function, "__closure__", None) or ()]
    code, names = function.__code__, function.__globals__
    return cells + [names[name] for name in code.co_names if name in names]


def used_functions(function: Callable[..., Any]) -> list[FunctionType]:
    """Return the plain Python functions among a function's outside values."""
    return [value for value in outside_values(function) if inspect.isfunction(value)]


def constants_of(function: Callable[..., Any]) -> str:
    """Return the numbers, texts and arrays among a function's outside values, to tell it from its likes."""
    values = [value for value in outside_values(function) if isinstance(value, CONSTANT_TYPES)]
    return repr([value.tolist() if isinstance(value, np.ndarray) else value for value in values])


def code_of(function: Callable[..., Any]) -> str:
    """Return what tells a function from others of its name in its file: its instructions and their constants."""

    def parts(code: CodeType) -> Any:
        constants = [parts(value) if isinstance(value, CodeType) else repr(value) for value in code.co_consts]
        return code.co_code.hex(), code.co_names, code.co_varnames, constants

    return repr(parts(function.__code__))


def text_of(part: Callable[..., Any]) -> bytes:
    """Return the source file that defines a function or a class; where there is none, its code or its fields."""
    try:
        return Path(str(inspect.getsourcefile(part))).read_bytes()
    except (OSError, TypeError):
        return marshal.dumps(part.__code__) if inspect.isfunction(part) else repr(vars(part)).encode()


def all_used_functions(function: Callable[..., Any]) -> list[FunctionType]:
    """Return the plain functions that a function uses, directly or not, each once, in order of appearance."""
    found: dict[FunctionType, None] = {}

    def visit(user: Callable[..., Any]) -> None:
        for used in used_functions(user):
            if used not in found:
                found[used] = None
                visit(used)

    visit(function)
    return list(found)


@functools.cache
def own_fingerprint() -> bytes:
    """Return a hash over the sources of the backend, which every compiled function contains."""
    digest = hashlib.sha256()
    for path in sorted(BACKEND.rglob("*.py")):
        digest.update(hashlib.sha256(path.read_bytes()).digest())
    return digest.digest()


def source_fingerprint(parts: Iterable[Callable[..., Any]]) -> str:
    """Return a hash over the sources of the backend, of the given functions, and of the classes that they name."""
    named = {value for part in parts for value in outside_values(part) if inspect.isclass(value)}
    texts = {hashlib.sha256(text_of(part)).digest() for part in parts}
    texts |= {hashlib.sha256(text_of(one)).digest() for one in named if one.__module__ != "builtins"}
    return hashlib.sha256(b"".join([own_fingerprint(), *sorted(texts)])).hexdigest()[:20]


def name_of(function: Callable[..., Any]) -> str:
    """Return the dotted name of a function, followed by those of the functions it closes over."""
    cells = [cell.cell_contents for cell in getattr(function, "__closure__", None) or ()]
    inner = ", ".join(name_of(value) for value in cells if inspect.isfunction(value))
    name = f"{function.__module__}.{function.__qualname__}"
    return f"{name}[{inner}]" if inner else name


def key_and_fingerprint(function: Callable[..., Any], layout: str) -> tuple[str, str]:
    """Return what tells a function from all others of the same sources, and a hash over these."""
    parts: list[Callable[..., Any]] = [function, *all_used_functions(function)]
    key = "|".join([name_of(function), layout, *map(constants_of, parts), *map(code_of, parts)])
    return key, source_fingerprint(parts)
