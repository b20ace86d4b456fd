"""The viewer's server as seen by the process that draws: start it, send it messages, end it."""

from __future__ import annotations

import itertools
import json
import os
import secrets
import selectors
import socket
import subprocess
import sys
import weakref
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from dq_marine.viewer.errors import ViewerError
from dq_marine.viewer.libraries import drawing_library, meshcat_page_folder
from dq_marine.viewer.transport.loopback import LOOPBACK
from dq_marine.viewer.transport.messages import CAPTURE_IMAGE, TAKE_WORDS, Message
from dq_marine.viewer.transport.picture import pixels_of

ANY_FREE_PORT = 0

STARTER = Path(__file__).with_name("start_server.py")

START_TIMEOUT = 30.0
REPLY_TIMEOUT = 10.0
STOP_TIMEOUT = 2.0
"""Seconds to wait for the server's start, for its answer to a message, and for its orderly end."""

_NO_START = (
    f"the viewer's server did not start within {START_TIMEOUT:g} s; to see why, run: "
    "echo '{}' | python -m dq_marine.viewer.transport.server"
)

DELIMITER = b""
"""After a message's number: the server's socket, a REP, gives back with its answer what comes before this."""

POLL_SECONDS = 0.2
"""How often a long wait looks whether it has become hopeless."""


class ServerProcess:
    """One server of its own, with a connection to it.

    Attributes:
        web_url: address of the live page.
    """

    def __init__(self, meanwhile: Callable[[str], None] = lambda web_url: None) -> None:
        """Start the server.

        Args:
            meanwhile: called with the address of the live page while the server starts; a page that is asked for
                comes when it has.

        Raises:
            MissingDependencyError: meshcat, pyzmq or another library of the viewer is not installed.
            ViewerError: the server did not start.
        """
        meshcat_page_folder()
        for name in ("umsgpack", "tornado"):
            drawing_library(name)
        self._zmq = drawing_library("zmq")
        public_key, secret_key = self._zmq.curve_keypair()
        path = secrets.token_urlsafe(16)
        with socket.create_server((LOOPBACK, ANY_FREE_PORT)) as door:
            self.web_url = f"http://{LOOPBACK}:{door.getsockname()[1]}/{path}/"
            self._process = _start(door)
            self._stop = weakref.finalize(self, _stop, self._process, os.getpid())
            told = {"secret_key": secret_key.decode(), "path": path, "door": door.fileno()}
        try:
            meanwhile(self.web_url)
            _tell(self._process, told)
            address = _read_address(self._process)
        except BaseException:
            self._stop()
            raise
        self._socket = _connected(self._zmq, address, public_key)
        self._numbers = itertools.count()
        # Dropped or forgotten, a viewer still ends its server and its connection.
        weakref.finalize(self, self._socket.close, 0)

    @property
    def pid(self) -> int:
        """Process number of the server."""
        return self._process.pid

    def send(self, *messages: Message) -> None:
        """Have messages carried out by all connected pages, and by those that connect later.

        They are all on their way before the first answer is waited for.

        Raises:
            ViewerError: the server is closed or does not answer.
        """
        for message, answer in zip(messages, self._requests(messages, REPLY_TIMEOUT), strict=True):
            if answer != b"ok":
                raise ViewerError(f"the viewer's server refused {message.kind!r}: {answer!r}")

    def take_words(self) -> list[dict[str, Any]]:
        """What was said by the panels of pages since the last call, oldest first: names and plain values.

        Raises:
            ViewerError: the server is closed or does not answer.
        """
        words: list[dict[str, Any]] = json.loads(self._requests([TAKE_WORDS], REPLY_TIMEOUT)[0])
        return words

    def capture(self, timeout: float, check: Callable[[], None]) -> NDArray[np.uint8]:
        """A picture of what the connected page, which must be the one for pictures, shows after all messages so far.

        Args:
            timeout: longest wait for the page and its picture [s].
            check: called during the wait; raises when there is no hope left.

        Returns:
            Red, green and blue of every pixel, shape (height, width, 3).

        Raises:
            ViewerError: no picture came in time.
        """
        return pixels_of(self._requests([CAPTURE_IMAGE], timeout, check)[0])

    def close(self) -> None:
        """End the server and wait for its end. May be called again."""
        self._socket.close(linger=0)
        self._stop()

    def _requests(
        self, messages: Sequence[Message], timeout: float, check: Callable[[], None] = lambda: None
    ) -> list[bytes]:
        """Return the server's answers, which come in the order of the messages."""
        if self._socket.closed:
            raise ViewerError("the viewer is closed; open a new one")
        asked = [(b"%d" % next(self._numbers), message) for message in messages]
        for number, message in asked:
            path = message.path.encode()
            self._socket.send_multipart([number, DELIMITER, message.kind.encode(), path, message.packed()])
        return [self._answer(number, message.kind, timeout, check) for number, message in asked]

    def _answer(self, number: bytes, kind: str, timeout: float, check: Callable[[], None]) -> bytes:
        """Wait for the answer to a message, past those whose wait was interrupted, as by Ctrl-C."""
        answered, answer = b"", b""
        while answered != number:
            self._wait(kind, timeout, check)
            answered, _, answer = self._socket.recv_multipart()
        return answer

    def _wait(self, kind: str, timeout: float, check: Callable[[], None]) -> None:
        """Wait until there is something to receive."""
        waited = 0.0  # not by a clock, which goes on while this process and the server's are stopped
        while not self._socket.poll(1000 * POLL_SECONDS):
            check()
            if self._process.poll() is not None:
                self.close()
                raise ViewerError("the viewer's server has ended; open a new viewer")
            waited += POLL_SECONDS
            if waited >= timeout:
                self.close()
                raise ViewerError(
                    f"no answer to {kind!r} within {timeout:g} s; the viewer is closed: "
                    "open a new one, on a computer less busy"
                )


def _start(door: socket.socket) -> subprocess.Popen[bytes]:
    """Start the server's process with pipes to it and its door, away from the terminal's signals."""
    # -P keeps the current folder, whatever lies in it, off the server's module path.
    package_root = str(Path(__file__).parents[3])
    search_path = [package_root, *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.Popen(  # noqa: S603 - this interpreter runs a file of this package
        [sys.executable, "-P", "-W", "ignore", str(STARTER)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=subprocess.DEVNULL,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(search_path)},
        start_new_session=True,
        pass_fds=(door.fileno(),),
    )


def _tell(process: subprocess.Popen[bytes], told: dict[str, Any]) -> None:
    """Write the server's first line, which nobody else can read."""
    try:
        process.stdin.write(json.dumps(told).encode() + b"\n")  # type: ignore[union-attr]
        process.stdin.flush()  # type: ignore[union-attr]
    except BrokenPipeError as error:
        raise ViewerError(_NO_START) from error


def _read_address(process: subprocess.Popen[bytes]) -> str:
    """The server's first line, which gives its address for messages."""
    line = b""
    with selectors.DefaultSelector() as selector:
        selector.register(process.stdout, selectors.EVENT_READ)  # type: ignore[arg-type]
        if selector.select(START_TIMEOUT):
            line = process.stdout.readline()  # type: ignore[union-attr]
    if not line:
        raise ViewerError(_NO_START)
    address: str = json.loads(line)["zmq"]
    return address


def _connected(zmq: Any, url: str, server_key: bytes) -> Any:
    """A socket to the server that has the secret half of this key, encrypted by CURVE.

    A DEALER, which may send a message before the last one is answered; a REQ may not.
    """
    asking = zmq.Context.instance().socket(zmq.DEALER)
    asking.curve_serverkey = server_key
    asking.curve_publickey, asking.curve_secretkey = zmq.curve_keypair()
    asking.linger = 0
    asking.connect(url)
    return asking


def _stop(process: subprocess.Popen[bytes], owner: int) -> None:
    """End the server's process and wait for it."""
    # A forked child inherits the viewer object, but the server stays its parent's.
    if os.getpid() != owner:
        return
    for pipe in (process.stdin, process.stdout):
        if pipe is not None:
            pipe.close()
    process.terminate()
    try:
        process.wait(timeout=STOP_TIMEOUT)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
