"""Recording 1 kHz of small and 30 Hz of 6 MB beside each other, beside bare Python's libraries."""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from tests.benchmarks.recording_process import RECORDERS, WARM_UP_S, WINDOW_S
from tests.benchmarks.report import judge_ratio, judge_that, note, say
from tests.support.wire import running_router

_ROUNDS = 3
_NAMES = {"ours": "studio bag record", "mcap": "zenoh and mcap", "rosbags": "zenoh and rosbags"}


def run() -> None:
    """Record by each in turn, in other orders; each has the disk to itself."""
    figures: dict[str, list[dict[str, Any]]] = {one: [] for one in RECORDERS}
    for round_number in range(_ROUNDS):
        for recorder in (RECORDERS, RECORDERS[::-1])[round_number % 2]:
            figures[recorder].append(_recorded(recorder))
            say(f"  {_NAMES[recorder]:<24}{json.dumps(figures[recorder][-1])}")
    shares = {one: statistics.median(it["cpu"] for it in found) for one, found in figures.items()}
    for one, share in shares.items():
        note(f"recording 186 MB/s, processor, {_NAMES[one]}", f"{share:.1%}")
    for other in RECORDERS[1:]:
        judge_ratio(
            f"recording takes less processor than {_NAMES[other]}",
            shares[other] / shares["ours"],
            at_least=1.0,
        )
    judge_that(
        "nothing is lost at 186 MB/s, or it is told how many",
        holds=all(it["sent"] == it["written"] + it["lost"] for it in figures["ours"]),
    )
    note("lost of all that was sent", str(sum(it["lost"] for it in figures["ours"])))


def _recorded(recorder: str) -> dict[str, Any]:
    with running_router() as endpoint, tempfile.TemporaryDirectory() as folder:
        taker = _started(recorder, endpoint, Path(folder) / "bag")
        sender = _started("send", endpoint, Path(folder))
        time.sleep(2 * WARM_UP_S + WINDOW_S + 1.5)
        sent = json.loads(_ended(sender))
        found = json.loads(_ended(taker))
        return {**found, "sent": sum(sent.values())}


def _started(role: str, endpoint: str, folder: Path) -> subprocess.Popen[str]:
    words = [
        sys.executable,
        "-m",
        "tests.benchmarks.recording_process",
        role,
        endpoint,
        str(folder),
    ]
    process = subprocess.Popen(words, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    return process


def _ended(process: subprocess.Popen[str]) -> str:
    return process.communicate()[0].splitlines()[-1]
