"""Play `mesh.glb` with three.js in a headless Chromium, and return where its vertices are.

The page loads the file with GLTFLoader, lets an AnimationMixer set weights and nodes at every
frame's time, and asks three.js for each vertex in the world. Three.js is not part of the package:
`npm install three` in any folder gives `node_modules/three`, which is what `--three` of
`bench.formats` takes. Nothing is asked of the network but this process.
"""

import contextlib
import http.server
import json
import os
import signal
import subprocess
import tempfile
import threading
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

import numpy as np

PAGE = Path(__file__).with_suffix(".html")
KINDS = {".html": "text/html", ".js": "text/javascript", ".json": "application/json"}
# the flags past --headless keep it from looking for its maker's servers
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
# without a word from the page for so long, it hangs [s]
PATIENCE = 120


class Played(NamedTuple):
    """What three.js made of a file.

    Attributes
    ----------
    times : (T,) float array, of the keys in the file [s]
    positions : (T, V, 3) float array, in the world, at the times that were asked for
    revision : of three.js
    """

    times: np.ndarray
    positions: np.ndarray
    revision: str


class _Talk:
    """What page and process tell each other."""

    def __init__(self, glb: Path, three: Path, times: np.ndarray):
        """Take the file, the folder of three.js and the times to play."""
        self.three = three.resolve()
        asked = json.dumps(np.asarray(times).tolist()).encode()
        self.known = {"/": (PAGE.read_bytes(), ".html"), "/times.json": (asked, ".json")}
        self.known["/mesh.glb"] = glb.read_bytes(), ".glb"
        self.frames: list[np.ndarray] = []
        self.end: tuple[str, str] | None = None
        self.word = threading.Event()

    def answer(self, where: str) -> tuple[bytes, str] | None:
        """Return the bytes and ending of what the page asks for."""
        if where in self.known:
            return self.known[where]
        path = (self.three / where.removeprefix("/three/")).resolve()
        if where.startswith("/three/") and path.is_relative_to(self.three) and path.is_file():
            return path.read_bytes(), path.suffix
        return None

    def hear(self, where: str, body: bytes) -> None:
        """Take what the page sends."""
        if where == "/frame":
            self.frames.append(np.frombuffer(body, "<f8").reshape(-1, 3))
        else:
            self.end = where, body.decode()
        self.word.set()


def _handler(talk: _Talk) -> type[http.server.BaseHTTPRequestHandler]:
    """Return the handler of a server for one talk."""

    class Handler(http.server.BaseHTTPRequestHandler):
        def _reply(self, status: int, body: bytes, ending: str) -> None:
            self.send_response(status)
            self.send_header("Content-Type", KINDS.get(ending, "application/octet-stream"))
            self.send_header("Content-Length", str(len(body)))
            self.end_headers()
            self.wfile.write(body)

        def do_GET(self) -> None:  # a name that http.server asks for
            found = talk.answer(self.path)
            self._reply(200, *found) if found else self._reply(404, b"", "")

        def do_POST(self) -> None:
            talk.hear(self.path, self.rfile.read(int(self.headers["Content-Length"])))
            self._reply(200, b"", "")

        def log_message(self, *_: object) -> None:
            """Say nothing of each request."""

    return Handler


@contextlib.contextmanager
def _browser(chromium: str, address: str) -> Iterator[None]:
    """Run a browser with a profile of its own; end it and all that it started."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as profile:
        started = subprocess.Popen(
            [chromium, *FLAGS, f"--user-data-dir={profile}", address],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )
        try:
            yield
        finally:
            with contextlib.suppress(ProcessLookupError):
                os.killpg(started.pid, signal.SIGKILL)
            started.wait()


def play(glb: Path, three: Path, chromium: str, times: np.ndarray) -> Played:
    """Play a file at the times (T,) [s] of its frames.

    Raises
    ------
    RuntimeError
        if the page fails or falls silent
    """
    if not (three / "build" / "three.module.js").is_file():
        raise RuntimeError(f"{three} is not the folder of three.js that npm installs")
    talk = _Talk(glb, three, times)
    server = http.server.ThreadingHTTPServer(("127.0.0.1", 0), _handler(talk))
    threading.Thread(target=server.serve_forever, daemon=True).start()
    try:
        with _browser(chromium, f"http://127.0.0.1:{server.server_port}/"):
            while talk.end is None and talk.word.wait(PATIENCE):
                talk.word.clear()
    finally:
        server.shutdown()
        server.server_close()
    where, said = talk.end or ("/failed", f"no word for {PATIENCE} s")
    if where != "/played":
        raise RuntimeError(f"three.js: {said}")
    document = json.loads(said)
    return Played(np.array(document["times"]), np.array(talk.frames), document["revision"])
