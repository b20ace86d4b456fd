"""A cluster of Ray does what processes of one machine do, and loses nothing where one of its machines is lost."""

import time
from concurrent.futures import Future

import pytest
from support.clusters import PATIENCE, alive, ray, two_machines, wait_until
from typer.testing import CliRunner

from dq_marine.cli.main import app
from dq_marine.errors import InvalidInputError
from dq_marine.report.leaderboard import Entry, Kept, Plan, fly_all
from dq_marine.util.cluster import ClusterPool, cluster_workers
from dq_marine.util.side_by_side import team_here

# Ray leaves sockets and files to be closed by the garbage collector, and warns of what it will change.
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]

ENTRIES = [
    Entry("dq_marine/StationKeeping-v0", "bluerov2_heavy", "easy", agent) for agent in ("zero", "controller")
]
PLAN = Plan(2, 7)


def fly(folder, team):
    return fly_all(
        ENTRIES, PLAN, Kept(folder / "board.json", PLAN, fresh=True), team=team, after=lambda _: None
    )


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
        with pytest.raises(ValueError, match=r"^3 is refused$"), cluster_workers(cluster.address, 1) as pool:
            pool.submit(failing, 3).result(PATIENCE)
        spread = fly(tmp_path, lambda _: cluster_workers(cluster.address, 1))
    assert spread == fly(tmp_path, team_here(1))


def test_a_worker_that_is_lost_again_and_again_is_told_of_in_words():
    class Lost:
        """Of Ray, what a pool calls: each task's worker is lost for good."""

        exceptions = ray.exceptions

        def remote(self, *arguments):
            return self

        def options(self, **options):
            return self

        def future(self):
            lost = Future()
            lost.set_exception(ray.exceptions.WorkerCrashedError())
            return lost

    future = ClusterPool(Lost()).submit(abs, -1)
    with pytest.raises(InvalidInputError, match=r"was lost 6 times, as where memory runs out: .*; let fewer"):
        future.result(PATIENCE)


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
