"""A Chromium without a window, in which a page can be drawn where there is no display."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import subprocess
import tempfile
import weakref
from collections.abc import Sequence
from pathlib import Path

from dq_marine.errors import MissingDependencyError
from dq_marine.util.locks import FileLock, is_free

CHROMIUM_VARIABLES = ("DQ_MARINE_CHROMIUM", "CHROME")
"""What may name the browser's executable, the first one that is set and not empty."""

CHROMIUM_NAMES = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "chromium-headless-shell",
)
"""Names of programs, in the order in which they are looked for."""

APPLICATION_FOLDERS = (Path("/Applications"), Path(os.path.expanduser("~/Applications")))
APPLICATIONS = ("Google Chrome.app/Contents/MacOS/Google Chrome", "Chromium.app/Contents/MacOS/Chromium")
"""Where macOS has them."""

QUIET_FLAGS = (
    "--headless",
    "--disable-gpu",
    # WebGL on the processor: the pages shown are the viewer's own.
    "--enable-unsafe-swiftshader",
    "--force-device-scale-factor=1",
    "--hide-scrollbars",
    "--mute-audio",
    "--no-first-run",
    "--no-default-browser-check",
    "--no-proxy-server",
    "--password-store=basic",
    "--use-mock-keychain",
    # A page that is not on a screen must be drawn as promptly as one that is.
    "--disable-background-timer-throttling",
    "--disable-backgrounding-occluded-windows",
    "--disable-renderer-backgrounding",
    # Nothing but the viewer's page is to be fetched.
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-default-apps",
    "--disable-domain-reliability",
    "--disable-extensions",
    "--disable-quic",
    "--disable-sync",
    "--host-resolver-rules=MAP * ~NOTFOUND, EXCLUDE 127.0.0.1",
)

PROFILE_PREFIX = "dq_marine_chromium_"
"""Of the names of temporary profiles."""

OWNER_FILE = "owner.lock"
"""In a profile: locked by the process that uses it."""


def find_chromium() -> str:
    """The Chromium or Chrome to use.

    The one that the variable DQ_MARINE_CHROMIUM or else CHROME names, by its name or path; else the first one of
    `CHROMIUM_NAMES` on the path for programs; else an application of macOS.

    Raises:
        MissingDependencyError: there is none, or the variable names no program.
    """
    for variable in CHROMIUM_VARIABLES:
        named = os.environ.get(variable)
        if named:
            return _named_program(variable, named)
    applications = [str(folder / inside) for folder in APPLICATION_FOLDERS for inside in APPLICATIONS]
    for name in (*CHROMIUM_NAMES, *applications):
        found = shutil.which(name)
        if found:
            return found
    raise MissingDependencyError(
        "pictures without a display need a Chromium or Chrome, and none is installed; on Debian install it with: "
        f"apt-get install chromium, or let {' or '.join(CHROMIUM_VARIABLES)} name its executable"
    )


def _named_program(variable: str, named: str) -> str:
    found = shutil.which(os.path.expanduser(named))
    if not found:
        raise MissingDependencyError(
            f"pictures without a display need a Chromium or Chrome, and {variable} = {named!r} is no program; let it "
            "name the executable, or unset it so that an installed one is looked for"
        )
    return found


class HeadlessBrowser:
    """A Chromium of its own that shows one page, with a profile that is removed at the end.

    Attributes:
        profile: folder of the temporary profile.
    """

    def __init__(self, url: str, width: int, height: int, *, extra_flags: Sequence[str] = ()) -> None:
        """Start Chromium.

        Args:
            url: the page to show.
            width: of the window [pixels].
            height: of the window [pixels]; the page's own area may be lower.
            extra_flags: further command-line flags.

        Raises:
            MissingDependencyError: there is no Chromium.
        """
        executable = find_chromium()
        remove_abandoned_profiles()
        self.profile, lock = new_profile()
        # The address is a secret, and arguments can be read by every user of the computer; this folder cannot.
        start = self.profile / "start.html"
        start.write_text(f"<script>location.replace({json.dumps(url)})</script>", encoding="utf-8")
        # Chromium's sandbox refuses to run for root.
        sandbox = ["--no-sandbox"] if os.geteuid() == 0 else []
        self._process = subprocess.Popen(  # noqa: S603
            [
                executable,
                *QUIET_FLAGS,
                *sandbox,
                f"--user-data-dir={self.profile}",
                f"--window-size={width},{height}",
                *extra_flags,
                start.as_uri(),
            ],
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        self._stop = weakref.finalize(self, _stop, self._process, self.profile, lock, os.getpid())

    @property
    def pid(self) -> int:
        """Process number of Chromium's main process, and of its process group."""
        return self._process.pid

    @property
    def running(self) -> bool:
        """Whether Chromium's main process is alive."""
        return self._process.poll() is None

    def close(self) -> None:
        """End Chromium with all its helpers and remove its profile. May be called again."""
        self._stop()


def new_profile() -> tuple[Path, FileLock]:
    """Return a folder for a profile, and the lock that its owner holds as long as it lives."""
    profile = Path(tempfile.mkdtemp(prefix=PROFILE_PREFIX))
    # The lock gets its name once it is held: in between, other processes would take the profile for an abandoned one.
    lock = FileLock(profile / f"{OWNER_FILE}.new")
    (profile / f"{OWNER_FILE}.new").rename(profile / OWNER_FILE)
    return profile, lock


def remove_abandoned_profiles() -> None:
    """Remove what browsers left behind whose owner was killed before it could end them.

    A profile without a lock has only just been made.
    """
    for profile in Path(tempfile.gettempdir()).glob(f"{PROFILE_PREFIX}*"):
        if (profile / OWNER_FILE).is_file() and is_free(profile / OWNER_FILE):
            shutil.rmtree(profile, ignore_errors=True)


def _stop(process: subprocess.Popen[bytes], profile: Path, lock: FileLock, owner: int) -> None:
    """Kill Chromium's process group, wait for it, and remove the profile."""
    # A forked child inherits the viewer object, but the browser stays its parent's.
    if os.getpid() != owner:
        return
    with contextlib.suppress(ProcessLookupError):  # everything has ended by itself
        os.killpg(process.pid, signal.SIGKILL)
    process.wait()
    shutil.rmtree(profile, ignore_errors=True)
    lock.release()
