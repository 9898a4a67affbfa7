"""A headless Chromium, driven by its DevTools protocol over a pipe.

No driver and no package is needed: Chromium reads JSON messages from file descriptor 3
and writes to 4, each ended by a null byte.
"""

from __future__ import annotations

import json
import os
import select
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from types import TracebackType
from typing import Any

#: Names under which Debian and others install it.
NAMES = ("chromium", "chromium-browser", "google-chrome")
EXECUTABLE = next(filter(None, map(shutil.which, NAMES)), None)
#: Entries of the console that are faults.
BAD = ("error", "warning", "assert")
#: A browser that is silent as long as this is broken (seconds).
PATIENCE = 120

_QUIET = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--remote-debugging-pipe",
)

#: Put the ends of the pipes where Chromium looks for them, by way of numbers that are
#: neither.
_START = """\
import fcntl, os, sys
ends = [fcntl.fcntl(int(end), fcntl.F_DUPFD, 10) for end in sys.argv[1:3]]
for place, end in zip((3, 4), ends):
    os.dup2(end, place)
os.execv(sys.argv[3], sys.argv[3:])
"""


class Chromium:
    """A browser with one tab; a context manager that ends it."""

    def __init__(self) -> None:
        """Start it."""
        assert EXECUTABLE
        self._profile = tempfile.TemporaryDirectory(ignore_cleanup_errors=True)
        read_by_it, self._out = os.pipe()
        self._in, written_by_it = os.pipe()
        self._process = subprocess.Popen(
            [
                *(sys.executable, "-c", _START, str(read_by_it), str(written_by_it)),
                *(EXECUTABLE, *_QUIET, f"--user-data-dir={self._profile.name}"),
            ],
            pass_fds=(read_by_it, written_by_it),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        os.close(read_by_it)
        os.close(written_by_it)
        self._buffer = b""
        self._number = 0
        self._session: str | None = None
        self.events: list[dict[str, Any]] = []

    def __enter__(self) -> Chromium:
        """Open its tab."""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log", "Network"):
            self.call(f"{domain}.enable")
        return self

    def call(self, method: str, **parameters: Any) -> dict[str, Any]:
        """Call a method and wait for its answer; events that come are kept."""
        self._number += 1
        message = {"id": self._number, "method": method, "params": parameters}
        if self._session:
            message["sessionId"] = self._session
        os.write(self._out, json.dumps(message).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._number:
                assert "error" not in answer, (method, answer["error"])
                return answer["result"]
            self.events.append(answer)

    def wait_for(self, method: str) -> dict[str, Any]:
        """Wait for an event that has not come yet or was not yet asked for."""
        while True:
            for event in self.events:
                if event.get("method") == method:
                    return event
            self.events.append(self._next())

    def evaluate(self, expression: str) -> Any:
        """Run JavaScript in the page and give its value."""
        answer = self.call(
            "Runtime.evaluate",
            expression=expression,
            returnByValue=True,
            awaitPromise=True,
        )
        assert "exceptionDetails" not in answer, answer["exceptionDetails"]
        return answer["result"].get("value")

    def open(self, page: Path, width: int, height: int, scheme: str = "light") -> None:
        """Open a file in a window of a size, in a system of light or dark colours."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=1,
            mobile=width < 600,
        )
        feature = {"name": "prefers-color-scheme", "value": scheme}
        self.call("Emulation.setEmulatedMedia", features=[feature])
        self.call("Page.navigate", url="about:blank")
        self.evaluate("1")
        self.events.clear()
        opened = self.call("Page.navigate", url=page.resolve().as_uri())
        assert not opened.get("errorText"), (page, opened["errorText"])
        self.wait_for("Page.loadEventFired")
        # Images are laid out when they are decoded, and all that follows is measured.
        self.evaluate(
            "Promise.all([...document.images].map((i) => i.decode().catch(() => 0)))"
            ".then(() => 0)"
        )

    def complaints(self) -> list[str]:
        """List errors of the console and exceptions since the page was opened."""
        return [said for said in map(_complaint, self.events) if said]

    def fetched(self) -> list[str]:
        """List what the page asked for, itself and what stands inside it aside."""
        sent = [
            e for e in self.events if e.get("method") == "Network.requestWillBeSent"
        ]
        urls = [event["params"]["request"]["url"] for event in sent[1:]]
        return [url for url in urls if not url.startswith("data:")]

    def _next(self) -> dict[str, Any]:
        end = time.monotonic() + PATIENCE
        while b"\0" not in self._buffer:
            left = max(0.0, end - time.monotonic())
            ready, _, _ = select.select([self._in], [], [], left)
            assert ready, f"no answer from {EXECUTABLE}"
            part = os.read(self._in, 1 << 20)
            assert part, f"{EXECUTABLE} ended with status {self._process.poll()}"
            self._buffer += part
        message, _, self._buffer = self._buffer.partition(b"\0")
        return json.loads(message)

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        """End it, as it ends itself where its pipe is closed."""
        os.close(self._out)
        try:
            self._process.wait(timeout=20)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        os.close(self._in)
        self._profile.cleanup()


def _complaint(event: dict[str, Any]) -> str:
    """Tell what an event complains of; most do not."""
    about = event.get("params", {})
    method = event.get("method")
    if method == "Runtime.exceptionThrown":
        return str(about["exceptionDetails"])
    if method == "Runtime.consoleAPICalled" and about["type"] in BAD:
        return str(about["args"])
    if method == "Log.entryAdded" and about["entry"]["level"] in BAD:
        return str(about["entry"]["text"])
    return ""
