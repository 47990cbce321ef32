"""Processes whose clock is wrong.

`python -m tests.support.shifted_clocks SECONDS PYTHON -m MODULE WORDS...` runs a module so where
libfaketime is missing, as far as Python lets: what `time` says is shifted, not `datetime`.
"""

from __future__ import annotations

import runpy
import sys
import time
from functools import cache
from pathlib import Path

from tests.support.apt import install_by_apt


def with_clock(hours: int) -> tuple[str, ...]:
    """The words before a command by which its clock is so many hours ahead; negative: behind."""
    if library := _library():
        return "env", f"LD_PRELOAD={library}", f"FAKETIME={hours:+d}h"
    return sys.executable, "-m", "tests.support.shifted_clocks", str(3600 * hours)


@cache
def _library() -> str:
    """The file of libfaketime, installed if it may be; empty: there is none."""
    for is_last in (False, True):
        if found := sorted(Path("/usr/lib").glob("*/faketime/libfaketime.so.1")):
            return str(found[0])
        if not is_last:
            install_by_apt("libfaketime")
    return ""


def _shift(shift_s: float) -> None:
    true_s, true_ns = time.time, time.time_ns  # noqa: TID251 - it is taken away from all others
    for name, value in (
        ("time", lambda: true_s() + shift_s),
        ("time_ns", lambda: true_ns() + int(shift_s * 1e9)),
    ):
        setattr(time, name, value)


if __name__ == "__main__":
    _shift(float(sys.argv[1]))
    sys.argv = sys.argv[4:]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)
