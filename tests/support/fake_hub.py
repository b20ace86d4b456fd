"""A Hugging Face Hub of a test's own, on loopback: what its client asks of it to make, fill and read a repository."""

from __future__ import annotations

import base64
import contextlib
import hashlib
import json
import re
import threading
from collections.abc import Iterator
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from urllib.parse import unquote, urlsplit

Files = dict[str, bytes]


class FakeHub:
    """Repositories by name; of each, the files of every commit, the latest last."""

    def __init__(self) -> None:
        self.repositories: dict[str, dict[str, Files]] = {}

    def create(self, name: str) -> None:
        self.repositories.setdefault(name, {})

    def commit(self, name: str, files: Files) -> str:
        """Keep files beside those that are there, and return the commit's hash."""
        commits = self.repositories[name]
        before = list(commits.values())[-1] if commits else {}
        sha = hashlib.sha1(repr((len(commits), sorted(files.items()))).encode()).hexdigest()
        commits[sha] = {**before, **files}
        return sha

    def found(self, name: str, revision: str) -> tuple[str, Files] | None:
        commits = self.repositories.get(name) or {}
        sha = list(commits)[-1] if revision == "main" and commits else revision
        return (sha, commits[sha]) if sha in commits else None


class _Handler(BaseHTTPRequestHandler):
    hub: FakeHub
    protocol_version = "HTTP/1.1"

    def log_message(self, *arguments: object) -> None:
        """Say nothing."""

    def do_POST(self) -> None:
        body = self.rfile.read(int(self.headers.get("Content-Length") or 0))
        if self.headers.get("Transfer-Encoding") == "chunked":
            body = self._chunks()
        path = unquote(urlsplit(self.path).path)
        if path == "/api/repos/create":
            asked = json.loads(body)
            name = f"{asked['organization']}/{asked['name']}"
            self.hub.create(name)
            self._json({"url": f"{self._address()}/{name}"})
        elif path == "/api/validate-yaml":
            self._json({"errors": [], "warnings": []})
        elif match := re.fullmatch(r"/api/models/(.+/.+)/preupload/main", path):
            files = [one["path"] for one in json.loads(body)["files"]]
            self._json(
                {"files": [{"path": one, "uploadMode": "regular", "shouldIgnore": False} for one in files]}
            )
        elif match := re.fullmatch(r"/api/models/(.+/.+)/commit/main", path):
            entries = [json.loads(line)["value"] for line in body.splitlines()]
            files = {one["path"]: base64.b64decode(one["content"]) for one in entries if "content" in one}
            sha = self.hub.commit(match[1], files)
            self._json({"commitUrl": f"{self._address()}/{match[1]}/commit/{sha}", "commitOid": sha})
        else:
            self._missing()

    def do_GET(self) -> None:
        path = unquote(urlsplit(self.path).path)
        if match := re.fullmatch(r"/api/models/(.+/.+)/(revision|tree)/([^/]+)", path):
            found = self.hub.found(match[1], match[3])
            if found is None:
                self._missing()
                return
            sha, files = found
            tree = [
                {"type": "file", "path": name, "size": len(content), "oid": _oid(content)}
                for name, content in files.items()
            ]
            info = {"id": match[1], "sha": sha, "siblings": [{"rfilename": name} for name in files]}
            self._json(tree if match[2] == "tree" else info)
        elif match := re.fullmatch(r"/(.+/.+)/resolve/([^/]+)/(.+)", path):
            found = self.hub.found(match[1], match[2])
            if found is None or match[3] not in found[1]:
                self._missing()
                return
            content = found[1][match[3]]
            self._send(content, {"X-Repo-Commit": found[0], "ETag": f'"{_oid(content)}"'})
        else:
            self._missing()

    def do_HEAD(self) -> None:
        self.do_GET()

    def _chunks(self) -> bytes:
        content = b""
        while size := int(self.rfile.readline(), 16):
            content += self.rfile.read(size)
            self.rfile.readline()
        self.rfile.readline()
        return content

    def _address(self) -> str:
        return f"http://{self.headers['Host']}"

    def _missing(self) -> None:
        self._send(b"{}", {"X-Error-Code": "RepoNotFound", "X-Error-Message": "Repository not found"}, 404)

    def _json(self, content: object) -> None:
        self._send(json.dumps(content).encode(), {"Content-Type": "application/json"})

    def _send(self, content: bytes, headers: dict[str, str], status: int = 200) -> None:
        self.send_response(status)
        for name, value in {**headers, "Content-Length": str(len(content))}.items():
            self.send_header(name, value)
        self.end_headers()
        if self.command != "HEAD":
            self.wfile.write(content)


def _oid(content: bytes) -> str:
    """Return git's hash of a file."""
    return hashlib.sha1(b"blob %d\0" % len(content) + content).hexdigest()


@contextlib.contextmanager
def served(hub: FakeHub) -> Iterator[str]:
    """Yield the address that a hub is served at within the block."""
    handler = type("Handler", (_Handler,), {"hub": hub})
    server = ThreadingHTTPServer(("127.0.0.1", 0), handler)
    server.daemon_threads = True
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.02})
    thread.start()
    try:
        yield f"http://127.0.0.1:{server.server_port}"
    finally:
        server.shutdown()
        thread.join()
        server.server_close()
