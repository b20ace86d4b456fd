"""A page in a real Chromium, looked into through the DevTools protocol."""

from __future__ import annotations

import json
import time
import urllib.request
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from websockets.sync.client import ClientConnection, connect

from dq_marine.viewer.transport.browser import HeadlessBrowser

DEBUGGING_FLAGS = ("--remote-debugging-port=0", "--remote-allow-origins=*")
PATIENCE = 120.0
ALT, CTRL = 1, 2
"""Keys that are held down while the mouse does something."""


HOLDS = """(() => {
  try {
    return Boolean(CONDITION);
  } catch (error) {
    if (error instanceof TypeError) return false;
    throw error;
  }
})()"""
"""Whether a condition holds; it does not where it reads of something that is null or undefined."""


class NavigatedError(Exception):
    """The browser could not evaluate an expression: its page was just replaced by another."""


class Page:
    """The page that a browser shows."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._sent = 0

    def _holds(self, condition: str) -> bool:
        """Whether it holds now; of what the page does not have yet, nothing holds."""
        try:
            return bool(self.evaluate(HOLDS.replace("CONDITION", condition)))
        except NavigatedError:  # the browser goes from its first page to the one that is waited for
            return False

    def evaluate(self, expression: str) -> Any:
        """The value of a JavaScript expression; a JavaScript error fails the test."""
        result = self._command("Runtime.evaluate", expression=expression, returnByValue=True)
        assert "exceptionDetails" not in result, result["exceptionDetails"]
        return result["result"].get("value")

    def mouse(self, kind: str, x: float, y: float, *, held: int = 0) -> None:
        """Press, move or release the left button of a real mouse at a pixel.

        Args:
            kind: "mousePressed", "mouseMoved" or "mouseReleased".
            x: of the pixel.
            y: of the pixel.
            held: keys that are down, see `ALT`, `CTRL`.
        """
        self._command(
            "Input.dispatchMouseEvent",
            type=kind,
            x=x,
            y=y,
            button="left",
            buttons=1,
            clickCount=1,
            modifiers=held,
        )

    def close(self) -> None:
        """Close the page, as a person closes its tab; nothing can be done with it thereafter."""
        self._command("Page.close")

    def _command(self, method: str, **parameters: Any) -> Any:
        self._sent += 1
        self._connection.send(json.dumps({"id": self._sent, "method": method, "params": parameters}))
        while True:
            answer = json.loads(self._connection.recv(timeout=PATIENCE))
            if answer.get("id") == self._sent:
                break
        if "error" in answer:
            raise NavigatedError(answer["error"])
        return answer["result"]

    def wait_until(self, condition: str) -> None:
        """Return when a JavaScript condition has become true."""
        deadline = time.monotonic() + PATIENCE
        while not self._holds(condition):
            assert time.monotonic() < deadline, f"still not true: {condition}"
            time.sleep(0.05)

    def node(self, path: str, what: str) -> Any:
        """A property, as a JavaScript expression, of the three.js object at a meshcat path.

        It is waited for until there is something to read it of: the page draws what it is told one after the other.
        """
        names = json.dumps(path.strip("/").split("/"))
        expression = f"viewer.scene_tree.find({names}).object.{what}"
        self.wait_until(f"({expression}, true)")
        return self.evaluate(expression)


@contextmanager
def open_page(
    url: str, *, ready: str = "typeof viewer === 'object'", width: int = 640, height: int = 480
) -> Iterator[Page]:
    """Show a page until the end of the block, from when a JavaScript condition holds."""
    browser = HeadlessBrowser(url, width, height, extra_flags=DEBUGGING_FLAGS)
    try:
        with connect(_debugger_url(browser.profile), max_size=None) as connection:
            page = Page(connection)
            page.wait_until(ready)
            yield page
    finally:
        browser.close()


def _debugger_url(profile: Path) -> str:
    """Where the one page of a browser can be debugged."""
    deadline = time.monotonic() + PATIENCE
    port_file = profile / "DevToolsActivePort"
    while time.monotonic() < deadline:
        if port_file.exists() and (lines := port_file.read_text().split()):
            with urllib.request.urlopen(f"http://127.0.0.1:{lines[0]}/json", timeout=PATIENCE) as reply:
                targets = json.load(reply)
            pages = [target for target in targets if target["type"] == "page"]
            if pages:
                return str(pages[0]["webSocketDebuggerUrl"])
        time.sleep(0.05)
    raise TimeoutError("the browser shows no page that can be debugged")


def element(name: str) -> str:
    """A JavaScript expression for an element of a page."""
    return f"document.getElementById('{name}')"
