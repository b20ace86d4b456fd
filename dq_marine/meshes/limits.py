"""What the numbers of a vehicle from a mesh hold for."""

from __future__ import annotations

import math
from typing import Any

from dq_marine.meshes.choices import Choices
from dq_marine.meshes.drag import Form
from dq_marine.meshes.hull import Hull
from dq_marine.meshes.rounding import rounded

LARGEST_OF = 1000
"""Waves, of which the largest is neither to wet the deck nor to bare the keel."""


def validity(hull: Hull, choices: Choices, form: Form) -> dict[str, Any]:
    """Return the table `validity` of a file: limits of the estimates, and why others have none."""
    given = "given" if choices.speed is not None else "a design speed by the size of the hull"
    limits: dict[str, Any] = {
        "speed": rounded(form.speed),
        "source": f"drag is estimated for this speed, {given}; no trial is known",
        "drift_angle_source": "drag across is of strips in a flow straight across, and drag ahead apart from it, "
        "so in between it is their sum, an assumption; there is no lift",
    }
    if hull.draft is None:
        return limits | {
            "wave_height_source": "the forces of waves are of the first order, on a hull that stays submerged, by "
            "waves longer than some five times its width and height"
        }
    freeboard = float(hull.surface.extent[2]) - hull.draft
    return limits | {
        "wave_height": rounded(2.0 * min(hull.draft, freeboard) / largest_over_significant()),
        "wave_height_source": f"an estimate: the largest of {LARGEST_OF} waves (Longuet-Higgins 1952) neither wets "
        "the deck nor bares the keel of a hull that lies still; restoring and wave forces are linear",
    }


def largest_over_significant() -> float:
    """Return the height of the largest of so many waves over the significant one (Longuet-Higgins 1952)."""
    return math.sqrt(0.5 * math.log(LARGEST_OF))
