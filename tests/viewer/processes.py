"""What the operating system knows about processes and their sockets (Linux)."""

from __future__ import annotations

import os
import time
from pathlib import Path

LISTENING = "0A"


def alive(pid: int) -> bool:
    """Whether a process exists and has not just ended without its parent having noticed."""
    try:
        state = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[0]
    except (FileNotFoundError, ProcessLookupError):
        return False
    return state != "Z"


def wait_for_end(pid: int, patience: float = 120.0) -> bool:
    """Whether a process ends soon."""
    deadline = time.monotonic() + patience
    while alive(pid):
        if time.monotonic() > deadline:
            return False
        time.sleep(0.02)
    return True


def group_members(group: int) -> list[int]:
    """Processes alive in a process group."""
    members = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit() and alive(int(entry.name)):
            try:
                if os.getpgid(int(entry.name)) == group:
                    members.append(int(entry.name))
            except ProcessLookupError:
                continue
    return members


def listening_addresses(pid: int) -> list[str]:
    """Local addresses, as in /proc/net, of all sockets on which a process listens."""
    descriptors = Path(f"/proc/{pid}/fd").iterdir()
    inodes = {os.readlink(entry) for entry in descriptors}
    found = []
    for table in ("/proc/net/tcp", "/proc/net/tcp6"):
        for line in Path(table).read_text().splitlines()[1:]:
            fields = line.split()
            if fields[3] == LISTENING and f"socket:[{fields[9]}]" in inodes:
                found.append(fields[1].split(":")[0])
    return found
