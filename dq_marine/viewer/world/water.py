"""The water itself: its colours, its light, and the murk in which far things vanish."""

from __future__ import annotations

from dataclasses import dataclass, replace

from dq_marine.viewer.placement import Placement, Vector3
from dq_marine.viewer.snapshot import Shape
from dq_marine.viewer.transport.messages import Message, set_object, set_property
from dq_marine.viewer.transport.three_json import Json, bare_object, rgb

Color = tuple[float, float, float]
"""Red, green, blue, within [0, 1]."""


@dataclass(frozen=True)
class Surroundings:
    """Colours of what is around the vehicle.

    Attributes:
        above: at the upper edge of the picture.
        below: at its lower edge.
        murk: what far things fade into: the colour about the horizon.
        surface: of the sea's surface, 0xRRGGBB.
        surface_opacity: 1 hides what is behind it.
        surface_patches: how much lighter and darker than its colour it is in places.
        specks: whether specks hang in the water.
    """

    above: Color
    below: Color
    murk: Color
    surface: int
    surface_opacity: float
    surface_patches: float
    specks: bool


UNDER_WATER = Surroundings(
    above=(0.128, 0.500, 0.608),
    below=(0.085, 0.410, 0.525),
    murk=(0.115, 0.473, 0.583),
    surface=0x8FCFDF,
    surface_opacity=0.25,
    surface_patches=0.2,
    specks=True,
)
ON_THE_SURFACE = Surroundings(
    above=(0.49, 0.70, 0.87),
    below=(0.80, 0.89, 0.94),
    murk=(0.70, 0.83, 0.91),
    surface=0x2C7391,
    surface_opacity=0.8,
    surface_patches=0.05,
    specks=False,
)


SEEN_THROUGH = 0.55
"""Opacity of the surface from above where the vehicle is below it."""

COVERING = 0.5
"""Opacity from which the surface is drawn before other things that can be seen through, which it must not cover."""


def surroundings_of(shape: Shape) -> Surroundings:
    """The surroundings that a vehicle is at home in."""
    return ON_THE_SURFACE if shape.floats else UNDER_WATER


def both_sides(shape: Shape) -> Json:
    """What is around on either side of the surface, for the page, which knows on which side the camera is."""
    air = ON_THE_SURFACE if shape.floats else replace(ON_THE_SURFACE, surface_opacity=SEEN_THROUGH)
    return {"above": _side(air), "below": _side(UNDER_WATER)}


def _side(colors: Surroundings) -> Json:
    return {
        "top": list(colors.above),
        "bottom": list(colors.below),
        "murk": dict(zip("rgb", colors.murk, strict=True)),
        "tint": rgb(colors.surface).tolist(),
        "opacity": colors.surface_opacity,
        "order": render_order(colors),
    }


def render_order(colors: Surroundings) -> int:
    """Return when the surface is drawn: see `COVERING`."""
    return -1 if colors.surface_opacity > COVERING else 0


MESHCAT_SCENERY = (
    "/Grid",
    "/Axes",
    "/Lights/SpotLight",
    "/Lights/PointLightNegativeX",
    "/Lights/PointLightPositiveX",
    "/Lights/AmbientLight",
    "/Lights/FillLight",
)
SUN = "/Lights/sun"


def draw_water(colors: Surroundings, sight: float) -> list[Message]:
    """Colours, light and murk, in place of the scenery that meshcat starts with.

    Args:
        colors: of the surroundings.
        sight: distance at which things vanish [m].
    """
    return [
        *(set_property(path, "visible", False) for path in MESHCAT_SCENERY),
        set_property("/Background", "top_color", list(colors.above)),
        set_property("/Background", "bottom_color", list(colors.below)),
        set_property("", "fog", _murk(colors.murk, sight)),
        set_object("/Lights/sky", _sky()),
        set_object(SUN, _sun()),
        # meshcat lets all that it is given cast shadows. The sun's would fall on what is within 5 m of the origin
        # alone, and take a quarter of a picture's time without a graphics card.
        set_property(f"{SUN}/<object>", "castShadow", False),
    ]


def _murk(murk: Color, sight: float) -> Json:
    """What three.js calls fog; meshcat hands a property to it as it is."""
    color = dict(zip("rgb", murk, strict=True))
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
