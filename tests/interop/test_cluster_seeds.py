"""Seeds trained on a cluster: a machine is lost in the middle, and nothing that was learned with it."""

import io
import os
import signal
from pathlib import Path

import pytest
from rich.console import Console
from support.clusters import alive, two_machines, wait_until
from support.sweeps import sweep
from support.trainings import tiny

from dq_marine.agents.seeds import training
from dq_marine.agents.seeds.seeds_folder import SeedsFolder
from dq_marine.agents.seeds.training import by_team, one_after_the_other, train_seeds
from dq_marine.agents.training.run_folder import LOCK_FILE
from dq_marine.util.cluster import cluster_workers

pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore")]  # of Ray's own sockets and warnings

SEEDS = range(3)
NEVER = 1_000_000  # timesteps between checkpoints, where there are none


def numbers(results):
    """What a result is but for how long it took."""
    return {one.seed: (one.timesteps, one.mean_return, one.success_rate, one.metrics) for one in results}


def trained_by(folder, seed):
    """The process that trains a seed, None before it has begun to learn."""
    run = folder.run(seed)
    if not list(run.tensorboard.rglob("events*")):
        return None
    return int((run.path / LOCK_FILE).read_text() or 0) or None


def machine_of(process, machines):
    """The machine, all of which are this one, whose raylet is a parent of a process."""
    while process > 1:
        for machine in machines:
            if process in {one.process.pid for kind in machine.all_processes.values() for one in kind}:
                return machine
        process = int(Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()[1])
    raise AssertionError("it is of no machine")


@pytest.mark.skipif(not Path("/proc/self/stat").exists(), reason="/proc tells whose child a process is")
@pytest.mark.parametrize("checkpoint_every", sweep([64, NEVER], plain=[64]))  # it goes on, or begins anew
def test_nothing_is_lost_where_a_machine_is_killed_in_the_middle(tmp_path, monkeypatch, checkpoint_every):
    settings = tiny(tmp_path, "ppo", 1024).model_copy(update={"checkpoint_every": checkpoint_every})
    folder, console = SeedsFolder(tmp_path / "spread"), Console(file=io.StringIO())
    kept = []

    with two_machines() as (cluster, machines):

        def kill_in_the_middle():
            wait_until(lambda: trained_by(folder, 0) is not None, every=0.01)
            if checkpoint_every != NEVER:
                wait_until(lambda: folder.run(0).latest("checkpoints") is not None, every=0.01)
            process = trained_by(folder, 0)
            os.kill(process, signal.SIGSTOP)  # so that it does not end meanwhile
            kept.append(folder.run(0).progress("checkpoints").timesteps)
            lost = machine_of(process, machines)
            cluster.remove_node(lost, allow_graceful=False)
            os.kill(process, signal.SIGKILL)
            wait_until(lambda: lost.node_id not in alive())

        gathered = training._gathered

        def gathered_meanwhile(*arguments):
            kill_in_the_middle()
            return gathered(*arguments)

        monkeypatch.setattr(training, "_gathered", gathered_meanwhile)
        team = by_team(lambda tasks: cluster_workers(cluster.address, 1))
        spread = train_seeds(folder, settings, SEEDS, way=team, console=console)
    here = SeedsFolder(tmp_path / "here")
    undisturbed = train_seeds(here, settings, SEEDS, way=one_after_the_other, console=console)
    assert [one.seed for one in spread] == list(SEEDS)
    found, expected = numbers(spread), numbers(undisturbed)
    if checkpoint_every == NEVER:
        assert kept == [0]
        assert found == expected
    else:  # a run that goes on from a checkpoint draws other numbers than one that was not stopped
        assert 0 < kept[0] < 1024
        assert found.pop(0)[0] == expected.pop(0)[0] == 1024
        assert found == expected
        assert len(list(folder.run(0).tensorboard.rglob("events*"))) == 2
