"""A hash inside an ONNX file, over the file itself: what was damaged since it was written is found before it is read.

The hash is taken while 64 zeros stand in its place. It guards against accidents, not against people.
"""

from __future__ import annotations

import hashlib
import re

SEAL_KEY = "dq_marine.sha256"
"""Of the hash's entry in the file's metadata."""

UNSEALED = 64 * "0"
"""What stands in the hash's place until it is known."""

_ENTRY = re.compile(rb"(?<=" + re.escape(SEAL_KEY.encode()) + rb"\x12\x40)[0-9a-f]{64}")
"""The hash in a file: protobuf writes a field's tag and length between the key and it."""


def sealed(content: bytes) -> bytes:
    """Return a file's bytes, whose metadata has `UNSEALED` by `SEAL_KEY`, with the hash in its place."""
    return _ENTRY.sub(_digest(content), content, count=1)


def has_seal(content: bytes) -> bool:
    """Whether a file's bytes hold a hash at all."""
    return _ENTRY.search(content) is not None


def is_whole(content: bytes) -> bool:
    """Whether a file's bytes are as they were when they were given their hash."""
    found = _ENTRY.search(content)
    bare = _ENTRY.sub(UNSEALED.encode(), content, count=1)
    return found is not None and found.group() == _digest(bare)


def _digest(content: bytes) -> bytes:
    return hashlib.sha256(content).hexdigest().encode()
