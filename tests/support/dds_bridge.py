"""zenoh-bridge-ros2dds and robots on DDS, in a network of their own.

STUDIO_DDS_PEER names a folder with `zenoh-bridge-ros2dds.xz`, which is unpacked once for each user
of the machine; else `zenoh-bridge-ros2dds` is looked for on the PATH. Participants of DDS bind the
same ports at all addresses, so each test has a network namespace of Linux. Only unix sockets lead
out of it: a `Line` carries Zenoh through one.
"""

from __future__ import annotations

import fcntl
import hashlib
import json
import lzma
import os
import secrets
import shutil
import socket
import subprocess
import sys
import tempfile
import threading
from contextlib import contextmanager, suppress
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, Self

import pytest

from studio.ros.wire.zenoh import (
    ZError,
    close,
    insert,
    live_tokens,
    open_zenoh,
    read_config,
)
from tests.support.dds_settings import LEASE_S, loopback
from tests.support.ros2_peer import RealNode, RealNodes
from tests.support.wire import PATIENCE_S, free_endpoint, wait_until

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from studio.ros.wire.zenoh import Session

_VARIABLE: Final = "STUDIO_DDS_PEER"
_PROGRAM: Final = "zenoh-bridge-ros2dds"
_TREE: Final = Path(__file__).parents[2]
_TOOLS: Final = ("unshare", "nsenter", "setpriv")
_CHUNK_BYTES: Final = 1 << 16
_ASK_S: Final = 2.0
# Brings the loopback interface up (SIOCGIFFLAGS, SIOCSIFFLAGS, IFF_UP): `ip` may be missing.
_HOLDER: Final = r"""
import fcntl, socket, struct, sys
with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as any_socket:
    name = b"lo".ljust(16, b"\0")
    flags, = struct.unpack_from("H", fcntl.ioctl(any_socket, 0x8913, name + bytes(16)), 16)
    fcntl.ioctl(any_socket, 0x8914, name + struct.pack("H", flags | 1) + bytes(14))
print("up", flush=True)
sys.stdin.read()
"""


@cache
def bridge_program() -> Path | str:
    """The program, or one sentence that says why it is not there."""
    named = os.environ.get(_VARIABLE)
    if not named:
        found = shutil.which(_PROGRAM)
        return Path(found) if found else f"{_VARIABLE} names no folder with {_PROGRAM}.xz"
    packed = Path(named) / f"{_PROGRAM}.xz"
    if not packed.is_file():
        return f"{_VARIABLE} is {named}, which has no {_PROGRAM}.xz"
    return _unpacked(packed)


def _unpacked(packed: Path) -> Path:
    folder = Path(tempfile.gettempdir()) / f"studio-dds-peer-{os.getuid()}"
    folder.mkdir(mode=0o700, exist_ok=True)
    assert folder.stat().st_uid == os.getuid(), f"{folder} belongs to somebody else"
    content = packed.read_bytes()
    program = folder / f"{_PROGRAM}-{hashlib.sha256(content).hexdigest()[:16]}"
    with (folder / ".lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # of several workers, one unpacks and the others wait
        if not program.exists():
            partial = program.with_suffix(".part")
            partial.write_bytes(lzma.decompress(content))
            partial.chmod(0o700)
            partial.replace(program)
    return program


@cache
def namespace_options() -> tuple[str, ...] | str:
    """Options of `unshare` that make a network here, or one sentence why none can be had."""
    missing = [one for one in _TOOLS if shutil.which(one) is None]
    if missing:
        return f"a network of its own needs {', '.join(missing)} of util-linux"
    said = ""
    for options in (("--net",), ("--user", "--map-root-user", "--net")):
        tried = subprocess.run(
            ["unshare", *options, "true"], capture_output=True, text=True, check=False
        )
        if tried.returncode == 0:
            return options
        said = tried.stderr.strip()
    return f"no network of its own can be had here: {said}"


def need_dds() -> None:
    """Skip the test where bridge, Cyclone DDS or networks are missing."""
    program, options = bridge_program(), namespace_options()
    for found in (program, options):
        if isinstance(found, str):
            pytest.skip(found)
    pytest.importorskip("cyclonedds", reason="cyclonedds of PyPI is not installed")


class Line:
    """Passes on streams between a TCP port and a unix socket, in threads; it can be cut."""

    def __init__(self, listener: socket.socket, family: int, target: str | tuple[str, int]) -> None:
        """Take a socket that listens, and pass on what connects there to the target."""
        self._listener, self._family, self._target = listener, family, target
        self._open = True
        self._ends: set[socket.socket] = set()
        self._lock = threading.Lock()
        self._thread = threading.Thread(target=self._accept, daemon=True)
        self._thread.start()

    @classmethod
    def out(cls, path: Path, port: int) -> Line:
        """From a unix socket to a port outside."""
        listener = socket.socket(socket.AF_UNIX)
        listener.bind(str(path))
        listener.listen()
        return cls(listener, socket.AF_INET, ("127.0.0.1", port))

    @classmethod
    def into(cls, port: int, path: Path) -> Line:
        """From a port outside to a unix socket."""
        return cls(socket.create_server(("127.0.0.1", port)), socket.AF_UNIX, str(path))

    def cut(self) -> None:
        """Close what is connected, and refuse others until `mend`."""
        with self._lock:
            self._open = False
            ends, self._ends = self._ends, set()
        for one in ends:
            _shut(one)

    def mend(self) -> None:
        """Connect again."""
        self._open = True

    def close(self) -> None:
        """End it."""
        self.cut()
        _shut(self._listener)
        self._thread.join()

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                near, _ = self._listener.accept()
                far = socket.socket(self._family)
                try:
                    far.connect(self._target)
                except OSError:
                    self._open_or_shut(near, far, wanted=False)
                    continue
                self._open_or_shut(near, far, wanted=True)

    def _open_or_shut(self, near: socket.socket, far: socket.socket, *, wanted: bool) -> None:
        with self._lock:
            wanted = wanted and self._open
            if wanted:
                self._ends |= {near, far}
        if not wanted:
            _shut(near)
            _shut(far)
            return
        for source, target in ((near, far), (far, near)):
            threading.Thread(target=_pass_on, args=(source, target), daemon=True).start()


def _pass_on(source: socket.socket, target: socket.socket) -> None:
    with suppress(OSError):
        while data := source.recv(_CHUNK_BYTES):
            target.sendall(data)
    for one in (source, target):
        _shut(one)


def _shut(one: socket.socket) -> None:
    with suppress(OSError):
        one.shutdown(socket.SHUT_RDWR)
    one.close()


class Bridge(RealNode):
    """A running bridge; `endpoint` is where it is reached, or the router that it connects to.

    Attributes:
        zid: Its id in Zenoh, which is in its tokens.
        line: Between it and the outside; cut it, and mend it.
    """

    def __init__(self, process: subprocess.Popen[str], zid: str, endpoint: str, line: Line) -> None:
        super().__init__(process)
        self.zid, self.endpoint, self.line = zid, endpoint, line

    def wait_shown(self) -> None:
        """Wait until its token is seen at its endpoint."""

        def is_shown() -> bool:
            assert self.process.poll() is None, f"the bridge ended: {self.lines}"
            try:
                session = session_at(self.endpoint)
            except ZError:
                return False
            try:
                return any(live_tokens(session, f"@/{self.zid}/@ros2_lv", _ASK_S))
            finally:
                close(session)

        wait_until("the bridge shows its token", is_shown)


def session_at(endpoint: str) -> Session:
    """A bare client of Zenoh at an endpoint; close it.

    Raises:
        ZError: Nobody answers there.
    """
    config = read_config()
    insert(config, "mode", '"client"')
    insert(config, "connect/endpoints", json.dumps([endpoint]))
    insert(config, "scouting/multicast/enabled", "false")
    return open_zenoh(config)


class DdsRobot(RealNodes):
    """A robot on DDS; `ask` has it do what `tests.support.dds_robot.Robot` can, by name."""

    def call(self, service: str, type_name: str, **values: object) -> Any:  # noqa: ANN401
        """Call a service, and wait for the response."""
        before = len(self.all_said("answered", service=service))
        self.ask("call", service=service, type_name=type_name, values=values)
        wait_until(
            f"{service} answers", lambda: len(self.all_said("answered", service=service)) > before
        )
        return self.all_said("answered", service=service)[before]["response"]

    def wait_heard(self, topic: str, patience_s: float = PATIENCE_S, **fields: object) -> Any:  # noqa: ANN401
        """Wait for a message on a topic that it subscribes, with these fields; the message."""

        def found() -> list[Any]:
            heard = [one.get("message", {}) for one in self.all_said("heard", topic=topic)]
            return [one for one in heard if fields.items() <= one.items()]

        wait_until(f"{topic} is heard with {fields}", lambda: bool(found()), patience_s)
        return found()[0]


class DdsNetwork:
    """A network namespace with bridges and robots, until the end of the block."""

    def __init__(self, domain_settings: str = "") -> None:
        """Make it; the settings are XML, of `Domain` in Cyclone DDS, for all who are in it."""
        need_dds()
        self._domain_settings = domain_settings
        self._folder = tempfile.TemporaryDirectory(prefix="studio-dds-")
        self._running: list[RealNode] = []
        self._lines: list[Line] = []
        options = namespace_options()
        assert not isinstance(options, str)
        self._has_user = "--user" in options
        self._holder = subprocess.Popen(
            ["unshare", *options, sys.executable, "-c", _HOLDER],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        assert self._holder.stdout is not None
        said = self._holder.stdout.readline()
        if said != "up\n":
            self.close()
            pytest.skip(f"no network of its own can be had here: {said.strip()}")

    def bridge(  # noqa: PLR0913
        self,
        *,
        connect: str = "",
        listen: str = "",
        namespace: str = "/",
        domain: int = 0,
        distro: str = "jazzy",
        config: Mapping[str, object] | None = None,
        zenoh: Mapping[str, object] | None = None,
        mode: str = "router",
        options: tuple[str, ...] = (),
        waits: bool = True,
    ) -> Bridge:
        """Start a bridge that connects to a router outside, or is a router that listens.

        Args:
            connect: A router, `tcp/127.0.0.1:PORT`.
            listen: Where it is to be reached outside; by itself a free port.
            namespace: Of all its names on Zenoh.
            domain: Of DDS.
            distro: ROS_DISTRO, by which it knows how long gids are.
            config: Further keys of `plugins/ros2dds`.
            zenoh: Further keys of Zenoh's configuration.
            mode: `router`, `peer` or `client`, which only connects.
            options: Of its command line.
            waits: Until it is seen at its endpoint.
        """
        endpoint = connect or listen or free_endpoint()
        assert endpoint.startswith("tcp/"), "only TCP leads into the network"
        port = int(endpoint.rpartition(":")[2])
        zid = secrets.token_hex(16).replace("0", "1")  # none may begin with 0
        path = Path(self._folder.name) / f"{zid[:8]}.sock"
        line = Line.out(path, port) if connect else Line.into(port, path)
        self._lines.append(line)
        words = ("-e" if connect else "-l", f"unixsock-stream/{path}")
        if connect and mode != "client":  # else it listens at a port that the next one wants too
            words += ("-l", f"unixsock-stream/{path}.own")
        file = Path(self._folder.name) / f"{zid[:8]}.json5"
        file.write_text(json.dumps({**(zenoh or {}), "plugins": {"ros2dds": dict(config or {})}}))
        fixed = ("-i", zid, "-n", namespace, "-d", str(domain), "--no-multicast-scouting")
        process = self._started(
            (str(bridge_program()), "-c", str(file), *fixed, *words, *options, mode),
            {"ROS_DISTRO": distro, "RUST_LOG": "warn,zenoh_plugin_ros2dds=info"},
        )
        bridge = Bridge(process, zid, endpoint, line)
        self._running.append(bridge)
        if waits:
            bridge.wait_shown()
        return bridge

    def robot(
        self,
        name: str = "",
        *,
        distro: str = "jazzy",
        domain: int = 0,
        lease_s: float = LEASE_S,
    ) -> DdsRobot:
        """Start a robot that waits for what it is asked, or the one of that name, `classroom`.

        When it is killed, others miss it after `lease_s` seconds; who ends is gone at once.
        """
        words = ("--distro", distro, "--domain", str(domain), *(("--robot", name) if name else ()))
        process = self._started(
            (sys.executable, "-m", "tests.support.dds_robot", *words),
            {
                "ROS_DISTRO": distro,
                "PYTHONPATH": str(_TREE),
                "CYCLONEDDS_URI": self._settings(lease_s),
            },
            stdin=subprocess.PIPE,
        )
        robot = DdsRobot(process)
        self._running.append(robot)
        robot.wait_said("ready")
        return robot

    def nodes(self, *words: str) -> RealNodes:
        """Start a Python module in it that is asked by lines, as `dds_robot` is; wait for ready."""
        process = self._started(
            (sys.executable, "-m", *words), {"PYTHONPATH": str(_TREE)}, stdin=subprocess.PIPE
        )
        nodes = RealNodes(process)
        self._running.append(nodes)
        nodes.wait_said("ready")
        return nodes

    def close(self) -> None:
        """End all that runs in it, by force."""
        for one in self._running:
            one.kill()
            if one.process.stdin is not None:
                one.process.stdin.close()
        for line in self._lines:
            line.close()
        self._holder.communicate()
        self._folder.cleanup()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def _settings(self, lease_s: float) -> str:
        return loopback(lease_s).replace("</Domain>", f"{self._domain_settings}</Domain>")

    def _started(
        self, words: tuple[str, ...], variables: Mapping[str, str], stdin: int = subprocess.DEVNULL
    ) -> subprocess.Popen[str]:
        """Start a program in the network; the kernel ends it if this thread ends without it."""
        unwanted = ("ROS", "ZENOH", "RMW", "CYCLONE", "PYTHON")
        kept = {name: value for name, value in os.environ.items() if not name.startswith(unwanted)}
        entered = ("--user", "--preserve-credentials") if self._has_user else ()
        return subprocess.Popen(
            [
                *("nsenter", "--target", str(self._holder.pid), *entered, "--net"),
                *("setpriv", "--pdeathsig", "KILL", *words),
            ],
            env={**kept, "CYCLONEDDS_URI": self._settings(LEASE_S), **variables},
            cwd=_TREE,
            stdin=stdin,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
        )


@contextmanager
def dds_network(domain_settings: str = "") -> Generator[DdsNetwork]:
    """A network for a fixture."""
    with DdsNetwork(domain_settings) as network:
        yield network
