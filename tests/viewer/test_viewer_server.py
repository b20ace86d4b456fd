"""The server can be reached from this computer only, and never outlives its parent."""

from __future__ import annotations

import gc
import os
import signal
import socket
import subprocess
import sys
import time
import urllib.error
import urllib.request
from collections.abc import Iterator
from urllib.parse import urlsplit

import pytest
from viewer.processes import alive, listening_addresses, wait_for_end
from viewer.samples import ROV, snapshot
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect

from dq_marine.viewer import LiveViewer, ViewerError
from dq_marine.viewer.transport.messages import set_property
from dq_marine.viewer.transport.server_process import STARTER, ServerProcess

LOOPBACK_IN_PROC = "0100007F"


@pytest.fixture(scope="module")
def server() -> Iterator[ServerProcess]:
    running = ServerProcess()
    yield running
    running.close()


def port_of(server: ServerProcess) -> int:
    port = urlsplit(server.web_url).port
    assert port is not None
    return port


def websocket_url(server: ServerProcess) -> str:
    return server.web_url.replace("http://", "ws://") + "socket"


def status(server: ServerProcess, host: str) -> int:
    """The HTTP status of the live page, asked for under a host name."""
    request = urllib.request.Request(server.web_url, headers={"Host": host})
    try:
        with urllib.request.urlopen(request, timeout=120) as reply:
            return int(reply.status)
    except urllib.error.HTTPError as error:
        error.close()
        return error.code


def test_listens_on_loopback_only(server: ServerProcess) -> None:
    addresses = listening_addresses(server.pid)
    assert len(addresses) == 2, "one door for ZeroMQ, one for web pages"
    assert set(addresses) == {LOOPBACK_IN_PROC}


def test_page_is_served_under_loopback_names_only(server: ServerProcess) -> None:
    port = port_of(server)
    assert status(server, f"127.0.0.1:{port}") == 200
    assert status(server, f"localhost:{port}") == 200
    assert status(server, f"evil.example:{port}") == 404
    assert status(server, f"127.0.0.1.evil.example:{port}") == 404


def test_websocket_is_refused_to_foreign_hosts_and_origins(server: ServerProcess) -> None:
    port = port_of(server)
    with connect(websocket_url(server), origin=f"http://127.0.0.1:{port}"):
        pass
    for foreign in ("http://evil.example", "null", f"http://127.0.0.1:{port + 1}"):
        with pytest.raises(InvalidStatus, match="403"), connect(websocket_url(server), origin=foreign):
            pass
    # A rebound name: the browser believes that it talks to evil.example, origin and host agree.
    rebound = socket.create_connection(("127.0.0.1", port))
    with (
        pytest.raises(InvalidStatus, match="404"),
        connect(
            websocket_url(server).replace("127.0.0.1", "evil.example"),
            sock=rebound,
            origin=f"http://evil.example:{port}",
        ),
    ):
        pass


def test_nothing_is_served_to_who_does_not_know_the_path(server: ServerProcess) -> None:
    """Another user of this computer can reach the port."""
    port = port_of(server)
    for path in ("", "static/", "socket", "capture", f"{'x' * 22}/"):
        with pytest.raises(urllib.error.HTTPError, match="404"):
            urllib.request.urlopen(f"http://127.0.0.1:{port}/{path}", timeout=120)
    with pytest.raises(InvalidStatus, match="404"), connect(f"ws://127.0.0.1:{port}/"):
        pass


def test_servers_stand_side_by_side(server: ServerProcess) -> None:
    other = ServerProcess()
    assert other.web_url != server.web_url
    other.close()
    assert status(server, f"127.0.0.1:{port_of(server)}") == 200


def test_close_ends_the_server_and_may_be_repeated() -> None:
    viewer = LiveViewer(ROV)
    pid = viewer._server.pid
    assert alive(pid)
    viewer.close()
    viewer.close()
    assert not alive(pid)
    with pytest.raises(ViewerError, match="closed"):
        viewer.draw(snapshot())


def test_a_forgotten_viewer_ends_its_server() -> None:
    viewer = LiveViewer(ROV)
    pid = viewer._server.pid
    del viewer
    gc.collect()
    assert not alive(pid)


def test_the_server_starts_without_what_it_does_not_need() -> None:
    script = (
        "import runpy, sys\n"
        "try:\n"
        "    runpy.run_path(sys.argv[1], run_name='__main__')\n"
        "except TypeError:  # nobody told it the secrets\n"
        "    assert 'tornado' in sys.modules\n"
        "    print(*sorted({'numpy', 'gymnasium', 'numba', 'IPython'} & sys.modules.keys()))\n"
    )
    command = [sys.executable, "-c", script, str(STARTER)]
    result = subprocess.run(command, input="{}", capture_output=True, text=True, timeout=600)
    assert (result.stdout, result.stderr) == ("\n", "")


@pytest.mark.parametrize("end", ["sys.exit()", "os.kill(os.getpid(), signal.SIGKILL)"])
def test_server_ends_with_its_parent(end: str) -> None:
    script = (
        "import os, signal, sys\n"
        "from dq_marine.viewer.transport.server_process import ServerProcess\n"
        "server = ServerProcess()\n"
        "print(server.pid, flush=True)\n"
        f"{end}\n"
    )
    result = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=600)
    assert wait_for_end(int(result.stdout))
    assert result.stderr == ""


def test_a_server_that_has_gone_is_noticed_soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """Not by waiting for its answer in vain."""
    monkeypatch.setattr("dq_marine.viewer.transport.server_process.REPLY_TIMEOUT", 600.0)
    viewer = LiveViewer(ROV)
    os.kill(viewer._server.pid, signal.SIGKILL)
    started = time.monotonic()
    with pytest.raises(ViewerError, match="has ended"):
        viewer.draw(snapshot())
    assert time.monotonic() - started < 300.0
    viewer.close()


def test_a_silent_server_is_given_up(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("dq_marine.viewer.transport.server_process.REPLY_TIMEOUT", 0.5)
    viewer = LiveViewer(ROV)
    pid = viewer._server.pid
    os.kill(pid, signal.SIGSTOP)
    with pytest.raises(ViewerError, match=r"no answer .* within 0.5 s"):
        viewer.draw(snapshot())
    assert not alive(pid)


def test_a_page_that_is_told_to_leave_and_stays_holds_nothing_up(server: ServerProcess) -> None:
    """The same as a page that is just leaving: its websocket is closing, and nothing can be written to it."""
    address = urlsplit(server.web_url)
    with socket.create_connection((address.hostname, address.port), timeout=60.0) as page:
        page.sendall(
            f"GET {address.path}socket HTTP/1.1\r\nHost: {address.netloc}\r\nUpgrade: websocket\r\n"
            "Connection: Upgrade\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
            "Sec-WebSocket-Version: 13\r\n\r\n".encode()
        )
        page.sendall(bytes([0x81, 0x81, 0, 0, 0, 0]) + b"x")  # a text, which is not a picture
        said = b""
        while b"not a picture" not in said:  # so the server closes, and waits for the page to close, too
            more = page.recv(4096)
            assert more
            said += more
        for _ in range(3):
            server.send(set_property("/Background", "visible", True))


def test_an_interrupted_wait_does_not_spoil_the_next_command(monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    with LiveViewer(ROV) as viewer:
        viewer.draw(snapshot())
        with monkeypatch.context() as patch:
            patch.setattr(type(viewer._server._socket), "poll", interrupt)
            with pytest.raises(KeyboardInterrupt):
                viewer.draw(snapshot(time=1.0))
        viewer.draw(snapshot(time=2.0))


def test_nothing_is_printed(capfd: pytest.CaptureFixture[str]) -> None:
    with LiveViewer(ROV) as viewer:
        viewer.draw(snapshot())
    assert capfd.readouterr() == ("", "")


@pytest.mark.parametrize(("display", "opened"), [("", False), (":0", True)])
def test_browser_opens_only_where_a_display_is(
    display: str, opened: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    asked: list[str] = []
    monkeypatch.setattr("webbrowser.open", asked.append)
    monkeypatch.setattr("sys.platform", "linux")
    monkeypatch.delenv("WAYLAND_DISPLAY", raising=False)
    monkeypatch.setenv("DISPLAY", display)
    with LiveViewer(ROV, open_browser=True) as viewer:
        assert asked == ([viewer.url] if opened else [])
