"""Plans launch files, each in a process of its own with bounds."""

from __future__ import annotations

import contextlib
import os
import secrets
import subprocess
import sys
import tempfile
import threading
import time
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Final

import msgspec

from studio.launch.plan import Plan, PlannedFailure, Where, plan_from_json
from studio.launch.planner_process import LENGTH, PlanRequest, rows_of
from studio.launch.shares import name_of_package_in
from studio.launch.watchdog import MARK, Limits, Watchdog
from studio.packages.roots import package_folder_of

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.packages.index import PackageIndex

_MODULE: Final = "studio.launch.planner_process"
_LOOK_EVERY_S: Final = 0.05
_ANSWER_MAX_BYTES: Final = 64 << 20


@dataclass(frozen=True, slots=True)
class PlanLimits:
    """What planning one file may take."""

    seconds: float = 20.0
    memory_bytes: int = 1 << 30
    processes: int = 24
    files: int = 1_000


def plan_launch_file(
    file: Path,
    given: Mapping[str, str],
    index: PackageIndex,
    limits: PlanLimits = PlanLimits(),
    given_up: threading.Event | None = None,
) -> Plan:
    """Plan a launch file; blocks until that is done or given up, at most `limits.seconds`.

    Whatever the file does, this returns a plan: `failures` and `ended` say what went wrong.
    """
    given_up = given_up or threading.Event()
    chosen = {name: str(folder) for name, folder in index.chosen.items()}
    with tempfile.TemporaryDirectory(prefix="studio-plan-", ignore_cleanup_errors=True) as folder:
        request = PlanRequest(
            str(file), dict(given), rows_of(index), chosen, limits.memory_bytes, folder
        )
        data, ended = _answered(request, limits, given_up)
    try:
        plan = plan_from_json(data)
    except msgspec.DecodeError:
        reason = ended or "planning it ended without an answer"
        plan = Plan(str(file), ended=reason)
    if plan.ended:
        sentence = f"it is not planned whole: {plan.ended}"
        plan = replace(plan, failures=(*plan.failures, PlannedFailure(sentence, Where(str(file)))))
    return replace(plan, package=_package_of(file))


def _answered(
    request: PlanRequest, limits: PlanLimits, given_up: threading.Event
) -> tuple[bytes, str]:
    """Return what the process answered, and why it was ended; empty where it ended by itself."""
    mark = f"{MARK}={secrets.token_hex(8)}"
    process = subprocess.Popen(
        [sys.executable, "-P", "-m", _MODULE],
        env={**os.environ, MARK: mark.partition("=")[2], "TMPDIR": request.folder},
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        start_new_session=True,
    )
    answer = _Answer(process)
    bounds = Limits(limits.memory_bytes, limits.processes, limits.files)
    watchdog = Watchdog(process.pid, bounds, mark=mark)
    until = time.monotonic() + limits.seconds
    ended = ""
    try:
        answer.ask(msgspec.json.encode(request))
        while not ended and not answer.wait(_LOOK_EVERY_S):
            ended = "it was given up" if given_up.is_set() else watchdog.exceeded()
            if not ended and time.monotonic() > until:
                ended = f"it takes longer than {limits.seconds:g} s"
    finally:
        # The supervisor last: what loses its parent meanwhile becomes the supervisor's.
        Watchdog(process.pid, bounds, with_leader=False).kill()
        watchdog.kill()
        with contextlib.suppress(ProcessLookupError):
            process.kill()
        process.wait()
        answer.close()
    return answer.data, ended


class _Answer:
    """Reads what a process writes, up to a limit, beside the one who watches it."""

    def __init__(self, process: subprocess.Popen[bytes]) -> None:
        self._process, self.data = process, b""
        self._thread = threading.Thread(target=self._read, daemon=True)

    def ask(self, request: bytes) -> None:
        assert self._process.stdin is not None
        self._thread.start()
        with contextlib.suppress(BrokenPipeError):
            self._process.stdin.write(request)
            self._process.stdin.close()

    def wait(self, seconds: float) -> bool:
        """Return whether it has ended."""
        self._thread.join(seconds)
        return not self._thread.is_alive()

    def close(self) -> None:
        self._thread.join(1.0)
        assert self._process.stdout is not None
        with contextlib.suppress(OSError, ValueError):
            self._process.stdout.close()

    def _read(self) -> None:
        head = self._bytes(LENGTH.size)
        if len(head) == LENGTH.size:
            self.data = self._bytes(min(LENGTH.unpack(head)[0], _ANSWER_MAX_BYTES))

    def _bytes(self, count: int) -> bytes:
        """Read so many bytes, or fewer where the process ends before."""
        assert self._process.stdout is not None
        found = bytearray()
        while len(found) < count and (
            data := os.read(self._process.stdout.fileno(), min(count - len(found), 1 << 16))
        ):
            found += data
        return bytes(found)


def _package_of(file: Path) -> str:
    folder = package_folder_of(Path(os.path.realpath(file)).parent)
    return "" if folder is None else name_of_package_in(folder)
