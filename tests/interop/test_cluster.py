"""A cluster of Ray does what processes of one machine do, and loses nothing where one of its machines is lost."""

import contextlib
import os
import time

import pytest
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError
from dq_marine.report.leaderboard import Entry, Kept, Plan, fly_all
from dq_marine.util.cluster import LOOPBACK, SILENCE, cluster_workers
from dq_marine.util.side_by_side import team_here

# Ray leaves sockets and files to be closed by the garbage collector, and warns of what it will change.
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]
os.environ.update(SILENCE | LOOPBACK)  # read when Ray is imported
pytest.importorskip("ray")

import ray  # noqa: E402
from ray.cluster_utils import Cluster  # noqa: E402

ENTRIES = [
    Entry("dq_marine/StationKeeping-v0", "bluerov2_heavy", "easy", agent) for agent in ("zero", "controller")
]
PLAN = Plan(2, 7)
PATIENCE = 900.0  # of a busy machine, to begin workers [s]


@contextlib.contextmanager
def two_machines():
    """A cluster of a head that does no work and two machines with a processor each."""
    cluster = Cluster(initialize_head=True, head_node_args={"num_cpus": 0, "include_dashboard": False})
    try:
        yield cluster, [cluster.add_node(num_cpus=1) for _ in range(2)]
    finally:
        cluster.shutdown()


def fly(folder, team):
    return fly_all(
        ENTRIES, PLAN, Kept(folder / "board.json", PLAN, fresh=True), team=team, after=lambda _: None
    )


def alive():
    """The machines that the cluster takes to be alive."""
    return {node["NodeID"] for node in ray.nodes() if node["Alive"]}


def wait_until(holds):
    """Return when `holds` does, which a busy machine may need minutes for."""
    end = time.monotonic() + PATIENCE
    while not holds():
        assert time.monotonic() < end, "what was waited for did not come"
        time.sleep(0.1)


def test_nothing_is_lost_where_a_machine_is_killed_in_the_middle(tmp_path):
    begun, go = tmp_path / "begun", tmp_path / "go"
    begun.mkdir()

    # Functions of this file, which is on no machine's path, travel whole where they are no globals.
    def square(number):
        here = ray.get_runtime_context().get_node_id()
        (begun / here).touch()
        while not go.exists():
            time.sleep(0.1)
        return number * number, here

    def failing(number):
        raise ValueError(f"{number} is refused")

    numbers = range(6)
    with two_machines() as (cluster, (lost, left)):
        with cluster_workers(cluster.address, 1) as pool:
            asked = [pool.submit(square, number) for number in numbers]
            wait_until(lambda: {path.name for path in begun.iterdir()} == {lost.node_id, left.node_id})
            cluster.remove_node(lost, allow_graceful=False)
            wait_until(lambda: lost.node_id not in alive())
            go.touch()
            results = [one.result(PATIENCE) for one in asked]
        assert results == [(number * number, left.node_id) for number in numbers]
        # An error of a task is the caller's, and what flies on the machine that is left flies as it does here.
        with pytest.raises(ValueError, match="3 is refused"), cluster_workers(cluster.address, 1) as pool:
            pool.submit(failing, 3).result(PATIENCE)
        spread = fly(tmp_path, lambda _: cluster_workers(cluster.address, 1))
    assert spread == fly(tmp_path, team_here(1))


def test_a_cluster_that_is_not_there_is_refused_in_words():
    with (
        pytest.raises(
            InvalidInputError, match=r"no cluster of Ray answers at 127\.0\.0\.1:1.*ray start --head"
        ),
        cluster_workers("127.0.0.1:1", 1),
    ):
        pass


def test_the_command_begins_a_cluster_of_its_own(tmp_path):
    asked = ["leaderboard", "--task", "StationKeeping", "--vehicle", "bluerov2_heavy", "--agent", "zero"]
    out = tmp_path / "board.md"
    asked += ["--episodes", "1", "--out", str(out)]
    done = CliRunner().invoke(app, [*asked, "--distributed", "--processes", "1"])
    assert done.exit_code == 0, done.output
    assert "StationKeeping" in out.read_text(encoding="utf-8")
