"""The viewer's server: meshcat's bridge from ZeroMQ to web pages, for this computer only.

It runs as a process of its own (`start_server.py`). Its parent writes one line of JSON to its standard input, the
secrets and the socket for web pages, which the parent has opened, so that a page may ask before the server is ready; it
prints one line of JSON with the address for ZeroMQ, and ends when its standard input does, that is, when its parent is
gone.

meshcat's own server listens on every network interface and obeys whoever connects. This one listens on the loopback
address, on free ports, and two secrets keep out what else can reach those: other users' programs, and pages from
anywhere in the user's own browser.

- The ZeroMQ port speaks CURVE (https://rfc.zeromq.org/spec/26). Bytes from one who does not have the parent's keys,
  such as a POST from a web page, are dropped in the handshake and never read as messages.
- The web pages and their websocket are under a path that cannot be guessed. A page from elsewhere can neither reach
  them by a rebound name nor open their websocket.
"""

from __future__ import annotations

import json
import os
import socket
import sys
from typing import Any

import tornado.httpserver
import tornado.ioloop
import tornado.routing
import tornado.web
import umsgpack
import zmq
from meshcat.servers.zmqserver import (
    MESHCAT_COMMANDS,
    StaticFileHandlerNoCache,
    WebSocketHandler,
    ZMQWebSocketBridge,
)
from zmq.eventloop.zmqstream import ZMQStream

from dq_marine.viewer.libraries import meshcat_page_folder
from dq_marine.viewer.transport.loopback import LOOPBACK
from dq_marine.viewer.transport.page_connection import PageConnection
from dq_marine.viewer.transport.pages import CAPTURE_PAGE, LIVE_PAGE
from dq_marine.viewer.transport.panel_socket import POLICY_VIOLATION, PanelHub, PanelSocket
from dq_marine.viewer.transport.picture import is_picture

LOOPBACK_NAMES = r"^(127\.0\.0\.1|localhost)$"
SHOW_PANEL, TAKE_WORDS = "show_panel", "take_words"
"""Messages about the panels of pages: what they are to show, and a question for what was said by them."""

KINDS = frozenset(MESHCAT_COMMANDS) | {"capture_image", SHOW_PANEL, TAKE_WORDS}
"""Messages that are carried out."""

UNTIL_A_PAGE_IS_THERE = 0.02
"""Time between looks whether a page has connected that a picture can be asked of [s]."""

LARGEST_MESSAGE = 257 * 2**20
"""Bytes in a message from a page; a picture of 8192 x 8192 pixels fits in."""


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
    """An application that listens at the door it is given, whatever port it is asked for."""

    door: socket.socket

    def listen(self, port: int, *_: Any, **__: Any) -> tornado.httpserver.HTTPServer:
        """Take the door: meshcat's bridge asks for a fixed port."""
        del port
        server = tornado.httpserver.HTTPServer(self)
        server.add_sockets([self.door])
        return server


class PageSocket(PageConnection, WebSocketHandler):  # type: ignore[misc]  # meshcat has no type hints
    """The websocket of a page, which may answer with a picture when it was asked for one, and say nothing else."""

    def on_message(self, message: str | bytes) -> None:
        """Pass a picture on, if one is still wanted; close on anything else."""
        if not is_picture(message):
            self.close(POLICY_VIOLATION, "not a picture")
        elif self.bridge.wants_picture:
            self.bridge.give_picture(message)


class LoopbackBridge(ZMQWebSocketBridge):  # type: ignore[misc]  # meshcat has no type hints
    """meshcat's bridge with its two doors, ZeroMQ and web, on the loopback address.

    Attributes:
        wants_picture: whether pages were asked for a picture that none of them has sent yet.
    """

    def __init__(self, secret_key: str, path: str, door: int) -> None:
        """Open the doors.

        Args:
            secret_key: the server's, for CURVE.
            path: under which the pages are.
            door: number of the file that is the listening socket for web pages.
        """
        self._secret_key, self._path = secret_key, path
        self._door = socket.socket(fileno=door)
        self._door.setblocking(False)
        self.wants_picture = False
        self._panels = PanelHub()
        super().__init__(zmq_url=f"tcp://{LOOPBACK}:*", host=LOOPBACK, port=0)

    def make_app(self) -> LoopbackApplication:
        """Routes for the loopback host names; every other name gets `404 Not Found`.

        tornado itself refuses a websocket whose origin is not this host.
        """
        folder = {"path": str(meshcat_page_folder())}
        routes = [
            (rf"/{self._path}/socket", PageSocket, {"bridge": self}),
            (rf"/{self._path}/panel", PanelSocket, {"hub": self._panels}),
            (rf"/{self._path}/", PageHandler, {"page": LIVE_PAGE}),
            (rf"/{self._path}/capture", PageHandler, {"page": CAPTURE_PAGE}),
            (rf"/{self._path}/(.*)", StaticFileHandlerNoCache, folder),
        ]
        here = tornado.routing.HostMatches(LOOPBACK_NAMES)
        application = LoopbackApplication([(here, routes)], websocket_max_message_size=LARGEST_MESSAGE)
        application.door = self._door
        return application

    def setup_zmq(self, url: str) -> tuple[zmq.Socket[bytes], ZMQStream, str]:
        """As in meshcat, but for those who have the keys, and report the port that the operating system chose."""
        socket: zmq.Socket[bytes] = self.context.socket(zmq.REP)
        socket.curve_secretkey = self._secret_key.encode()
        socket.curve_server = True
        socket.bind(url)
        stream = ZMQStream(socket)
        stream.on_recv(self.handle_zmq)
        return socket, stream, socket.getsockopt_string(zmq.LAST_ENDPOINT)

    def handle_zmq(self, frames: list[bytes]) -> None:
        """Carry a message out, or say what is wrong with it."""
        try:
            kind, path, content = frames
            known = kind.decode() in KINDS and path.decode() is not None
        except ValueError:
            known = False
        if not known:
            self.zmq_socket.send(b"error: not a message of meshcat's protocol")
            return
        if kind.decode() == TAKE_WORDS:
            self.zmq_socket.send(self._panels.take_words())
        elif kind.decode() == SHOW_PANEL:
            self._panels.show(path.decode(), umsgpack.unpackb(content))
            self.zmq_socket.send(b"ok")
        else:
            self.wants_picture = kind == b"capture_image"
            if self.wants_picture and not self.websocket_pool:  # meshcat would look again much later
                self.ioloop.call_later(UNTIL_A_PAGE_IS_THERE, self.handle_zmq, frames)
            else:
                super().handle_zmq(frames)

    def give_picture(self, picture: bytes) -> None:
        """Answer the request for a picture."""
        self.wants_picture = False
        self.zmq_stream.send(picture)


def main() -> None:
    """Serve until standard input ends."""
    bridge = LoopbackBridge(**json.loads(sys.stdin.readline()))
    loop = tornado.ioloop.IOLoop.current()

    def stop_at_end(_file: Any, _events: int) -> None:
        if not os.read(sys.stdin.fileno(), 1024):
            loop.stop()

    loop.add_handler(sys.stdin, stop_at_end, loop.READ)
    print(json.dumps({"zmq": bridge.zmq_url}), flush=True)  # noqa: T201
    bridge.run()


if __name__ == "__main__":
    main()
