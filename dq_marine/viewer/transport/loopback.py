"""Where server and pages meet: on this computer only."""

from __future__ import annotations

LOOPBACK = "127.0.0.1"
