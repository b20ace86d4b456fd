"""What `seabed=` takes: a chart, or what file one is in."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from dq_marine.charts.npy import read_npy
from dq_marine.charts.seabed_chart import SeabedChart
from dq_marine.checks import existing_file, finite_number, shown
from dq_marine.errors import InvalidInputError, UnknownKeywordError

ENTRIES = ("file", "spacing")
"""Of a dictionary that says which file a chart is in."""

GEOTIFF_ENDINGS = (".tif", ".tiff")


def seabed_chart(given: SeabedChart | str | os.PathLike[str] | Mapping[str, Any]) -> SeabedChart:
    """Return a chart as it is, or from its file.

    Args:
        given: a chart; the path of a GeoTIFF, which says itself how far apart its samples are; or a dictionary with
            `file`, a NumPy file (.npy) or a GeoTIFF, and `spacing` [m], which a NumPy file needs and a GeoTIFF has.

    Raises:
        InvalidInputError: it is nothing of this, there is no such file, or what is in it is wrong.
        MissingDependencyError: it is a GeoTIFF, and tifffile is not installed.
    """
    if isinstance(given, SeabedChart):
        return given
    if isinstance(given, Mapping):
        unknown = sorted(map(str, set(given) - set(ENTRIES)))
        if unknown or "file" not in given:
            raise UnknownKeywordError.of(
                "seabed", unknown or ["nothing called 'file'"], f"give {list(ENTRIES)}"
            )
        return _read(given["file"], given.get("spacing"))
    return _read(given, None)


def _read(file: Any, spacing: Any) -> SeabedChart:
    if not isinstance(file, str | os.PathLike):
        raise InvalidInputError(
            f"seabed = {shown(file)}; give the path of a GeoTIFF, {{'file': ..., 'spacing': ...}}, or a SeabedChart"
        )
    path = existing_file("seabed", file)
    if path is None:
        raise InvalidInputError(
            f"seabed = {shown(os.fspath(file))}: there is no such file; give one that there is"
        )
    if path.suffix.lower() in GEOTIFF_ENDINGS:
        return _from_geotiff(path, spacing)
    if path.suffix.lower() != ".npy":
        raise InvalidInputError(
            f"seabed = {shown(str(path))} has the ending {path.suffix!r}; give a .npy file, or a GeoTIFF that ends "
            f"in {' or '.join(GEOTIFF_ENDINGS)}"
        )
    if spacing is None:
        raise InvalidInputError(
            f"seabed = {shown(str(path))}: a NumPy file does not say how far apart its samples are; give "
            "{'file': ..., 'spacing': metres}"
        )
    return SeabedChart(read_npy(path), finite_number("seabed['spacing']", spacing), path.name)


def _from_geotiff(path: Path, spacing: Any) -> SeabedChart:
    from dq_marine.charts.geotiff import read_geotiff  # here: NumPy files do without its library

    if spacing is not None:
        raise InvalidInputError(
            f"seabed['spacing'] = {shown(spacing)}: {path.name} is a GeoTIFF, which has its own; leave it out"
        )
    return SeabedChart(*read_geotiff(path), path.name)
