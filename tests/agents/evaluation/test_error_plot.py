"""The picture of a flight: angles that go round are not drawn across it, and limits have their units."""

import numpy as np
import pytest

import dq_marine  # noqa: F401 - registers
from dq_marine.agents.evaluation import error_plot
from dq_marine.agents.evaluation.episodes import Episode
from dq_marine.agents.evaluation.metrics import Metric, metrics_of
from dq_marine.envs.core.registry import registered_tasks


@pytest.fixture
def drawn(monkeypatch, tmp_path):
    """Draw an episode and return its axes, the metrics' first."""
    figures = []
    monkeypatch.setattr(error_plot, "save_figure", lambda figure, path: figures.append(figure))

    def draw(*metrics, **measured):
        count = len(next(iter(measured.values())))
        episode = Episode(
            time=np.arange(count) * 0.1,
            metrics=metrics,
            measured=measured,
            actions=np.zeros((count - 1, 1)),
            action_names=("surge",),
            rewards=np.zeros(count - 1),
            reward_terms={},
            success=True,
            ended_early=False,
        )
        error_plot.save_plot(episode, tmp_path / "plot.png", title="")
        return figures[-1].axes

    return draw


def steps_of(axes):
    """The steps of an axes' first line; NaN beside a gap."""
    return np.abs(np.diff(axes.lines[0].get_ydata()))


def test_an_angle_that_goes_round_leaves_a_gap(drawn):
    turned = np.linspace(-1.0, 9.0, 101)
    wrapped = np.arctan2(np.sin(turned), np.cos(turned))
    (axes, _) = drawn(Metric("heading_error", "rad"), heading_error=wrapped)
    shown = axes.lines[0].get_ydata()
    assert np.isnan(shown).sum() == 1
    assert np.nanmax(steps_of(axes)) < 10.0
    assert shown[~np.isnan(shown)] == pytest.approx(np.degrees(wrapped))


def test_a_length_that_jumps_is_drawn_as_it_is(drawn):
    (axes, _) = drawn(Metric("distance", "m"), distance=np.array([500.0, 0.0, 500.0]))
    assert axes.lines[0].get_ydata() == pytest.approx([500.0, 0.0, 500.0])


@pytest.mark.parametrize(
    ("metric", "text"),
    [
        (Metric("depth_error", "m", 0.05), "settled: 0.05 m"),
        (Metric("tilt", "rad", 0.05), "settled: 2.8648 deg"),
    ],
)
def test_a_limit_has_its_unit(drawn, metric, text):
    axes = drawn(metric, **{metric.name: np.linspace(1.0, 0.0, 11)})[0]
    (written,) = (one.get_text() for one in axes.texts)
    assert written.split()[:1] == ["settled:"]
    assert float(written.split()[1]) == pytest.approx(float(text.split()[1]), rel=1e-4)
    assert written.split()[2] == text.split()[2]


@pytest.mark.parametrize("task", registered_tasks(), ids=lambda task: task.id)
def test_every_metric_with_a_limit_has_a_unit(task):
    for metric in metrics_of(task):
        assert metric.tolerance is None or metric.unit, metric.name
