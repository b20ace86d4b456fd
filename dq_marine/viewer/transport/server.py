"""The viewer's server: meshcat's bridge from ZeroMQ to web pages, for this computer only.

It runs as a process of its own, `python -m dq_marine.viewer.transport.server`, prints one line of JSON with its
two addresses, and ends when its standard input does, that is, when its parent is gone.

meshcat's own server listens on every network interface. This one listens on the loopback address,
on free ports, and answers only requests that name the loopback host; a page from elsewhere can
neither reach it by a rebound name nor open its websocket.
"""

from __future__ import annotations

import json
import os
import sys
from typing import Any

import tornado.httpserver
import tornado.ioloop
import tornado.netutil
import tornado.routing
import tornado.web
import zmq
from meshcat.servers.zmqserver import StaticFileHandlerNoCache, WebSocketHandler, ZMQWebSocketBridge
from zmq.eventloop.zmqstream import ZMQStream

from dq_marine.viewer.libraries import meshcat_page_folder
from dq_marine.viewer.transport.pages import CAPTURE_PAGE, LIVE_PAGE

LOOPBACK = "127.0.0.1"
LOOPBACK_NAMES = r"^(127\.0\.0\.1|localhost)$"
ANY_FREE_PORT = 0
LARGEST_MESSAGE = 256 * 2**20
"""Bytes in a message from a page; a picture of 8000 x 8000 pixels fits in."""


class PageHandler(tornado.web.RequestHandler):
    """Serves one of the viewer's own pages."""

    def initialize(self, page: str) -> None:
        """Called by tornado for each request, with the page of this address."""
        self._page = page

    def get(self) -> None:
        """Answer with the page."""
        self.set_header("Cache-Control", "no-store")
        self.finish(self._page)


class LoopbackApplication(tornado.web.Application):
    """An application that listens on the loopback address only, whatever port it is asked for."""

    def listen(self, port: int, *_: Any, **__: Any) -> tornado.httpserver.HTTPServer:
        """Take any free port: meshcat's bridge asks for a fixed one."""
        del port
        server = tornado.httpserver.HTTPServer(self)
        sockets = tornado.netutil.bind_sockets(ANY_FREE_PORT, LOOPBACK)
        server.add_sockets(sockets)
        self.port: int = sockets[0].getsockname()[1]
        return server


class LoopbackBridge(ZMQWebSocketBridge):  # type: ignore[misc]  # meshcat has no type hints
    """meshcat's bridge with its two doors, ZeroMQ and web, on the loopback address."""

    def __init__(self) -> None:
        super().__init__(zmq_url=f"tcp://{LOOPBACK}:*", host=LOOPBACK, port=ANY_FREE_PORT)
        self.web_url = f"http://{LOOPBACK}:{self.app.port}/static/"

    def make_app(self) -> LoopbackApplication:
        """Routes for the loopback host names; every other name gets `404 Not Found`.

        tornado itself refuses a websocket whose origin is not this host.
        """
        folder = {"path": str(meshcat_page_folder())}
        routes = [
            (r"/", WebSocketHandler, {"bridge": self}),
            (r"/static/", PageHandler, {"page": LIVE_PAGE}),
            (r"/static/capture", PageHandler, {"page": CAPTURE_PAGE}),
            (r"/static/(.*)", StaticFileHandlerNoCache, folder),
        ]
        here = tornado.routing.HostMatches(LOOPBACK_NAMES)
        return LoopbackApplication([(here, routes)], websocket_max_message_size=LARGEST_MESSAGE)

    def setup_zmq(self, url: str) -> tuple[zmq.Socket[bytes], ZMQStream, str]:
        """As in meshcat, but report the port that the operating system chose."""
        socket, stream, _ = super().setup_zmq(url)
        return socket, stream, socket.getsockopt_string(zmq.LAST_ENDPOINT)


def main() -> None:
    """Serve until standard input ends."""
    bridge = LoopbackBridge()
    loop = tornado.ioloop.IOLoop.current()

    def stop_at_end(_file: Any, _events: int) -> None:
        if not os.read(sys.stdin.fileno(), 1024):
            loop.stop()

    loop.add_handler(sys.stdin, stop_at_end, loop.READ)
    print(json.dumps({"zmq": bridge.zmq_url, "web": bridge.web_url}), flush=True)  # noqa: T201
    bridge.run()


if __name__ == "__main__":
    main()
