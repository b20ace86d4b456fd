"""Nobody but its owner tells a running viewer anything: no page from elsewhere, no other user of the computer."""

from __future__ import annotations

import base64
import http.server
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from urllib.parse import urlsplit

import pytest
import umsgpack
import zmq
from viewer.samples import ROV, snapshot
from websockets.exceptions import ConnectionClosed
from websockets.sync.client import ClientConnection, connect

from dq_marine.viewer import LiveViewer
from dq_marine.viewer.transport.browser import HeadlessBrowser
from dq_marine.viewer.transport.messages import Message
from dq_marine.viewer.transport.picture import HEAD, MARK
from dq_marine.viewer.transport.server_process import DELIMITER, ServerProcess


def picture(width: int, height: int) -> bytes:
    """What a page sends when it is asked for a picture."""
    return HEAD.pack(MARK, width, height) + bytes(4 * width * height)


DELETE_ALL = [b"delete", b"/world", umsgpack.packb({"type": "delete", "path": "/world"})]


@pytest.fixture(scope="module")
def viewer() -> Iterator[LiveViewer]:
    """One for all: whatever was tried before, it goes on."""
    with LiveViewer(ROV) as running:
        running.draw(snapshot())
        yield running


def door(viewer: LiveViewer) -> tuple[str, int]:
    """Host and port at which the viewer takes messages."""
    address = urlsplit(viewer._server._socket.getsockopt_string(zmq.LAST_ENDPOINT))
    assert address.hostname
    assert address.port
    return address.hostname, address.port


def scene(viewer: LiveViewer) -> list[bytes]:
    """What a page that connects now is told: the whole scene."""
    received: list[bytes] = []
    with connect(viewer.url.replace("http://", "ws://") + "socket") as page:
        answered = page.ping()  # after all that a page is told when it connects
        while True:
            try:
                message = page.recv(timeout=0.05)
            except TimeoutError:
                if answered.is_set():
                    return sorted(received)
            else:
                received.append(message if isinstance(message, bytes) else message.encode())


@contextmanager
def unharmed(viewer: LiveViewer) -> Iterator[None]:
    """Check that the scene is the same after something was tried, and that the viewer goes on."""
    before = scene(viewer)
    assert len(before) > 10
    yield
    assert scene(viewer) == before
    started = time.monotonic()
    viewer.draw(snapshot(time=1.0))
    assert time.monotonic() - started < 8.0


def read_to_the_end(page: ClientConnection) -> None:
    """Read until the server ends the connection, which raises."""
    while True:
        page.recv(timeout=20.0)


def zmtp1(frames: list[bytes]) -> bytes:
    """Frames as ZMTP 1.0 has them: an empty identity, the request's empty delimiter, and what is said."""
    framed = [b"", *frames]
    flags = [1] * (len(framed) - 1) + [0]
    greeting = b"\x01\x00"
    long = [
        (b"\xff" + (len(f) + 1).to_bytes(8, "big") if len(f) > 253 else bytes([len(f) + 1])) for f in framed
    ]
    return greeting + b"".join(n + bytes([flag]) + f for n, flag, f in zip(long, flags, framed, strict=True))


RAW = {
    "ZMTP 1.0": zmtp1(DELETE_ALL),
    "a post": b"POST / HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 60\r\n\r\n" + zmtp1(DELETE_ALL),
    "a byte": b"\xff",
    "noise": bytes(range(256)) * 40,
    "nothing": b"",
}


@pytest.mark.parametrize("raw", RAW.values(), ids=RAW)
def test_raw_bytes_change_nothing(raw: bytes, viewer: LiveViewer) -> None:
    with unharmed(viewer), socket.create_connection(door(viewer), timeout=5.0) as intruder:
        intruder.sendall(raw)
        intruder.settimeout(1.0)
        with suppress(TimeoutError, ConnectionError):
            assert b"ok" not in intruder.recv(4096)[64:]


@pytest.mark.parametrize("keys", ["none", "its own"])
def test_who_lacks_the_keys_is_not_heard(keys: str, viewer: LiveViewer) -> None:
    stranger = zmq.Context.instance().socket(zmq.REQ)
    stranger.linger = 0
    stranger.sndtimeo = 1000  # there is nobody to send to, once the handshake has failed
    if keys != "none":
        stranger.curve_publickey, stranger.curve_secretkey = zmq.curve_keypair()
        stranger.curve_serverkey = zmq.curve_keypair()[0]
    stranger.connect("tcp://{}:{}".format(*door(viewer)))
    try:
        with unharmed(viewer):
            with suppress(zmq.Again):
                stranger.send_multipart(DELETE_ALL)
            assert not stranger.poll(1000)
    finally:
        stranger.close()


@pytest.mark.parametrize(
    "frames",
    [
        [b"\xff\xfe"],
        [b""],
        [b"delete"],
        [b"capture_image", b"\xff", b""],
        [b"set_object"] * 7,
        [b"url", b"", b""],
    ],
    ids=["no text", "empty", "too short", "path is no text", "too long", "unknown"],
)
def test_a_message_of_wrong_shape_is_refused(frames: list[bytes], viewer: LiveViewer) -> None:
    """Even from one with the keys."""
    own = viewer._server._socket
    with unharmed(viewer):
        own.send_multipart([b"a number", DELIMITER, *frames])
        assert own.poll(5000)
        number, _, answer = own.recv_multipart()
        assert (number, answer[:5]) == (b"a number", b"error")


@pytest.mark.parametrize(
    "message",
    ["text", "", b"", b"\x00\xff", picture(2, 1)[:-1], picture(2, 1) + b"\x00", b"PNG" + picture(2, 1)[3:]],
    ids=["text", "no text", "nothing", "bytes", "too short", "too long", "other"],
)
def test_a_page_may_send_nothing_but_pictures(message: str | bytes, viewer: LiveViewer) -> None:
    with unharmed(viewer), connect(viewer.url.replace("http://", "ws://") + "socket") as page:
        page.send(message)
        with pytest.raises(ConnectionClosed):
            read_to_the_end(page)


def test_a_picture_that_nobody_wants_is_dropped(viewer: LiveViewer) -> None:
    address = viewer.url.replace("http://", "ws://") + "socket"
    with unharmed(viewer), connect(address, max_queue=None) as page:  # takes all that it is told, unread
        page.send(picture(2, 1))


ATTACK = """<!DOCTYPE html><title>attack</title><script>
const tried = [];
const blob = new Blob([Uint8Array.from(atob("$body"), (c) => c.charCodeAt(0))]);
for (const port of [$ports]) {
  for (const url of [`http://127.0.0.1:${port}/`, `http://localhost:${port}/`]) {
    tried.push(fetch(url, {method: "POST", mode: "no-cors", body: blob}).catch(() => 0));
    tried.push(fetch(url).then((r) => r.text()).catch(() => 0));
    tried.push(new Promise((done) => {
      const socket = new WebSocket(url.replace("http", "ws"));
      socket.onopen = () => { socket.send("{}"); done(); };
      socket.onerror = socket.onclose = () => done();
    }));
  }
}
Promise.race([Promise.all(tried), new Promise((done) => setTimeout(done, 4000))])
  .then(() => fetch("/done", {method: "POST"}));
</script>"""


@pytest.mark.browser
def test_a_page_from_elsewhere_changes_nothing(viewer: LiveViewer) -> None:
    """A page of another origin, in a real browser, that posts to both ports and opens websockets there."""
    body = base64.b64encode(zmtp1(DELETE_ALL) * 3).decode()
    ports = f"{door(viewer)[1]}, {urlsplit(viewer.url).port}"
    page = ATTACK.replace("$body", body).replace("$ports", ports).encode()
    finished = threading.Event()

    class Foreign(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("Content-Type", "text/html")
            self.end_headers()
            self.wfile.write(page)

        def do_POST(self) -> None:
            self.send_response(204)
            self.end_headers()
            finished.set()

        def log_message(self, *_: object) -> None:
            pass

    elsewhere = http.server.ThreadingHTTPServer(("127.0.0.1", 0), Foreign)
    threading.Thread(target=elsewhere.serve_forever, daemon=True).start()
    try:
        with unharmed(viewer):
            tab = HeadlessBrowser(f"http://127.0.0.1:{elsewhere.server_port}/", 200, 200)
            try:
                assert finished.wait(120.0)
            finally:
                tab.close()
    finally:
        elsewhere.shutdown()
        elsewhere.server_close()


@pytest.mark.browser
def test_the_path_is_no_argument_of_the_browser_either(viewer: LiveViewer) -> None:
    tab = HeadlessBrowser(viewer.url, 200, 200)
    try:
        with open(f"/proc/{tab.pid}/cmdline", "rb") as file:
            assert urlsplit(viewer.url).path.encode() not in file.read()
    finally:
        tab.close()


def test_secrets_differ_and_stand_in_no_list_of_processes() -> None:
    one, other = ServerProcess(), ServerProcess()
    try:
        paths = [urlsplit(server.web_url).path.strip("/") for server in (one, other)]
        assert len(set(paths)) == 2
        assert all(len(path) >= 22 for path in paths)
        for server, path in zip((one, other), paths, strict=True):
            for place in ("cmdline", "environ"):
                with open(f"/proc/{server.pid}/{place}", "rb") as file:
                    assert path.encode() not in file.read()
            server.send(Message("delete", "/world"))
    finally:
        one.close()
        other.close()
