"""What an environment says of a control period that the integrator refused."""

from __future__ import annotations

import math
from typing import Any

from dq_marine.integrator.step import REFUSALS


def integration_report(
    step: float,
    status: int,
    completed: int,
    residual_squared: float,
    spin_squared: float,
    speed_squared: float,
) -> dict[str, Any]:
    """Return `info["integration"]`: why a step [s] was refused, and with which velocity over ground."""
    return {
        "refused": REFUSALS[status],
        "residual": math.sqrt(residual_squared) if math.isfinite(residual_squared) else None,
        "completed_substeps": completed,
        "step_times_spin": step * math.sqrt(spin_squared),
        "step_times_speed": step * math.sqrt(speed_squared),
    }
