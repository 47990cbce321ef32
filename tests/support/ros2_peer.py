"""Real ROS 2: nodes of rclpy on rmw_zenoh_cpp, the `ros2` command and the router rmw_zenohd.

STUDIO_ROS2_PEER names a folder with `unpack.sh`; it is unpacked once for each user of the machine.
Each of these is a process of its own, with the environment of ROS that no other process sees.
"""

from __future__ import annotations

import fcntl
import json
import os
import subprocess
import tempfile
import threading
from contextlib import contextmanager
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import pytest

from studio.ros.wire.endpoints import ProbeResult, parse_endpoint, probe
from tests.support.wire import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

_VARIABLE: Final = "STUDIO_ROS2_PEER"
_NO_PYTHON: Final = "Python 3.11 is needed"
_COPIED: Final = "COPIED_LINE"
_IN_ROS: Final = f'. "$0/env.sh" && eval "${_COPIED}" && exec "$@"'
_ROUTER: Final = '. "$0/env.sh" && real_router'
_END_S: Final = 20.0
_SCRIPT: Final = Path(__file__).with_name("ros2_script.py")


@cache
def ros2_peer() -> Path:
    """The unpacked folder; skips the test without STUDIO_ROS2_PEER or without Python 3.11."""
    named = os.environ.get(_VARIABLE)
    if not named:
        pytest.skip(f"{_VARIABLE} names no folder of a real ROS 2")
    source = Path(named).resolve()
    assert (source / "unpack.sh").is_file(), f"{_VARIABLE} is {named}, which has no unpack.sh"
    folder = Path(tempfile.gettempdir()) / f"studio-ros2-peer-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    assert folder.stat().st_uid == os.getuid(), f"{folder} belongs to somebody else"
    with (folder / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # of several workers, one unpacks and the others wait
        unpacked = subprocess.run(
            ["bash", source / "unpack.sh", folder], capture_output=True, text=True, check=False
        )
    if _NO_PYTHON in unpacked.stderr:
        pytest.skip(unpacked.stderr.strip())
    assert unpacked.returncode == 0, unpacked.stderr
    return folder


class RealNode:
    """A process of `peer.py`, and what it said so far, one dictionary for each line of JSON."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.said: list[dict[str, Any]] = []
        self.lines: list[str] = []
        """Other lines: logs and errors."""
        self._reading = threading.Thread(target=self._read, daemon=True)
        self._reading.start()

    def all_said(self, what: str, **values: object) -> list[dict[str, Any]]:
        """Everything of this kind that it said so far, with these values."""
        wanted = {"what": what, **values}
        return [one for one in list(self.said) if wanted.items() <= one.items()]

    def wait_said(self, what: str, patience_s: float = PATIENCE_S, **values: object) -> Any:  # noqa: ANN401
        """Wait until it says something of this kind with these values; the first of them."""

        def is_there() -> bool:
            return bool(self.all_said(what, **values)) or not self._reading.is_alive()

        wait_until(f"a real node says {what} {values}", is_there, patience_s)
        found = self.all_said(what, **values)
        assert found, f"it ended without {what} {values}: {self.said} {self.lines}"
        return found[0]

    def end(self) -> int:
        """End it as Ctrl-C does, and by force if that lasts too long; its exit code."""
        self.process.terminate()
        try:
            self.process.wait(_END_S)
        except subprocess.TimeoutExpired:
            self.process.kill()
        return self._ended()

    def kill(self) -> int:
        """End it at once, without a word to others; its exit code."""
        self.process.kill()
        return self._ended()

    def _ended(self) -> int:
        code = self.process.wait()
        self._reading.join()
        return code

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as lines:
            for line in lines:
                if line.startswith("{"):
                    self.said.append(json.loads(line))
                else:
                    self.lines.append(line)


@contextmanager
def real_node(
    endpoint: str,
    role: str,
    *options: str,
    environment: Mapping[str, str] | None = None,
    line: str = "",
) -> Generator[RealNode]:
    """A real node until the end of the block; the options are those of `peer.py`.

    `line` is typed in its terminal before it is started, and may set variables of ROS.
    It stays until it is ended, unless the options give `--seconds`. It does not wait for a router:
    `wait_said("ready")` tells that it is made. The end of the block kills it, as rclpy takes
    seconds to end; who wants to see it leave calls `end`.
    """
    options = options if "--seconds" in options else (*options, "--seconds", "0")
    words = ("python3", str(ros2_peer() / "peer.py"), role, *options)
    node = RealNode(_started(_IN_ROS, endpoint, words, {**(environment or {}), _COPIED: line}))
    try:
        yield node
    finally:
        node.kill()


class RealNodes(RealNode):
    """A process of `ros2_script.py`: it does what it is asked to, and says what it hears."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        super().__init__(process)
        self._asked = 0

    def ask(self, do: str, **arguments: object) -> Any:  # noqa: ANN401  # as JSON gives it
        """Have one thing done; its answer. `do` is a method of `Process` in the script."""
        assert self.process.stdin is not None
        self._asked += 1
        line = json.dumps({"do": do, "id": self._asked, **arguments})
        print(line, file=self.process.stdin, flush=True)
        done = self.wait_said("done", id=self._asked)
        assert "error" not in done, done["error"]
        return done["answer"]


@contextmanager
def real_nodes(endpoint: str, environment: Mapping[str, str] | None = None) -> Generator[RealNodes]:
    """Real nodes in one process that do what the test asks for, until the end of the block."""
    words = ("python3", str(_SCRIPT))
    nodes = RealNodes(_started(_IN_ROS, endpoint, words, environment, stdin=subprocess.PIPE))
    try:
        nodes.wait_said("ready")
        yield nodes
    finally:
        nodes.kill()
        nodes.process.communicate()


@contextmanager
def real_router(endpoint: str) -> Generator[subprocess.Popen[str]]:
    """The router rmw_zenohd, listening, until the end of the block."""
    process = _started(_ROUTER, endpoint, (), None, output=subprocess.DEVNULL)
    try:
        place = parse_endpoint(endpoint)
        wait_until("rmw_zenohd listens", lambda: probe(place) is ProbeResult.ZENOH)
        yield process
    finally:
        process.kill()
        process.wait()


@contextmanager
def ros2_process(
    endpoint: str, *words: str, environment: Mapping[str, str] | None = None
) -> Generator[subprocess.Popen[str]]:
    """`ros2 ...` as a process, what it says in one stream, until the end of the block."""
    process = _started(_IN_ROS, endpoint, ("ros2", *words), environment)
    try:
        yield process
    finally:
        process.kill()
        process.communicate()


def ros2(endpoint: str, *words: str, timeout_s: float = PATIENCE_S) -> str:
    """What `ros2 ...` says, errors too; it must end in time.

    Lines that ask about the graph take `--no-daemon`: else a daemon outlives the test.
    """
    with ros2_process(endpoint, *words) as process:
        said, _ = process.communicate(timeout=timeout_s)
    return said


def real_program(endpoint: str, file: Path) -> subprocess.CompletedProcess[str]:
    """Run a Python file with the real rclpy; it must end in time."""
    process = started_program(endpoint, file)
    try:
        out, err = process.communicate(timeout=PATIENCE_S)
    finally:
        process.kill()
        process.wait()
    return subprocess.CompletedProcess(process.args, process.returncode, out, err)


def started_program(endpoint: str, file: Path) -> subprocess.Popen[str]:
    """Start a Python file with the real rclpy."""
    words = ("python", str(file))
    return _started(_IN_ROS, endpoint, words, None, errors=subprocess.PIPE)


def _started(  # noqa: PLR0913, PLR0917
    script: str,
    endpoint: str,
    words: tuple[str, ...],
    environment: Mapping[str, str] | None,
    output: int = subprocess.PIPE,
    stdin: int = subprocess.DEVNULL,
    errors: int = subprocess.STDOUT,
) -> subprocess.Popen[str]:
    unwanted = ("ROS", "ZENOH", "RMW", "AMENT", "PYTHON", "LD_")
    kept = {name: value for name, value in os.environ.items() if not name.startswith(unwanted)}
    return subprocess.Popen(
        ["bash", "-c", script, str(ros2_peer()), *words],
        env={
            **kept,
            "ROUTER_ENDPOINT": endpoint,
            "ZENOH_ROUTER_CHECK_ATTEMPTS": "-1",
            "RUST_LOG": "error",  # of zenoh: it warns of a slow start among what `ros2` says
            **(environment or {}),
        },
        stdin=stdin,
        stdout=output,
        stderr=errors,
        text=True,
        errors="replace",
    )
