"""The process that plans one launch file: `python -m studio.launch.planner_process`.

The request comes on stdin and the plan goes to stdout, both JSON. What a launch file prints becomes
lines of the plan's log; what it starts by itself ends with its plan.

The process that reads the request runs no code of the launch file: it supervises the one that does,
and takes up all that this one leaves behind, whatever session or environment that has. What still
escapes: a process that has another one start something for it (a service of this machine, at or
cron), or that kills the supervisor first and then hides in a session and environment of its own.
"""

from __future__ import annotations

import contextlib
import gc
import io
import os
import struct
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Final, Never

import msgspec

from studio.launch.plan import Plan, Where, plan_to_json
from studio.launch.watchdog import Limits, Watchdog, take_up_orphans
from studio.packages.index import Indexed, PackageIndex, Rank
from studio.packages.passing import environment_of
from studio.system import ignore_interrupt, limit_memory

PRINTED_MAX: Final = 20_000
"""Letters of what a launch file prints."""
LENGTH: Final = struct.Struct("<Q")
"""Before the answer, its length in bytes."""
_END_S: Final = 60.0
_LOOK_EVERY_S: Final = 0.05
FILE_MAX_BYTES: Final = 16 << 20
"""Of a file that a launch file writes."""


@dataclass(frozen=True, slots=True)
class PackageRow:
    """One package of the index."""

    name: str
    folder: str
    rank: int
    order: int


@dataclass(frozen=True, slots=True)
class PlanRequest:
    """What is to be planned, and with what."""

    file: str
    given: dict[str, str]
    packages: tuple[PackageRow, ...]
    chosen: dict[str, str]
    memory_bytes: int
    folder: str
    """For temporary files; who asks removes it."""


def rows_of(index: PackageIndex) -> tuple[PackageRow, ...]:
    """Return an index's packages as rows."""
    return tuple(
        PackageRow(one.name, str(one.folder), int(one.rank), one.order) for one in index.packages
    )


def index_of(request: PlanRequest) -> PackageIndex:
    """Return the index of a request."""
    return PackageIndex(
        (
            Indexed(one.name, Path(one.folder), Rank(one.rank), one.order)
            for one in request.packages
        ),
        {name: Path(folder) for name, folder in request.chosen.items()},
    )


class _Printed(io.TextIOBase):
    """Keeps the beginning of what is printed."""

    def __init__(self) -> None:
        self.text = ""
        self.dropped = False

    def write(self, text: str, /) -> int:
        left = PRINTED_MAX - len(self.text)
        self.text += text[:left]
        self.dropped = self.dropped or len(text) > left
        return len(text)

    def writable(self) -> bool:
        return True


def main() -> None:
    """Plan one file in a child of this process, and supervise that."""
    request = msgspec.json.decode(sys.stdin.buffer.read(), type=PlanRequest)
    ignore_interrupt()
    take_up_orphans()
    if hasattr(os, "fork") and os.fork():
        _supervise()
    _answer(request)


def _supervise() -> Never:
    """Live, so that what the launch file leaves behind has a parent, until killed or left alone."""
    starter = os.getppid()
    _leave_streams()
    while os.getppid() == starter:
        with contextlib.suppress(ChildProcessError):
            while os.waitpid(-1, os.WNOHANG)[0]:
                pass
        time.sleep(_LOOK_EVERY_S)
    Watchdog(os.getpid(), Limits(0, 0, 0), with_leader=False).kill()
    os._exit(0)


def _leave_streams() -> None:
    nothing = os.open(os.devnull, os.O_RDWR)
    for descriptor in (0, 1, 2):
        os.dup2(nothing, descriptor)


def _answer(request: PlanRequest) -> Never:
    answers, own = os.fdopen(os.dup(1), "wb"), os.getpid()
    _confine(request.memory_bytes)
    printed = _Printed()
    plan = _planned(request, printed)
    sys.stdout, sys.stderr = sys.__stdout__, sys.__stderr__
    if os.getpid() == own:  # a launch file that forks goes on twice
        data = plan_to_json(plan)
        with contextlib.suppress(BrokenPipeError):
            answers.write(LENGTH.pack(len(data)) + data)
            answers.flush()
        # The parent ends this process first of all, and so finds all that it left behind.
        time.sleep(_END_S)
    os._exit(0)


def _confine(memory_bytes: int) -> None:
    _leave_streams()
    limit_memory(memory_bytes)
    try:
        import resource  # noqa: PLC0415 - Unix only
    except ImportError:
        return
    resource.setrlimit(resource.RLIMIT_FSIZE, (FILE_MAX_BYTES, FILE_MAX_BYTES))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def _planned(request: PlanRequest, printed: _Printed) -> Plan:
    from studio.launch.modules import install  # noqa: PLC0415 - after the limits
    from studio.launch.planner import PlanEndedError, Planner  # noqa: PLC0415
    from studio.launch.vocabulary.context import LaunchContext, use_host  # noqa: PLC0415
    from studio.launch.vocabulary.temporary import use_folder  # noqa: PLC0415

    index = index_of(request)
    planner = Planner(index, Path(request.file), request.given)
    use_host(planner)
    use_folder(request.folder)
    os.environ.update(environment_of(index, Path(request.file)))
    sys.modules["xacro"] = planner.robots.xacro_module()
    install(index, Path(request.file), stand_in=True)
    planner.robots.watch_opened_files()
    sys.stdout = sys.stderr = printed
    ended = ""
    try:
        planner.run(LaunchContext(planner))
    except PlanEndedError as error:
        ended = str(error)
    except MemoryError:
        gc.collect()
        ended = f"it takes more than {request.memory_bytes >> 20} MB of memory"
    except BaseException as error:  # noqa: BLE001 - SystemExit, and what else ends a process
        ended = f"it ends the process by itself ({type(error).__name__}: {error})"
    for line in printed.text.splitlines()[:200]:
        planner.log("info", line, Where())
    if printed.dropped:
        planner.log("warn", f"it prints more than {PRINTED_MAX} letters", Where())
    return planner.plan(ended)


if __name__ == "__main__":
    main()
