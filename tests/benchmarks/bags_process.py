"""A bag read in a process of its own, for its memory and its first opening; and one of 10 GB.

`python -m tests.benchmarks.bags_process ours|mcap open|all FILE` prints one line of JSON.
"""

from __future__ import annotations

import io
import json
import random
import sys
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

from mcap.reader import make_reader
from mcap.writer import CompressionType, Writer

from studio.bags.opening import open_bag
from tests.benchmarks.report import say

if TYPE_CHECKING:
    from studio.bags.bag import Bag

STATES: Final = 200
SIZE_BYTES: Final = 10 * 10**9
_PICTURE: Final = bytes(1_000_000)
_SMALL_BYTES: Final = 200
_LATCHED: Final = ("/robot_description", "/tf_static", "/map")
_TOPICS: Final = ("/camera", *_LATCHED, *(f"/small_{number}" for number in range(48)))
_STEP_NS: Final = 10**9 // 30
_HOLE: Final = bytes(16 * 1024)
_BEGIN_NS: Final = 1_700_000_000_000_000_000
_END_NS: Final = 2**63 - 1


class SparseFile(io.RawIOBase):
    """A new file that takes what is written, and leaves out where it is zero for long."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._file = path.open("xb")

    def writable(self) -> bool:
        """Whether it may be written."""
        return True

    def seek(self, offset: int, whence: int = io.SEEK_SET, /) -> int:
        """Tell where it is written next; nobody goes elsewhere."""
        return self._file.seek(offset, whence)

    def write(self, data: Any, /) -> int:  # noqa: ANN401 - any buffer
        """Write at the end."""
        for begin in range(0, len(data), len(_HOLE)):
            part = bytes(data[begin : begin + len(_HOLE)])
            if part == _HOLE:
                self._file.seek(len(_HOLE), io.SEEK_CUR)
            else:
                self._file.write(part)
        return len(data)

    def close(self) -> None:
        """Give the file back."""
        self._file.close()
        super().close()


def write_sparse_bag(path: Path) -> Path:
    """Write a bag of 10 GB that takes some hundred MB of the disk; return its path."""
    with io.BufferedWriter(SparseFile(path)) as file:
        writer = Writer(file, compression=CompressionType.NONE, enable_crcs=False)
        writer.start("ros2", "benchmark")
        schema = writer.register_schema("std_msgs/msg/String", "ros2msg", b"string data\n")
        channels = {name: writer.register_channel(name, "cdr", schema) for name in _TOPICS}
        for name in _LATCHED:
            writer.add_message(channels[name], _BEGIN_NS, bytes(_SMALL_BYTES), _BEGIN_NS)
        for number in range(SIZE_BYTES // len(_PICTURE)):
            at_ns = _BEGIN_NS + (number + 1) * _STEP_NS
            writer.add_message(channels["/camera"], at_ns, _PICTURE, at_ns)
            for place in range(number % 3, 48, 3):
                small = number.to_bytes(4, "little") * (_SMALL_BYTES // 4)
                writer.add_message(channels[f"/small_{place}"], at_ns + place + 1, small, at_ns)
        writer.finish()
    return path


def _memory_mb() -> float:
    return _status_mb("VmRSS")


def _status_mb(name: str) -> float:
    """Return a line of what Linux says of this process, in MB; 0 on other systems."""
    status = Path("/proc/self/status")
    lines = status.read_text(encoding="ascii").splitlines() if status.exists() else []
    found = next((one for one in lines if one.startswith(name)), f"{name}: 0 kB")
    return int(found.split()[1]) * 1024 / 1e6


def _ours(what: str, path: Path) -> dict[str, Any]:
    before_mb = _memory_mb()
    begin_s = time.perf_counter()
    bag = open_bag(path)
    found: dict[str, Any] = {"open_ms": (time.perf_counter() - begin_s) * 1e3}
    topics = [one.name for one in bag.topics]
    found |= {"topics_ms": (time.perf_counter() - begin_s) * 1e3}
    if what == "all":
        found |= {"opened_mb": round(_memory_mb() - before_mb, 1)}
        _ask_states(bag, topics)
        found |= {"states_mb": round(_memory_mb() - before_mb, 1)}
        found |= {"count": sum(1 for _ in bag.messages(topics, 0, _END_NS))}
    bag.close()
    return {**found, "peak_mb": round(_status_mb("VmHWM") - before_mb, 1)}


def _ask_states(bag: Bag, topics: list[str]) -> None:
    hand = random.Random(5)
    for _ in range(STATES):
        bag.latest(topics, bag.begin_ns + round(hand.random() * (bag.end_ns - bag.begin_ns)))


def _by_mcap(what: str, path: Path) -> dict[str, Any]:
    before_mb = _memory_mb()
    begin_s = time.perf_counter()
    with path.open("rb") as stream:
        reader = make_reader(stream)
        reader.get_summary()
        found: dict[str, Any] = {"open_ms": (time.perf_counter() - begin_s) * 1e3}
        if what == "all":
            found |= {"opened_mb": round(_memory_mb() - before_mb, 1)}
            found |= {"count": sum(1 for _ in reader.iter_messages())}
    return {**found, "peak_mb": round(_status_mb("VmHWM") - before_mb, 1)}


if __name__ == "__main__":
    ask = {"ours": _ours, "mcap": _by_mcap}[sys.argv[1]]
    say(json.dumps(ask(sys.argv[2], Path(sys.argv[3]))))
