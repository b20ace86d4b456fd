"""Scenes: what they compute, what they leave out, what they refuse."""

import numpy as np
import pytest

from dq_marine.errors import InvalidInputError
from dq_marine.simulation.scene import Scene
from dq_marine.vehicles import load_vehicle


def changed(**changes):
    """BlueROV2 Heavy with some of its file's entries replaced."""
    content = load_vehicle("bluerov2_heavy").model_dump()
    for path, value in changes.items():
        table, _, key = path.partition("__")
        if key:
            content[table] = content[table] | {key: value}
        else:
            content[table] = value
    return type(load_vehicle("bluerov2_heavy")).model_validate(content)


ZERO6 = (0.0,) * 6


@pytest.mark.parametrize(
    ("vehicle", "current", "terms"),
    [
        (
            changed(),
            (0.3, 0.0, 0.0),
            (
                "net weight",
                "righting moment",
                "diagonal linear and quadratic damping",
                "damping couplings",
                "current",
            ),
        ),
        (
            changed(buoyancy__volume=0.0135, damping__couplings=()),
            (0, 0, 0),
            ("righting moment", "diagonal linear and quadratic damping"),
        ),
        (
            changed(
                buoyancy__volume=0.0135,
                buoyancy__center=(0.0, 0.0, 0.0),
                damping__couplings=(),
                damping__quadratic=ZERO6,
            ),
            (0, 0, 0),
            ("linear damping",),
        ),
        (
            changed(
                buoyancy__volume=0.0135,
                buoyancy__center=(0.0, 0.0, 0.0),
                damping__couplings=(),
                damping__quadratic=ZERO6,
                damping__linear=ZERO6,
            ),
            (0, 0, 0),
            (),
        ),
    ],
)
def test_a_scene_computes_what_it_has(vehicle, current, terms):
    scene = Scene(vehicle, current=current)
    assert scene.terms == terms
    assert len(scene.composition.pose_forces) == sum("weight" in t or "moment" in t for t in terms)
    assert all(term in repr(scene) for term in terms)
    body = scene.stepper()
    body.step((1.0, 0.0, 0.0, 0.0, 0.0, 0.0), 3)
    assert np.isfinite(body.get_state()).all()


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"current": (1.0, 2.0)}, "shape"),
        ({"current": (np.nan, 0.0, 0.0)}, "not finite"),
        ({"scheme": "euler"}, r"euler.*midpoint"),
        ({"step": 0.0}, "step = 0"),
        ({"step": float("nan")}, "step = nan"),
        ({"step": 2.0}, r"h omega.*below 2.*step"),
        ({"vehicle": "titanic"}, "bluerov2_heavy"),
    ],
)
def test_wrong_scenes_are_refused(arguments, message):
    with pytest.raises(InvalidInputError, match=message):
        Scene(**arguments)


def test_the_restoring_limit_is_where_it_is_said_to_be():
    """Roll of a neutral undamped body: bounded for h omega = 1.99, not for 2.01."""
    vehicle = changed(
        buoyancy__volume=0.0135,
        damping__quadratic=ZERO6,
        damping__linear=ZERO6,
        buoyancy__center=(0.0, 0.0, -0.01),
    )
    roll, pitch = np.sort(Scene(vehicle).restoring_frequencies)
    arm = vehicle.restoring_arm[2]
    m = vehicle.mass_matrix
    assert roll == pytest.approx(np.sqrt(arm / m[3, 3]), rel=1e-12)
    assert pitch == pytest.approx(np.sqrt(arm / m[4, 4]), rel=1e-12)
    Scene(vehicle, step=1.99 / pitch)
    with pytest.raises(InvalidInputError, match="must stay below 2"):
        Scene(vehicle, step=2.01 / pitch)
    bounded = Scene(vehicle, step=1.99 / pitch).stepper()
    bounded.reset(quaternion_body_to_ned=(np.cos(5e-7), 0.0, np.sin(5e-7), 0.0))
    largest = 0.0
    for _ in range(2000):
        bounded.step()
        largest = max(largest, abs(bounded.quaternion_body_to_ned[2]))
    assert largest < 2e-5


def test_free_roll_has_the_natural_period():
    vehicle = changed(buoyancy__volume=0.0135, damping__quadratic=ZERO6, damping__linear=ZERO6)
    scene = Scene(vehicle, step=0.001)
    body = scene.stepper()
    angle = 0.01
    body.reset(quaternion_body_to_ned=(np.cos(angle / 2), np.sin(angle / 2), 0.0, 0.0))
    crossings, previous = [], angle
    while len(crossings) < 3:
        body.step()
        now = body.quaternion_body_to_ned[1]
        if previous > 0.0 >= now or previous < 0.0 <= now:
            crossings.append(body.time)
        previous = now
    period = 2.0 * np.pi / np.sort(scene.restoring_frequencies)[0]
    assert crossings[2] - crossings[0] == pytest.approx(period, rel=2e-3)
