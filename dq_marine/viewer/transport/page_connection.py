"""What every websocket of a page does: it sends small messages at once, and none to a page that is leaving."""

from __future__ import annotations

import asyncio
from typing import Any

import tornado.websocket


class PageConnection(tornado.websocket.WebSocketHandler):
    """A websocket of a page, which may leave at any time."""

    def open(self, *arguments: str, **keywords: str) -> None:
        """Have messages sent at once: else one waits some 40 ms for an acknowledgement by TCP."""
        self.set_nodelay(True)
        super().open(*arguments, **keywords)

    def write_message(
        self, message: bytes | str | dict[str, Any], binary: bool = False
    ) -> asyncio.Future[None]:
        """Send a message, unless the page is just leaving: tornado would raise, and the caller's own work be lost."""
        if self.ws_connection is None or self.ws_connection.is_closing():
            unsent = asyncio.get_running_loop().create_future()
            unsent.set_result(None)
            return unsent
        return super().write_message(message, binary)
