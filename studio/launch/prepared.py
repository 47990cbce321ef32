"""The prepared process of a launch: imports what nodes in Python need, and forks them.

A node's start is mostly imports, and ten nodes need the same ones. One process imports them, when
the launch begins, and makes each node by fork; code of the user is imported after it. A
node becomes a child of the launch, as if the launch had started it. OpenBLAS ends its threads
before a fork by itself, and nothing else has one: no Zenoh session is open.

The process also is the leash of the launch: when that is gone without having ended its group
(SIGKILL), all that bears its mark is ended.

Linux alone has what this needs; elsewhere, and where the prepared process has failed, `start` gives
None, and a node is started as any program.
"""

from __future__ import annotations

import asyncio
import contextlib
import gc
import importlib
import json
import os
import runpy
import secrets
import signal
import socket
import subprocess
import sys
import time
from typing import TYPE_CHECKING, Any, Final, Self

from studio.launch.watchdog import MARK, marked_processes, take_up_orphans
from studio.ros.names import INTERFACES_VARIABLE

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_MODULES: Final = (
    "studio.importable.running",
    "studio.ros.client",
    "rosbags.serde.primitives",
    "encodings.idna",
)
_AS_STARTED: Final = (
    *("PYTHON", "LD_", "LC_", "LANG", "TZ", "MALLOC_", "GLIBC_", "OPENBLAS_", "OMP_"),
    *("ROS_DISTRO", INTERFACES_VARIABLE),
)
"""Variables that are read when a process starts, or here: who has other ones is not forked."""
_ROOM: Final = 4096
"""Bytes of the prepared process's command line, in which a node's is written: `ps` shows it."""
_IMPORT, _FORK = b"i", b"f"
_ENDS_S: Final = 2.0
"""So long nodes may take to end by themselves when the launch is gone."""


class ForkedProcess:
    """A node that the prepared process has made: as `asyncio.subprocess.Process`, in short."""

    def __init__(self, pid: int, streams: Sequence[asyncio.StreamReader]) -> None:
        self.pid = pid
        self.returncode: int | None = None
        self.stdout, self.stderr = streams
        self._ended = asyncio.Event()
        self._handle = os.pidfd_open(pid)
        asyncio.get_running_loop().add_reader(self._handle, self._reap)

    async def wait(self) -> int:
        """Wait for its end; gives its exit code, of a signal the negative number."""
        await self._ended.wait()
        assert self.returncode is not None
        return self.returncode

    def _reap(self) -> None:
        asyncio.get_running_loop().remove_reader(self._handle)
        os.close(self._handle)
        try:
            _, status = os.waitpid(self.pid, 0)
            self.returncode = os.waitstatus_to_exitcode(status)
        except ChildProcessError:  # a launch file that waits for any child took it
            self.returncode = 255
        self._ended.set()


class Prepared:
    """The launch's end of the prepared process, which `with` ends; of a launch, one loop uses it.

    Args:
        environment: As that of nodes, but for what is known later. This process's own is marked,
            so that the leash finds what the launch has started.
    """

    def __init__(self, environment: Mapping[str, str]) -> None:
        self._environment = _read_at_start(environment)
        self._lock = asyncio.Lock()
        self._process: subprocess.Popen[bytes] | None = None
        os.environ[MARK] = secrets.token_hex(8)
        self._channel, other = socket.socketpair()
        command = [sys.executable, "-P", "-m", __name__, str(other.fileno()), "-" * _ROOM]
        with other, contextlib.suppress(OSError):
            if hasattr(os, "pidfd_open") and take_up_orphans():
                self._process = subprocess.Popen(
                    command,
                    stdin=subprocess.DEVNULL,
                    stdout=subprocess.DEVNULL,
                    env={**environment, MARK: os.environ[MARK]},
                    pass_fds=[other.fileno()],
                    start_new_session=True,
                )
                self._channel.send(_IMPORT, socket.MSG_NOSIGNAL)

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def close(self) -> None:
        """End the process; what it made goes on."""
        self._channel.close()
        os.environ.pop(MARK, None)
        if self._process is not None:
            self._process.kill()
            self._process.wait()

    @property
    def pid(self) -> int:
        """Of the prepared process; 0: there is none."""
        return self._process.pid if self._process is not None else 0

    def _suits(self, command: Sequence[str], environment: Mapping[str, str]) -> bool:
        """Whether it can make a node of this: a module of the studio's, in a like environment."""
        return (
            self._process is not None
            and list(command[:3]) == [sys.executable, "-P", "-m"]
            and len(command) > 3
            and command[3].startswith("studio.")
            and _read_at_start(environment) == self._environment
        )

    async def start(
        self, command: Sequence[str], environment: Mapping[str, str], cwd: str | None
    ) -> ForkedProcess | None:
        """Fork a node; None: it is to be started as any program, which also says what is wrong."""
        if not self._suits(command, environment) or (cwd and _has_relative_folders(environment)):
            return None
        async with self._lock:
            with contextlib.suppress(OSError, ValueError):
                return await self._start(command, environment, cwd)
        return None

    async def _start(
        self, command: Sequence[str], environment: Mapping[str, str], cwd: str | None
    ) -> ForkedProcess | None:
        loop = asyncio.get_running_loop()
        asked = json.dumps([list(command), dict(environment), cwd or ""]).encode()
        with contextlib.ExitStack() as theirs, contextlib.ExitStack() as ours:
            answers, answering = socket.socketpair()
            ours.enter_context(answers)
            theirs.enter_context(answering)
            question = theirs.enter_context(os.fdopen(os.memfd_create("node"), "w+b", 0))
            question.write(asked)
            ends: list[Any] = []
            for _ in range(2):
                end, begin = os.pipe()
                ends.append(ours.enter_context(os.fdopen(end, "rb", 0)))
                theirs.callback(os.close, begin)
                ends.append(begin)
            out, out_fd, err, err_fd = ends
            passed = [question.fileno(), answering.fileno(), out_fd, err_fd]
            socket.send_fds(self._channel, [_FORK], passed, socket.MSG_NOSIGNAL)
            theirs.close()
            answers.setblocking(False)  # noqa: FBT003 - as the socket module has it
            pid = await loop.sock_recv(answers, 32)
            if not pid:
                return None
            answers.close()
            ours.pop_all()
        streams = [await _stream_of(one) for one in (out, err)]
        return ForkedProcess(int(pid), streams)


async def _stream_of(pipe: Any) -> asyncio.StreamReader:
    stream = asyncio.StreamReader()
    loop = asyncio.get_running_loop()
    await loop.connect_read_pipe(lambda: asyncio.StreamReaderProtocol(stream), pipe)
    return stream


def _read_at_start(environment: Mapping[str, str]) -> dict[str, str]:
    return {name: text for name, text in environment.items() if name.startswith(_AS_STARTED)}


def _has_relative_folders(environment: Mapping[str, str]) -> bool:
    """Whether modules are found by a path that is another in another folder."""
    folders = environment.get("PYTHONPATH", "").split(os.pathsep)
    return any(one and not os.path.isabs(one) for one in folders)  # noqa: PTH117 - words


# The prepared process itself.


def main() -> None:
    """Serve a launch; in each node that is forked, run it."""
    channel = socket.socket(fileno=int(sys.argv[1]))
    channel.set_inheritable(False)
    _show_command(sys.orig_argv[:4])
    while True:
        data, passed, _, _ = socket.recv_fds(channel, 1, 4, socket.MSG_CMSG_CLOEXEC)
        if not data:
            break
        if data == _IMPORT:
            _get_ready()
        elif _is_node(channel, passed):
            return
    _end_marked()
    os._exit(0)


def _get_ready() -> None:
    """Import, and read the tables of types where none of the user's belong to them."""
    for name in _MODULES:
        importlib.import_module(name)
    if not os.environ.get(INTERFACES_VARIABLE):
        importlib.import_module("studio.ros.messages").shared_types()
    gc.freeze()  # what is here is never looked at again, and so its pages stay shared


def _is_node(channel: socket.socket, passed: list[int]) -> bool:
    """Fork; in the node, run it, then return True."""
    own, other = socket.socketpair()
    try:
        between = os.fork()
    except OSError:
        between = -1
    if between == 0:
        # The node's parent ends at once: the launch takes up what it leaves behind.
        try:
            pid = os.fork()
        except OSError:
            pid = -1
        if pid != 0:
            os._exit(0)
        own.close()
        channel.close()
        _run_node(other, passed)
        return True
    other.close()
    with own, contextlib.suppress(OSError):
        pid = own.recv(32)
        if between > 0:
            os.waitpid(between, 0)
        if pid:
            os.write(passed[1], pid)
            own.send(b"g", socket.MSG_NOSIGNAL)
    for one in passed:
        os.close(one)
    return False


def _run_node(other: socket.socket, passed: list[int]) -> None:
    question, answering, out, err = passed
    os.close(answering)
    with os.fdopen(question, "rb") as file:
        file.seek(0)
        command, environment, cwd = json.load(file)
    os.setsid()
    try:
        os.dup2(out, 1)
        os.dup2(err, 2)
        os.close(out)
        os.close(err)
        if cwd:
            os.chdir(cwd)
    except OSError:
        os._exit(1)
    other.send(str(os.getpid()).encode())
    if not other.recv(1):
        os._exit(1)  # nobody knows of it
    other.close()
    os.environ.clear()
    os.environ.update(environment)
    importlib.invalidate_caches()
    sys.orig_argv[:] = command
    sys.argv[:] = command[3:]
    _show_command(command)
    runpy.run_module(command[3], run_name="__main__", alter_sys=True)


def _show_command(words: Sequence[str]) -> None:
    """Write words over this process's command line, as `ps` shows it."""
    import ctypes  # noqa: PLC0415 - not for the launch

    with contextlib.suppress(OSError, ValueError, IndexError), open("/proc/self/stat") as file:  # noqa: PTH123
        fields = file.read().rpartition(")")[2].split()
        begin, end = int(fields[45]), int(fields[46])
        if end - begin < _ROOM:
            return
        text = b"\0".join(os.fsencode(word) for word in words)[: end - begin - 1]
        ctypes.memset(begin, 0, end - begin)
        ctypes.memmove(begin, text, len(text))


def _end_marked() -> None:
    """End all that the launch has left behind: first as Ctrl-C does."""
    mark = f"{MARK}={os.environ.get(MARK, '')}"
    until_s = time.monotonic() + _ENDS_S
    number = signal.SIGINT
    while rows := marked_processes(mark):
        if number != 0:
            for pid in rows:
                with contextlib.suppress(ProcessLookupError, PermissionError):
                    os.kill(pid, number)
        number = signal.SIGKILL if time.monotonic() > until_s else 0
        time.sleep(0.05)


if __name__ == "__main__":
    main()
