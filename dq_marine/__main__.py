"""`python -m dq_marine`: the command `dq-marine`."""

from __future__ import annotations

from dq_marine.cli.main import app

if __name__ == "__main__":
    app(prog_name="dq-marine")
