"""Reading depths from a GeoTIFF whose pixels are squares in metres (OGC 19-008r4, GeoTIFF 1.1)."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.charts.seabed_chart import check_count
from dq_marine.checks import real_numbers
from dq_marine.errors import InvalidInputError
from dq_marine.util.extras import optional_library

MODEL_TYPE, PROJECTED, UNIT, METRE = "GTModelTypeGeoKey", 1, "ProjLinearUnitsGeoKey", 9001
"""Of the keys of a GeoTIFF: that its axes are those of a projection, and in metres."""

SQUARE = 1e-6
"""Sides of a pixel differ by less than this share."""

IN_METRES = "project it to metres, its pixels square (GDAL: gdalwarp -t_srs EPSG:32633 -tr 2 2, with your zone of UTM)"


def read_geotiff(path: Path) -> tuple[NDArray[np.float64], float]:
    """Return the depths (or heights) of a GeoTIFF from south to north [m], NaN where it has none, and their spacing.

    Raises:
        InvalidInputError: it cannot be read, has more than one band or too many pixels, says nowhere how large these
            are, or they are not squares, not in metres, or turned against north.
        MissingDependencyError: tifffile is not installed.
    """
    tifffile = optional_library("a seabed from a GeoTIFF", "tifffile", "charts")
    try:
        with tifffile.TiffFile(path) as file:
            page = file.pages[0]
            shape, tags = page.shape, page.geotiff_tags
            hole = page.nodata if "GDAL_NODATA" in page.tags else None
            _check_shape(shape, path)
            numbers = page.asarray()
    except InvalidInputError:
        raise
    except Exception as error:  # what a damaged file leads to is not listed anywhere
        raise InvalidInputError(
            f"{path} cannot be read as a GeoTIFF: {error}; write it again, without compression or with DEFLATE (GDAL: "
            "gdal_translate -co COMPRESS=DEFLATE)"
        ) from error
    depths = real_numbers(path.name, numbers, "a table of depths")
    if hole is not None:
        depths[depths == hole] = math.nan
    return np.ascontiguousarray(depths[::-1]), _spacing(dict(tags or {}), path)


def _check_shape(shape: tuple[int, ...], path: Path) -> None:
    if len(shape) != 2:
        raise InvalidInputError(f"{path} has an image of shape {shape}; give one band of depths (GDAL: -b 1)")
    check_count(shape, path.name)


def _spacing(tags: dict[str, Any], path: Path) -> float:
    """Return the side of a pixel [m]."""
    if "ModelTransformation" in tags:
        raise InvalidInputError(f"{path} is turned against north; {IN_METRES}")
    scale = tags.get("ModelPixelScale")
    if scale is None:
        raise InvalidInputError(
            f"{path} does not say how large its pixels are, for it has no ModelPixelScale; give a GeoTIFF, or save its "
            "numbers by numpy.save and give {'file': ..., 'spacing': metres}"
        )
    model, unit = tags.get(MODEL_TYPE, PROJECTED), tags.get(UNIT, METRE)
    if int(model) != PROJECTED or int(unit) != METRE:
        raise InvalidInputError(
            f"{path} has pixels that are not in metres (GeoTIFF model {model:d}, unit {unit:d}); {IN_METRES}"
        )
    across, along = float(scale[0]), float(scale[1])
    if not (math.isfinite(across) and across > 0.0 and abs(along - across) <= SQUARE * across):
        raise InvalidInputError(
            f"{path} has pixels of {across:g} x {along:g} m, which are no squares; {IN_METRES}"
        )
    return across
