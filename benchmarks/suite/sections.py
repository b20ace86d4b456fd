"""All sections, in the order in which they are measured and stand on the page."""

from __future__ import annotations

from suite import (
    baseline,
    batch,
    compile_times,
    endurance,
    environments,
    lanes_against_rk4,
    lift_and_memory,
    memory,
    one_body,
    ppo,
    schemes,
    tasks,
    terms,
    viewer,
    water,
)
from suite.plan import Section

SECTIONS: dict[str, Section] = {
    module.SECTION.name: module.SECTION
    for module in (
        one_body,
        terms,
        water,
        lift_and_memory,
        batch,
        lanes_against_rk4,
        environments,
        tasks,
        schemes,
        baseline,
        ppo,
        compile_times,
        memory,
        endurance,
        viewer,
    )
}
"""By name."""
