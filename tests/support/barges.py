"""Boxes that float, and exact hydrostatics of a box by clipping, written separately from the product."""

from __future__ import annotations

import numpy as np

from dq_marine.vehicles import Vehicle

GRAVITY, DENSITY = 9.81, 1000.0
LENGTH, WIDTH, HEIGHT = 2.0, 1.0, 0.8


def barge(draft=0.35, center_of_mass=(0.0, 0.0, 0.0), cells=None, floats=True, added=0.5, damping=0.0):
    """A box with its middle at the body origin that floats at a draft [m].

    Args:
        draft: submerged height at rest [m].
        center_of_mass: [m].
        cells: of the hull.
        floats: whether its file has [hydrostatics]; without, it may be unstable.
        added: added mass over mass.
        damping: linear, over mass and inertia [1/s].
    """
    mass = DENSITY * LENGTH * WIDTH * draft
    inertia = mass / 12.0 * np.array([WIDTH**2 + HEIGHT**2, LENGTH**2 + HEIGHT**2, LENGTH**2 + WIDTH**2])
    sizes = np.array([mass, mass, mass, *inertia])
    content = {
        "name": "barge",
        "description": "a box",
        "sources": ["a test"],
        "rigid_body": {
            "mass": mass,
            "center_of_mass": center_of_mass,
            "inertia": inertia.tolist(),
            "inertia_about": "center_of_mass",
        },
        "buoyancy": {
            "volume": LENGTH * WIDTH * (draft if floats else HEIGHT),
            "center": (0.0, 0.0, 0.5 * (HEIGHT - draft)),
            "water_density": DENSITY,
        },
        "added_mass": (added * sizes).tolist(),
        "damping": {"linear": (damping * sizes).tolist()},
        "limits": {"wrench": (100.0, 0.0, 0.0, 0.0, 0.0, 0.0)},
        "dimensions": {"length": LENGTH, "width": WIDTH, "height": HEIGHT, "shape": "ship"},
        "hull": [{"position": (0.0, 0.0, 0.0), "size": (LENGTH, WIDTH, HEIGHT), "cells": cells}],
    }
    if floats:
        below = mass * GRAVITY * (center_of_mass[2] - 0.5 * (HEIGHT - draft))
        content["hydrostatics"] = {
            "equilibrium_depth": draft - 0.5 * HEIGHT,
            "stiffness": (
                DENSITY * GRAVITY * LENGTH * WIDTH,
                DENSITY * GRAVITY * LENGTH * WIDTH**3 / 12.0 + below,
                DENSITY * GRAVITY * WIDTH * LENGTH**3 / 12.0 + below,
            ),
        }
    return Vehicle.model_validate(content)


def clipped(angle, depth):
    """Area and centroid (starboard, down; world axes about the middle) of a heeled section's part under water."""
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    corners = (
        0.5 * np.array([[-WIDTH, -HEIGHT], [WIDTH, -HEIGHT], [WIDTH, HEIGHT], [-WIDTH, HEIGHT]]) @ turn.T
    )
    kept = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        above_a, above_b = a[1] + depth, b[1] + depth
        if above_a >= 0.0:
            kept.append(a)
        if above_a * above_b < 0.0:
            kept.append(a + (b - a) * above_a / (above_a - above_b))
    if len(kept) < 3:
        return 0.0, np.zeros(2)
    p, q = np.array(kept), np.roll(kept, -1, axis=0)
    cross = p[:, 0] * q[:, 1] - q[:, 0] * p[:, 1]
    area = 0.5 * cross.sum()
    return area, ((p + q) * cross[:, None]).sum(axis=0) / (6.0 * area)
