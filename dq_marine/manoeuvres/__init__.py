"""Standard manoeuvres: turning circle, zig-zag, spiral, acceleration, stopping, free decay."""

from dq_marine.manoeuvres.acceleration import Acceleration, acceleration
from dq_marine.manoeuvres.conditions import Conditions
from dq_marine.manoeuvres.decay import Decay, decay
from dq_marine.manoeuvres.quantities import Quantity, Result
from dq_marine.manoeuvres.series import Series
from dq_marine.manoeuvres.spiral import Spiral, spiral
from dq_marine.manoeuvres.stopping import Stopping, stopping
from dq_marine.manoeuvres.turning_circle import TurningCircle, turning_circle
from dq_marine.manoeuvres.zig_zag import ZigZag, zig_zag

__all__ = [
    "Acceleration",
    "Conditions",
    "Decay",
    "Quantity",
    "Result",
    "Series",
    "Spiral",
    "Stopping",
    "TurningCircle",
    "ZigZag",
    "acceleration",
    "decay",
    "spiral",
    "stopping",
    "turning_circle",
    "zig_zag",
]
