from __future__ import annotations

import os
import signal
import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from studio.course.processes import DemoProcesses
from tests.support.demos import ENDS_WITHIN_S, heard, node_at, running
from tests.support.patience import Stopwatch
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from pathlib import Path

pytestmark = pytest.mark.network

STUBBORN = """
import signal
for number in (signal.SIGINT, signal.SIGTERM):
    signal.signal(number, signal.SIG_IGN)
print("deaf", flush=True)
signal.pause()
"""


LEAVES = """
import os, sys
from studio.course.processes import DemoProcesses
DemoProcesses().start_leashed("studio.course.talker")
sys.stdin.readline()
os._exit(0)
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_studio_demos_starts_several_and_one_signal_ends_all_within_two_seconds(
    endpoint: str, number: int
):
    words = [sys.executable, "-m", "studio", "demos", "--connect", endpoint, "talker", "listener"]
    with running(words, endpoint) as demos:
        demos.wait_for("studio topic echo /chatter")
        demos.wait_for("I heard:")
        demos.stop(number)
        assert "Traceback" not in demos.printed


def test_arguments_of_ros_reach_each_demo(endpoint: str):
    words = [sys.executable, "-m", "studio", "demos", "--connect", endpoint, "talker", "listener"]
    with (
        node_at(endpoint) as node,
        running([*words, "--ros-args", "-r", "chatter:=elsewhere"], endpoint) as demos,
    ):
        heard_elsewhere = heard(node, "std_msgs/msg/String", "/elsewhere")
        wait_until("the talker elsewhere", lambda: bool(heard_elsewhere))
        demos.wait_for("I heard:")


def test_one_that_hears_no_signal_is_made_to_end(tmp_path: Path, capfd: pytest.CaptureFixture[str]):
    (tmp_path / "stubborn.py").write_text(STUBBORN)
    processes = DemoProcesses({**os.environ, "PYTHONPATH": str(tmp_path)})
    processes.start("stubborn")
    wait_until("it runs", lambda: "deaf" in capfd.readouterr().out)
    watch = Stopwatch()
    processes.end()
    assert watch.s < ENDS_WITHIN_S
    assert processes.wait() == -signal.SIGKILL


def test_one_on_a_leash_ends_with_a_process_that_leaves_without_a_word(endpoint: str):
    with running([sys.executable, "-c", LEAVES], endpoint, subprocess.PIPE) as process:
        process.wait_for("Hello World")
        assert process.process.stdin is not None
        process.process.stdin.close()
        assert process.wait() == 0  # and all that it started has closed what it prints to


def test_a_demo_takes_no_module_from_the_folder_that_somebody_works_in(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    (tmp_path / "this.py").write_text("raise SystemExit(3)\n")
    monkeypatch.chdir(tmp_path)
    with DemoProcesses() as processes:
        processes.start("this")
        assert processes.wait() == 0


def test_the_first_code_that_is_not_zero_is_answered():
    with DemoProcesses() as processes:
        processes.start("this")
        processes.start("no_such_module")
        assert processes.wait() == 1
