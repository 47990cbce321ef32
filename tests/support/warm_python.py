"""Python processes that import nothing anew: each is forked from one that has imported it all.

A node's process imports for a third of a second, a studio's for one, longer than most tests keep
them busy. `start_python` forks one where it can (on Linux); elsewhere, and for tests of the start
itself, it starts Python as usual.

`python -m tests.support.warm_python FD MODULE...` imports the modules and is what processes are
forked from. It ends with FD.
"""

from __future__ import annotations

import atexit
import gc
import io
import json
import os
import runpy
import select
import signal
import socket
import subprocess
import sys
import threading
import time
import types
from functools import cache
from importlib import import_module
from typing import IO, TYPE_CHECKING, Any

from tests.support.wire import PATIENCE_S

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

NODE = (
    "rosbags.typesys.stores.ros2_humble",
    "rosbags.typesys.stores.ros2_jazzy",
    "ruamel.yaml",
    "studio.cli",
    "studio.cli.graph",
    "studio.course.demos",
    "studio.course.processes",
    "studio.course.running",
    "studio.ros.client",
    "studio.ros.types.convert",
    "studio.tf.rotations",
)
"""What nodes and command lines import; none is run itself, reads the environment or has threads."""
STUDIO = (*NODE, "studio.cli.serving", "studio.server.launch")
"""What the studio imports."""
_POLL_S = 0.005
_REQUEST_BYTES = 1 << 18
_AS_AT_THE_START = ("PYTHONPATH", "PYTHONHOME", "PYTHONIOENCODING", "PYTHONWARNINGS")


def start_python(
    words: Sequence[str],
    environment: Mapping[str, str],
    *,
    stdin: int = subprocess.DEVNULL,
    stderr: int = subprocess.STDOUT,
    imported: tuple[str, ...] = NODE,
) -> WarmProcess | subprocess.Popen[str]:
    """Start `[sys.executable, "-m" or "-c", ...]` in a session of its own, its output in a pipe.

    Args:
        words: The command.
        environment: All variables that it has.
        stdin: As for a Popen.
        stderr: As for a Popen.
        imported: The modules that it finds imported; if none, it is started as usual.
    """
    if imported and _can_fork(words, environment):
        return _source(imported).started(list(words[1:]), environment, stdin, stderr)
    return subprocess.Popen(
        words,
        env=environment,
        stdin=stdin,
        stdout=subprocess.PIPE,
        stderr=stderr,
        text=True,
        start_new_session=True,
    )


def _can_fork(words: Sequence[str], environment: Mapping[str, str]) -> bool:
    as_now = all(environment.get(name) == os.environ.get(name) for name in _AS_AT_THE_START)
    return (
        sys.platform == "linux"
        and words[0] == sys.executable
        and words[1] in {"-c", "-m"}
        and as_now
    )


class WarmProcess:
    """As much of a Popen as tests ask of it."""

    def __init__(
        self, source: _Source, pid: int, pipes: tuple[IO[str] | None, IO[str], IO[str] | None]
    ) -> None:
        self.pid = pid
        self.stdin, self.stdout, self.stderr = pipes
        self._source = source

    def poll(self) -> int | None:
        """Its code if it has ended, negative if a signal ended it."""
        return self._source.code_of(self.pid)

    def wait(self, timeout: float = PATIENCE_S) -> int:
        """Wait for its end; its code.

        Raises:
            subprocess.TimeoutExpired: It did not end within so many seconds.
        """
        end_s = time.monotonic() + timeout
        while (code := self.poll()) is None:
            if time.monotonic() > end_s:
                raise subprocess.TimeoutExpired(f"process {self.pid}", timeout)
            time.sleep(_POLL_S)
        return code

    def send_signal(self, number: int) -> None:
        """Unless it has ended."""
        if self.poll() is None:
            os.kill(self.pid, number)

    def terminate(self) -> None:
        """Send SIGTERM, unless it has ended."""
        self.send_signal(signal.SIGTERM)

    def kill(self) -> None:
        """Send SIGKILL, unless it has ended."""
        self.send_signal(signal.SIGKILL)


class _Source:
    """The process that others are forked from, and the codes of those that have ended."""

    def __init__(self, imported: tuple[str, ...]) -> None:
        ours, theirs = socket.socketpair(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        with theirs:
            self._process = subprocess.Popen(
                [sys.executable, "-m", __name__, str(theirs.fileno()), *imported],
                env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},  # a fork has one thread
                stdin=subprocess.DEVNULL,
                pass_fds=[theirs.fileno()],
                start_new_session=True,
            )
        self._socket = ours
        self._codes: dict[int, int] = {}
        self._lock = threading.Lock()
        atexit.register(self._close)

    def started(
        self, words: list[str], environment: Mapping[str, str], stdin: int, stderr: int
    ) -> WarmProcess:
        """Fork one, with pipes where a Popen has them."""
        ours: list[IO[str] | None] = [None, None, None]
        theirs: list[int] = []
        for number, wanted in enumerate((stdin, subprocess.PIPE, stderr)):
            if wanted == subprocess.PIPE:
                reading, writing = os.pipe()
                kept, given = (writing, reading) if number == 0 else (reading, writing)
                ours[number] = open(kept, "w" if number == 0 else "r", encoding="utf-8")  # noqa: PTH123, SIM115
            elif wanted == subprocess.STDOUT:
                given = os.dup(theirs[1])
            else:
                given = os.open(os.devnull, os.O_RDWR) if wanted < 0 else os.dup(wanted)
            theirs.append(given)
        request = {"words": words, "environment": dict(environment), "folder": os.getcwd()}  # noqa: PTH109
        with self._lock:
            socket.send_fds(self._socket, [json.dumps(request).encode()], theirs)
            for one in theirs:
                os.close(one)
            while (pid := self._take().get("started")) is None:
                pass
            self._codes.pop(pid, None)  # of one before that had its number
        stdin_pipe, stdout, stderr_pipe = ours
        assert stdout is not None
        return WarmProcess(self, pid, (stdin_pipe, stdout, stderr_pipe))

    def code_of(self, pid: int) -> int | None:
        with self._lock:
            while pid not in self._codes and select.select([self._socket], [], [], 0)[0]:
                self._take()
            return self._codes.get(pid)

    def _take(self) -> dict[str, int]:
        """The next thing that it says."""
        said = self._socket.recv(_REQUEST_BYTES)
        assert said, "the process that others are forked from has ended"
        told: dict[str, int] = json.loads(said)
        if "ended" in told:
            self._codes[told["ended"]] = told["code"]
        return told

    def _close(self) -> None:
        self._socket.close()
        self._process.wait()


_source = cache(_Source)


def _serve(asked: socket.socket) -> dict[str, Any] | None:
    """Fork for each request: in the fork, what it is to run; None once nobody can ask any more."""
    reading, writing = os.pipe2(os.O_NONBLOCK | os.O_CLOEXEC)
    signal.signal(signal.SIGCHLD, _be_woken)
    signal.set_wakeup_fd(writing)
    while True:
        ready, _, _ = select.select([asked, reading], [], [])
        if reading in ready:
            os.read(reading, 4096)
            _tell_who_ended(asked)
        if asked in ready:
            request, files, _, _ = socket.recv_fds(asked, _REQUEST_BYTES, 3)
            if not request:
                return None
            if not os.fork():
                signal.set_wakeup_fd(-1)
                signal.signal(signal.SIGCHLD, signal.SIG_DFL)
                os.setsid()
                asked.send(json.dumps({"started": os.getpid()}).encode())  # and may be signalled
                for one in (reading, writing, asked.detach()):
                    os.close(one)
                return {**json.loads(request), "files": files}
            for one in files:
                os.close(one)


def _be_woken(_number: int, _frame: object) -> None:
    """A signal with a handler writes to the pipe that is waited for."""


def _tell_who_ended(asked: socket.socket) -> None:
    while True:
        try:
            pid, status = os.waitpid(-1, os.WNOHANG)
        except ChildProcessError:
            return
        if not pid:
            return
        code = os.waitstatus_to_exitcode(status)
        asked.send(json.dumps({"ended": pid, "code": code}).encode())


def _become(files: list[int], folder: str, environment: dict[str, str]) -> None:
    """Make this process what a new Python would be there."""
    for number, one in enumerate(files):
        os.dup2(one, number)
        if one > 2:
            os.close(one)
    os.chdir(folder)
    os.environ.clear()
    os.environ.update(environment)
    unbuffered = bool(environment.get("PYTHONUNBUFFERED"))
    sys.stdin = open(0, encoding="utf-8", closefd=False)  # noqa: SIM115
    sys.stdout = _written(1, unbuffered=unbuffered)
    sys.stderr = _written(2, unbuffered=unbuffered, errors="backslashreplace")


def _written(number: int, *, unbuffered: bool, errors: str = "strict") -> io.TextIOWrapper:
    raw = open(number, "wb", buffering=0 if unbuffered else -1, closefd=False)  # noqa: SIM115
    return io.TextIOWrapper(
        raw, "utf-8", errors, line_buffering=number == 2, write_through=unbuffered
    )


def _run(words: list[str], folder: str) -> None:
    """As the command line of Python does."""
    kind, what, *arguments = words
    if kind == "-m":
        sys.argv, sys.path[0] = ["-m", *arguments], folder
        runpy.run_module(what, run_name="__main__", alter_sys=True)
    else:
        sys.argv, sys.path[0] = ["-c", *arguments], ""
        made = types.ModuleType("__main__")
        sys.modules["__main__"] = made
        exec(compile(what, "<string>", "exec"), made.__dict__)


if __name__ == "__main__":
    for module in sys.argv[2:]:
        import_module(module)
    gc.collect()
    gc.freeze()
    assert len(os.listdir("/proc/self/task")) == 1, "a fork would have one thread of several"  # noqa: PTH208
    if found := _serve(socket.socket(fileno=int(sys.argv[1]))):
        _become(found["files"], found["folder"], found["environment"])
        _run(found["words"], found["folder"])
