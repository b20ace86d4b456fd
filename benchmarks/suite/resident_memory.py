"""One process that holds many environments; run by `memory`, in a process of its own.

Run, in the folder `benchmarks`: python -m suite.resident_memory NUMBER
"""

from __future__ import annotations

import gc
import json
import os
import subprocess
import sys
from pathlib import Path

STATUS = Path("/proc/self/status")


def resident_bytes() -> int:
    """Return the memory of this process that is in RAM."""
    if STATUS.exists():
        line = next(line for line in STATUS.read_text().splitlines() if line.startswith("VmRSS"))
        return int(line.split()[1]) * 1024
    said = subprocess.run(
        ["ps", "-o", "rss=", "-p", str(os.getpid())], capture_output=True, text=True, check=True
    )
    return int(said.stdout) * 1024


def main() -> None:
    """Hold environments under way; tell by how much the process grew, compiled code and imports aside."""
    from suite.environments import marine, random_actions

    number = int(sys.argv[1])
    few = marine(64)
    few.reset(seed=0)
    few.step(random_actions((64, 6))[0])
    actions = random_actions((number, 6))
    gc.collect()
    before = resident_bytes()
    envs = marine(number)
    envs.reset(seed=0)
    for action in actions:
        envs.step(action)
    gc.collect()
    print(json.dumps({"before": before, "after": resident_bytes()}))


if __name__ == "__main__":
    main()
