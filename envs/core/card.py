"""What a notebook shows of an environment: a table of what it is, and its live page where one is open."""

from __future__ import annotations

import html
from collections.abc import Iterator

from dq_marine.envs.core.composed_task import ComposedTask
from dq_marine.viewer.framed import framed_address

ROW = '<tr><th style="text-align: left">{}</th><td style="text-align: left">{}</td></tr>'


def card(task: ComposedTask, url: str | None) -> str:
    """Return HTML.

    Args:
        task: what is shown.
        url: of its live page, if it has one.
    """
    rows = "".join(ROW.format(html.escape(name), html.escape(value)) for name, value in _rows(task))
    return f"<table>{rows}</table>" + ("" if url is None else framed_address(url))


def _rows(task: ComposedTask) -> Iterator[tuple[str, str]]:
    settings = task.settings
    yield "environment", task.definition.id
    yield "vehicle", task.vehicle.name
    yield "action", ", ".join(task.action_names)
    yield "observation", ", ".join(f"{one.size} x {one.name} [{one.unit or 1}]" for one in task.observations)
    yield "reward", ", ".join(task.reward_names)
    yield "control period", f"{task.control_period:g} s in {task.substeps} steps"
    yield "integrator", f"{settings.scheme}, order {settings.order}"
    yield "terms", ", ".join(task.scene.terms)
