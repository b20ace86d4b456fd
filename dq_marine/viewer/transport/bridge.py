"""meshcat's bridge from ZeroMQ to web pages, imported by itself, in the server's own process.

`import meshcat` would load IPython and all else that meshcat is, which takes longer than what a server needs.
"""

from __future__ import annotations

import importlib.util
import sys

_specification = importlib.util.find_spec("meshcat")
if _specification is not None:
    sys.modules.setdefault("meshcat", importlib.util.module_from_spec(_specification))  # known, but not run

from meshcat.servers.zmqserver import (  # noqa: E402 - in the package that has just been made
    MESHCAT_COMMANDS,
    StaticFileHandlerNoCache,
    WebSocketHandler,
    ZMQWebSocketBridge,
)

__all__ = ["MESHCAT_COMMANDS", "StaticFileHandlerNoCache", "WebSocketHandler", "ZMQWebSocketBridge"]
