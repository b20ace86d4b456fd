"""An episode at its start, as arrays that compiled code reads and changes."""

from __future__ import annotations

import numpy as np

from dq_marine.backend.packing import pack
from dq_marine.envs.core.episode import Episode
from dq_marine.integrator.step import Composition, StepParameters
from dq_marine.task.episode import EpisodeParameters, EpisodeTask
from dq_marine.task.start import Drawn, make_beginning


def begun_episode(
    composition: Composition,
    task: EpisodeTask,
    parameters: StepParameters,
    episode_parameters: EpisodeParameters,
    drawn: Drawn,
    number: int,
    action_size: int,
) -> Episode:
    """Return an episode at its start, by the same formulas that run compiled.

    Args:
        composition: what is integrated.
        task: of the environment.
        parameters: of the vehicle's step.
        episode_parameters: of the task, the reward and the sensors.
        drawn: what the episode begins with.
        number: of the vehicle in the pool.
        action_size: how many numbers an action has.
    """
    begun = make_beginning(composition, task)(parameters, episode_parameters, drawn)
    return Episode(
        parameters=pack(parameters._replace(water=begun.water)),
        episode_parameters=pack(episode_parameters),
        state=pack(begun.state),
        memory=pack(begun.memory),
        action=np.zeros(action_size),
        observation=pack(begun.observation).astype(np.float32),
        report=pack((begun.report, begun.current_ned)),
        vehicle=number,
    )
