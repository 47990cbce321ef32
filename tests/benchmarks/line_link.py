"""A slow line between two network namespaces: `python -m ... FD FD RATE DELAY QUEUE` carries it.

Both ends are tun devices, whose packets a process takes in and gives out when the line has carried
them: many kernels cannot delay (`tc ... netem`). The namespaces end with the last who is in them.
"""

from __future__ import annotations

import ctypes
import fcntl
import os
import select
import socket
import struct
import subprocess
import sys
import time
from collections import deque
from contextlib import ExitStack, contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Generator

NEAR, FAR = "198.51.100.1", "198.51.100.2"
"""Addresses of the two ends, from those that are kept for examples."""
_NETWORK = "/proc/thread-self/ns/net"
_NEW_NETWORK = 0x4000_0000
_CONGESTION = Path("/proc/sys/net/ipv4/tcp_congestion_control")
_TUN = "/dev/net/tun"
_TUN_WITHOUT_HEADER = 0x1001
_SET_TUN, _SET_ADDRESS, _SET_MASK = 0x4004_54CA, 0x8916, 0x891C
_GET_FLAGS, _SET_FLAGS = 0x8913, 0x8914
_UP = 1
_PACKET_BYTES = 2048
_AT_ONCE = 64


class NoLineError(Exception):
    """The system has no namespaces or no tun devices for us; the text says which."""


class Link:
    """A running line: as `near`, and `far`, this thread and what it starts are at one end."""

    def __init__(self, near: int, far: int, carrier: subprocess.Popen[str]) -> None:
        self._near, self._far, self._carrier = near, far, carrier

    @contextmanager
    def near(self) -> Generator[None]:
        """Be at the one end, `NEAR`, within this block."""
        with within(self._near):
            yield

    @contextmanager
    def far(self) -> Generator[None]:
        """Be at the other end, `FAR`, within this block."""
        with within(self._far):
            yield

    def cut(self) -> None:
        """Lose every packet from now on, and those on their way."""
        self._tell("cut")

    def restore(self) -> None:
        """Carry packets again."""
        self._tell("restore")

    def _tell(self, word: str) -> None:
        assert self._carrier.stdin is not None
        self._carrier.stdin.write(f"{word}\n")
        self._carrier.stdin.flush()


@contextmanager
def link(rate_bits_per_s: float, delay_s: float, queue_s: float) -> Generator[Link]:
    """Have a line within this block.

    Args:
        rate_bits_per_s: Of each direction.
        delay_s: Of each direction.
        queue_s: For so long a packet waits at most; those that would wait longer are lost.

    Raises:
        NoLineError: The system does not let us.
    """
    with ExitStack() as held:
        ends: list[tuple[int, int]] = []
        for address in (NEAR, FAR):
            namespace, device = _made(address)
            held.callback(os.close, namespace)
            held.callback(os.close, device)
            ends.append((namespace, device))
        devices = [device for _, device in ends]
        words = (*devices, rate_bits_per_s, delay_s, queue_s)
        carrier = subprocess.Popen(
            [sys.executable, "-m", __spec__.name, *map(str, words)],
            stdin=subprocess.PIPE,
            pass_fds=devices,
            text=True,
        )
        held.callback(carrier.wait)
        assert carrier.stdin is not None
        held.callback(carrier.stdin.close)
        yield Link(ends[0][0], ends[1][0], carrier)


def _made(address: str) -> tuple[int, int]:
    """A namespace and a tun device in it, which is up."""
    home = os.open(_NETWORK, os.O_RDONLY)
    try:
        _call("unshare", _NEW_NETWORK)
        with suppress(OSError):
            _CONGESTION.write_text("cubic")  # as most machines have it
        try:
            return os.open(_NETWORK, os.O_RDONLY), _device(address)
        except OSError as error:
            raise NoLineError(f"tun devices: {error.strerror}") from error
        finally:
            _call("setns", home, _NEW_NETWORK)
    finally:
        os.close(home)


@contextmanager
def within(namespace: int) -> Generator[None]:
    """Be in a network namespace, an open file of it, within this block: this thread alone."""
    home = os.open(_NETWORK, os.O_RDONLY)
    _call("setns", namespace, _NEW_NETWORK)
    try:
        yield
    finally:
        _call("setns", home, _NEW_NETWORK)
        os.close(home)


def _call(name: str, *words: int) -> None:
    """Call the system; `os` has these from Python 3.12 on."""
    function = getattr(ctypes.CDLL(None, use_errno=True), name, None)
    if function is None or function(*words) != 0:
        raise NoLineError(f"network namespaces: {os.strerror(ctypes.get_errno())}")


def _device(address: str) -> int:
    device = os.open(_TUN, os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, _SET_TUN, struct.pack("16sH14x", b"line", _TUN_WITHOUT_HEADER))
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as asked:
        for request, value in ((_SET_ADDRESS, address), (_SET_MASK, "255.255.255.0")):
            packed = struct.pack("16sH2x4s8x", b"line", socket.AF_INET, socket.inet_aton(value))
            fcntl.ioctl(asked, request, packed)
        for name in (b"lo", b"line"):
            (flags,) = struct.unpack(
                "16xH14x", fcntl.ioctl(asked, _GET_FLAGS, struct.pack("16s16x", name))
            )
            fcntl.ioctl(asked, _SET_FLAGS, struct.pack("16sH14x", name, flags | _UP))
    return device


class Direction:
    """Packets from one end to the other."""

    def __init__(self, source: int, target: int, bytes_per_s: float, delay_s: float) -> None:
        self.source = source
        self._target, self._bytes_per_s, self._delay_s = target, bytes_per_s, delay_s
        self._under_way: deque[tuple[float, bytes]] = deque()
        self._free_s = 0.0
        """When the line has taken in all that came so far."""

    def take(self, queue_s: float, *, lost: bool) -> None:
        """Take in what came."""
        for _ in range(_AT_ONCE):
            try:
                packet = os.read(self.source, _PACKET_BYTES)
            except BlockingIOError:
                return
            now_s = time.perf_counter()
            begins_s = max(now_s, self._free_s)
            if lost or begins_s - now_s > queue_s:
                continue
            self._free_s = begins_s + len(packet) / self._bytes_per_s
            self._under_way.append((self._free_s + self._delay_s, packet))

    def give(self) -> float:
        """Give out what is due; gives the seconds until the next is."""
        under_way = self._under_way
        while under_way:
            left_s = under_way[0][0] - time.perf_counter()
            if left_s > 0:
                return left_s
            os.write(self._target, under_way.popleft()[1])
        return 1.0

    def lose(self) -> None:
        """Lose what is under way."""
        self._under_way.clear()
        self._free_s = 0.0


def main(words: list[str]) -> None:
    """Carry packets until stdin ends, and obey what it says."""
    near, far = int(words[0]), int(words[1])
    bytes_per_s, delay_s, queue_s = float(words[2]) / 8, float(words[3]), float(words[4])
    ways = {
        source: Direction(source, target, bytes_per_s, delay_s)
        for source, target in ((near, far), (far, near))
    }
    poll = select.epoll()
    told = sys.stdin.fileno()
    for one in (near, far, told):
        poll.register(one, select.EPOLLIN)
    is_cut, left_s = False, 1.0
    while True:
        for ready, _ in poll.poll(left_s):
            if ready != told:
                ways[ready].take(queue_s, lost=is_cut)
            elif not (line := sys.stdin.readline()):
                return
            else:
                is_cut = line == "cut\n"
                for way in ways.values() if is_cut else ():
                    way.lose()
        left_s = min(way.give() for way in ways.values())


if __name__ == "__main__":
    main(sys.argv[1:])
