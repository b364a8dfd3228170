"""A Chromium without a window, that turns pages into PDF and figures into PNG and SVG.

It is driven by its DevTools protocol (https://chromedevtools.github.io/devtools-protocol/) over a
pair of pipes: messages in JSON, each ended by a zero byte. Nothing is asked of a network.
"""

from __future__ import annotations

import base64
import json
import os
import select
import shutil
import subprocess
import tempfile
import time
from collections.abc import Sequence
from pathlib import Path
from types import TracebackType
from typing import Any

VARIABLE = "RAILPATCH_BROWSER"
NAMES = (
    "chromium",
    "chromium-browser",
    "google-chrome",
    "google-chrome-stable",
    "chrome",
    "msedge",
)
PATIENCE = 60.0  # s, for one answer
_FLAGS = (
    "--headless",
    "--remote-debugging-pipe",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-dev-shm-usage",
    "--disable-extensions",
    "--disable-background-networking",
    "--hide-scrollbars",
    "--no-first-run",
)


class BrowserError(RuntimeError):
    """There is no browser, or it did not do what was asked."""


def find_browser() -> str:
    """Its command: that of the environment's RAILPATCH_BROWSER, or the first known one."""
    named = os.environ.get(VARIABLE)
    if named:
        found = shutil.which(named)
        if found is None:
            raise BrowserError(f"{VARIABLE}: value is {named!r}, allowed a command that exists")
        return found
    for name in NAMES:
        if found := shutil.which(name):
            return found
    raise BrowserError(
        f"no browser was found: pictures and PDF need one of {', '.join(NAMES)} on the path, or "
        f"another of their kind named by {VARIABLE}"
    )


class Browser:
    """One process with one page; to be used in a ``with``."""

    def __init__(self, command: str | None = None) -> None:
        self._command = command or find_browser()
        self._count = 0
        self._rest = b""
        self.events: list[dict[str, Any]] = []

    def __enter__(self) -> Browser:
        if os.name != "posix":
            raise BrowserError("pictures and PDF are made on Linux and macOS alone")
        import fcntl  # no other system has it

        self._folder = tempfile.TemporaryDirectory(prefix="railpatch", ignore_cleanup_errors=True)
        theirs_in, self._to = os.pipe()
        self._from, theirs_out = os.pipe()
        # the browser reads its descriptor 3 and writes 4: from above these
        high = [fcntl.fcntl(fd, fcntl.F_DUPFD_CLOEXEC, 10) for fd in (theirs_in, theirs_out)]
        try:
            self._process = subprocess.Popen(
                [self._command, *_FLAGS, f"--user-data-dir={self._folder.name}", "about:blank"],
                preexec_fn=lambda: (os.dup2(high[0], 3), os.dup2(high[1], 4)),
                pass_fds=(3, 4),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
        finally:
            for fd in (theirs_in, theirs_out, *high):
                os.close(fd)
        self._session = ""
        target = self.call("Target.createTarget", url="about:blank")["targetId"]
        attached = self.call("Target.attachToTarget", targetId=target, flatten=True)
        self._session = attached["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._session = ""
        try:
            self._send("Browser.close", {})
            self._process.wait(5)
        except (OSError, subprocess.TimeoutExpired):
            self._process.kill()
            self._process.wait()
        os.close(self._to)
        os.close(self._from)
        self._folder.cleanup()

    def call(self, method: str, **params: Any) -> dict[str, Any]:
        """One command and its answer. Raises BrowserError."""
        number = self._send(method, params)
        end = time.monotonic() + PATIENCE
        while True:
            message = self._read(end, method)
            if message.get("id") == number:
                if "error" in message:
                    raise BrowserError(f"{method}: {message['error'].get('message')}")
                return message["result"]
            if "method" in message:
                self.events.append(message)

    def size(self, width: int, height: int, *, scale: float = 1.0) -> None:
        """px of the window; scale: pixels of a picture for one of them."""
        self.call(
            "Emulation.setDeviceMetricsOverride",
            width=width,
            height=height,
            deviceScaleFactor=scale,
            mobile=False,
        )

    def media(self, *, dark: bool = False, printed: bool = False) -> None:
        """What the style of a page asks for."""
        scheme = {"name": "prefers-color-scheme", "value": "dark" if dark else "light"}
        medium = "print" if printed else ""
        self.call("Emulation.setEmulatedMedia", media=medium, features=[scheme])

    def open(self, path: Path) -> None:
        """A page, until all of it is drawn."""
        self.events.clear()
        self.call("Page.navigate", url=path.absolute().as_uri())
        end = time.monotonic() + PATIENCE
        while not any(event["method"] == "Page.loadEventFired" for event in self.events):
            self.events.append(self._read(end, "load"))
        self.run("Promise.resolve(window.drawn).then(() => 0)")

    def run(self, script: str) -> Any:
        """The value of a script, or of what it promises. Raises BrowserError."""
        found = self.call(
            "Runtime.evaluate", expression=script, awaitPromise=True, returnByValue=True
        )
        if "exceptionDetails" in found:
            details = found["exceptionDetails"]
            text = details.get("exception", {}).get("description") or details.get("text")
            raise BrowserError(f"the page: {text}")
        return found["result"].get("value")

    def problems(self) -> list[str]:
        """Errors and warnings of the page since it was opened."""
        found = []
        for event in self.events:
            params = event.get("params", {})
            if event["method"] == "Runtime.exceptionThrown":
                details = params["exceptionDetails"]
                found.append(details.get("exception", {}).get("description") or details["text"])
            elif event["method"] == "Runtime.consoleAPICalled":
                if params["type"] in ("error", "warning", "assert"):
                    found.append(" ".join(str(a.get("value", a)) for a in params["args"]))
            elif event["method"] == "Log.entryAdded" and params["entry"]["level"] == "error":
                found.append(params["entry"]["text"])
        return found

    def picture(self, *, whole: bool = False, clip: Sequence[float] | None = None) -> bytes:
        """PNG of what is in the window, of the whole page, or of x, y, width, height of it."""
        more: dict[str, Any] = {}
        if clip is not None:
            names = ("x", "y", "width", "height")
            more["clip"] = dict(zip(names, clip, strict=True)) | {"scale": 1}
        found = self.call(
            "Page.captureScreenshot", captureBeyondViewport=whole or clip is not None, **more
        )
        return base64.b64decode(found["data"])

    def pdf(self) -> bytes:
        """Of the page, with the margins of its style, all that is folded left folded."""
        found = self.call("Page.printToPDF", printBackground=True, preferCSSPageSize=True)
        return base64.b64decode(found["data"])

    def _send(self, method: str, params: dict[str, Any]) -> int:
        self._count += 1
        message: dict[str, Any] = {"id": self._count, "method": method, "params": params}
        if self._session:
            message["sessionId"] = self._session
        left = json.dumps(message).encode() + b"\0"
        try:
            while left:
                left = left[os.write(self._to, left) :]
        except OSError:
            raise BrowserError(f"{self._command} ended before it was asked to") from None
        return self._count

    def _read(self, end: float, asked: str) -> dict[str, Any]:
        while b"\0" not in self._rest:
            wait = end - time.monotonic()
            if wait <= 0 or not select.select([self._from], [], [], wait)[0]:
                raise BrowserError(f"{self._command} did not answer to {asked} in {PATIENCE:g} s")
            part = os.read(self._from, 1 << 20)
            if not part:
                raise BrowserError(f"{self._command} ended before it was asked to")
            self._rest += part
        text, self._rest = self._rest.split(b"\0", 1)
        return json.loads(text)
