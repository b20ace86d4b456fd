"""Starts the viewer's server, run as a file: without what the server does not need.

`python -m dq_marine.viewer.transport.server` does the same in four times the time: it first runs the packages that the
server is in, which import NumPy, Gymnasium and all else that they offer, and meshcat, which imports IPython.
"""

from __future__ import annotations

import importlib.util
import sys


def known_but_not_run(package: str) -> None:
    """Make a package known, so that what is in it can be imported while the package itself is not run."""
    specification = importlib.util.find_spec(package)
    if specification is not None:
        sys.modules.setdefault(package, importlib.util.module_from_spec(specification))


if __name__ == "__main__":
    for package in ("dq_marine", "dq_marine.viewer", "meshcat"):
        known_but_not_run(package)
    from dq_marine.viewer.transport.server import main

    main()
