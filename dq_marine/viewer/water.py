"""The water itself: its colours, its light, and the murk in which far things vanish."""

from __future__ import annotations

from dq_marine.viewer.messages import Command, set_object, set_property
from dq_marine.viewer.placement import Placement, Vector3
from dq_marine.viewer.three_json import Json, bare_object

WATER_ABOVE = (0.128, 0.500, 0.608)
WATER_BELOW = (0.085, 0.410, 0.525)
"""Red, green, blue at the upper and lower edge of the picture."""

MURK = (0.115, 0.473, 0.583)
"""The colour that far things fade into: that of the water about the horizon."""

MESHCAT_SCENERY = (
    "/Grid",
    "/Axes",
    "/Lights/SpotLight",
    "/Lights/PointLightNegativeX",
    "/Lights/PointLightPositiveX",
    "/Lights/AmbientLight",
    "/Lights/FillLight",
)


def draw_water(sight: float) -> list[Command]:
    """Colours, light and murk, in place of the scenery that meshcat starts with.

    Args:
        sight: distance at which things vanish [m].
    """
    return [
        *(set_property(path, "visible", False) for path in MESHCAT_SCENERY),
        set_property("/Background", "top_color", list(WATER_ABOVE)),
        set_property("/Background", "bottom_color", list(WATER_BELOW)),
        set_property("", "fog", _murk(sight)),
        set_object("/Lights/sky", _sky()),
        set_object("/Lights/sun", _sun()),
    ]


def _murk(sight: float) -> Json:
    """What three.js calls fog; meshcat hands a property to it as it is."""
    color = dict(zip("rgb", MURK, strict=True))
    return {"isFog": True, "name": "murk", "color": color, "near": 0.08 * sight, "far": sight}


def _sky() -> Json:
    """Blue light from above, sandy light from below."""
    return bare_object(
        "HemisphereLight",
        color=0xDDF6FF,
        groundColor=0x8C9C92,
        intensity=0.8,
        matrix=_shining_from((0.0, 0.0, 1.0)),
    )


def _sun() -> Json:
    return bare_object(
        "DirectionalLight",
        color=0xFFF6DC,
        intensity=0.6,
        matrix=_shining_from((-0.5, 0.6, 1.4)),
    )


def _shining_from(place: Vector3) -> list[float]:
    """A place in meshcat's own frame, z up; only its direction matters."""
    return Placement(place).matrix_by_columns()
