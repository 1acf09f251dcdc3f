"""Chromium, driven over a pipe by the protocol of its developer tools: no package stands between."""

import base64
import json
import os
import shutil
import subprocess
import tempfile
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
_FLAGS = [
    *("--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"),
    *("--disable-background-networking", "--disable-component-update", "--disable-sync"),
    *("--disable-extensions", "--hide-scrollbars", "--remote-debugging-pipe"),
]
_TROUBLE = ("Runtime.exceptionThrown", "Runtime.consoleAPICalled", "Log.entryAdded")


class Browser:
    """One page of a browser; `console` has everything that it was told."""

    def __init__(self, send: int, receive: int) -> None:
        self._send, self._receive = send, receive
        self._rest, self._count, self._session = b"", 0, ""
        self.console: list[str] = []
        self.window: tuple[int, dict[str, str]] | None = None
        page = self.call("Target.createTarget", url="about:blank")["targetId"]
        found = self.call("Target.attachToTarget", targetId=page, flatten=True)
        self._session = found["sessionId"]
        for domain in ("Page", "Runtime", "Log"):
            self.call(f"{domain}.enable")

    def call(self, method: str, **given: Any) -> dict[str, Any]:
        """What the browser answers to a command."""
        self._count += 1
        message = {"id": self._count, "method": method, "params": given}
        to = {"sessionId": self._session} if self._session else {}
        os.write(self._send, json.dumps(message | to).encode() + b"\0")
        while True:
            answer = self._next()
            if answer.get("id") == self._count:
                if "error" in answer:
                    raise RuntimeError(f"{method}: {answer['error']}")
                return dict(answer["result"])

    def _next(self) -> dict[str, Any]:
        while b"\0" not in self._rest:
            if not (more := os.read(self._receive, 1 << 20)):
                raise RuntimeError("the browser has gone")
            self._rest += more
        text, _, self._rest = self._rest.partition(b"\0")
        message = dict(json.loads(text))
        if message.get("method") in _TROUBLE:
            self.console.append(json.dumps(message["params"])[:600])
        return message

    def open(self, path: Path, width: int, height: int = 900, **media: str) -> None:
        """Opens a file in a window of so many pixels, and waits for its first figures."""
        self.window = width, media
        size = {"width": width, "height": height, "deviceScaleFactor": 1, "mobile": False}
        features = [
            {"name": name.replace("_", "-"), "value": value} for name, value in media.items()
        ]
        self.call("Emulation.setDeviceMetricsOverride", **size)
        self.call("Emulation.setEmulatedMedia", features=features)
        self.call("Page.navigate", url="about:blank")
        self.console.clear()
        self.call("Page.navigate", url=path.resolve().as_uri())
        self.wait("document.readyState === 'complete' && document.documentElement.dataset.drawn")

    def run(self, script: str) -> Any:
        """Value of an expression in the page; a promise is waited for."""
        given = {"expression": script, "returnByValue": True, "awaitPromise": True}
        answer = self.call("Runtime.evaluate", **given)
        if "exceptionDetails" in answer:
            raise AssertionError(json.dumps(answer["exceptionDetails"]))
        return answer["result"].get("value")

    def wait(self, script: str, seconds: float = 60.0) -> Any:
        """Value of an expression as soon as it is true."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if found := self.run(script):
                return found
            time.sleep(0.05)
        raise AssertionError(f"not within {seconds:g} s: {script}; console: {self.console}")

    def save_to(self, folder: Path) -> None:
        """Puts what the page saves into a folder."""
        self.call("Page.setDownloadBehavior", behavior="allow", downloadPath=str(folder))

    def saved(self, path: Path, seconds: float = 30.0) -> bytes:
        """A file that the page saves, as soon as it is there."""
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            if path.exists() and (content := path.read_bytes()):
                return content
            time.sleep(0.05)
        raise AssertionError(f"{path.name} was not saved; console: {self.console}")

    def picture(self, path: Path, top: int = 0, height: int = 900) -> None:
        """A strip of the page as a PNG."""
        width = self.run("innerWidth")
        clip = {"x": 0, "y": top, "width": width, "height": height, "scale": 1}
        found = self.call("Page.captureScreenshot", captureBeyondViewport=True, clip=clip)
        path.write_bytes(base64.b64decode(found["data"]))

    def printed(self) -> bytes:
        """The page on paper of A4, as a PDF."""
        size = {"paperWidth": 210 / 25.4, "paperHeight": 297 / 25.4}
        asked = {"preferCSSPageSize": True, "printBackground": True}
        return base64.b64decode(self.call("Page.printToPDF", **size, **asked)["data"])


@contextmanager
def browser() -> Iterator[Browser]:
    """A browser of its own, which leaves nothing behind."""
    assert CHROMIUM
    to_read, send = os.pipe()
    receive, to_write = os.pipe()
    profile = tempfile.mkdtemp()
    # The browser reads commands from descriptor 3 and answers on 4.
    command = ["bash", "-c", f'exec "$0" "$@" 3<&{to_read} 4>&{to_write}', CHROMIUM]
    process = subprocess.Popen(
        [*command, *_FLAGS, f"--user-data-dir={profile}", "about:blank"],
        pass_fds=(to_read, to_write),
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    os.close(to_read)
    os.close(to_write)
    try:
        yield Browser(send, receive)
    finally:
        os.close(send)
        os.close(receive)
        process.kill()
        process.wait()
        shutil.rmtree(profile, ignore_errors=True)
