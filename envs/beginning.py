"""An episode at its start, as arrays that compiled code reads and changes."""

from __future__ import annotations

from typing import Any

import numpy as np

from dq_marine.engines.packing import pack
from dq_marine.envs.episode import Episode
from dq_marine.kernel.beginning import Drawn, make_beginning
from dq_marine.kernel.step import Composition, StepParameters
from dq_marine.kernel.task import Task


def begun_episode(
    composition: Composition,
    task: Task,
    parameters: StepParameters,
    aim: Any,
    drawn: Drawn,
    number: int,
    action_size: int,
) -> Episode:
    """Return an episode at its start, by the same formulas that run compiled.

    Args:
        composition: what is integrated.
        task: of the environment.
        parameters: of the vehicle's step.
        aim: the task's parameters.
        drawn: what the episode begins with.
        number: of the vehicle in the pool.
        action_size: how many numbers an action has.
    """
    begun = make_beginning(composition, task)(parameters, aim, drawn)
    return Episode(
        parameters=pack(parameters._replace(water=begun.water)),
        aim=pack(aim),
        state=pack(begun.state),
        memory=pack(begun.memory),
        action=np.zeros(action_size),
        observation=pack(begun.observation).astype(np.float32),
        measures=pack(begun.measures),
        current_ned=np.array(composition.water.velocity(begun.water, begun.state.pose)),
        vehicle=number,
    )
