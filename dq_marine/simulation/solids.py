"""Turns what `solids=` takes into solids, and back into text and numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields
from typing import Any

from dq_marine.checks import check_entries, one_of, shown
from dq_marine.errors import InvalidInputError
from dq_marine.physics.contact.shapes import SHAPES, SolidShape
from dq_marine.physics.contact.solid import Solid

MESH = "mesh"
MESH_ENTRIES = ("file", "spacing")
OF_SOLIDS = tuple(one.name for one in fields(Solid) if one.name != "shape")
MOST_SOLIDS = 64
"""In a scene: each has compiled code of its own."""


def solids_of(solids: Any) -> tuple[Solid, ...]:
    """Return solids from what `solids=` was given: a list of `Solid`s, of their shapes, and of dictionaries.

    A dictionary has a "kind", the arguments of the shape that it stands for, and those of `Solid`:

        {"kind": "plane", "position_ned": [0, 0, 12]}
        {"kind": "box", "size": [30, 2, 8], "position_ned": [5, 0, 0], "heading": 0.3, "friction": 0.2}
        {"kind": "mesh", "file": "wreck.stl", "spacing": 0.2, "position_ned": [20, 0, 12]}

    Raises:
        InvalidInputError: there is something else, or a value is wrong.
    """
    if not isinstance(solids, Sequence) or isinstance(solids, str):
        raise InvalidInputError(f'solids = {shown(solids)}; give a list, such as [{{"kind": "plane"}}]')
    if len(solids) > MOST_SOLIDS:
        raise InvalidInputError(
            f"solids has {len(solids)} of them; give at most {MOST_SOLIDS}, or a mesh of many"
        )
    return tuple(_solid(part) for part in solids)


def plain_solids(solids: Sequence[Solid]) -> list[dict[str, Any]]:
    """Return solids as dictionaries of text and numbers, which `solids_of` takes.

    Raises:
        InvalidInputError: one has a shape of the user's own, which no JSON can say.
    """
    return [_plain(solid) for solid in solids]


def _solid(part: Any) -> Solid:
    if isinstance(part, Solid):
        return part
    if isinstance(part, Mapping):
        return _from_dictionary(dict(part))
    if isinstance(part, SolidShape) and not isinstance(part, type):
        return Solid(part)
    raise InvalidInputError(
        f"solids has {shown(part)}; give Solid(...), a shape such as Ball(...), or a dictionary such as "
        f'{{"kind": "ball", "radius": 1.0}}'
    )


def _from_dictionary(given: dict[str, Any]) -> Solid:
    kind = one_of("kind of a solid", given.pop("kind", None), (*SHAPES, MESH))
    of_solid = {name: given.pop(name) for name in OF_SOLIDS if name in given}
    if kind == MESH:
        known = needed = list(MESH_ENTRIES)
    else:
        own = fields(SHAPES[kind])
        known = [one.name for one in own]
        needed = [one.name for one in own if one.default is MISSING]
    check_entries(f"solids: a {kind}", {**of_solid, **given}, (*known, *OF_SOLIDS), needed)
    return Solid(_mesh(**given) if kind == MESH else SHAPES[kind](**given), **of_solid)


def _mesh(file: Any, spacing: Any) -> SolidShape:
    from dq_marine.charts.solid_chart import SolidChart  # here: it imports what reads and mends meshes

    return SolidChart.from_stl(file, spacing)


def _plain(solid: Solid) -> dict[str, Any]:
    from dq_marine.charts.solid_chart import SolidChart  # here: as above

    shape = solid.shape
    of_solid = {name: getattr(solid, name) for name in OF_SOLIDS} | {"position_ned": list(solid.position_ned)}
    if isinstance(shape, SolidChart):
        return {"kind": MESH, "file": shape.file, "spacing": shape.spacing, **of_solid}
    for kind, make in SHAPES.items():
        if type(shape) is make:
            return {"kind": kind, **{one.name: getattr(shape, one.name) for one in fields(make)}, **of_solid}
    raise InvalidInputError(f"solids has {shown(shape)}, which has no JSON; give it in Python")
