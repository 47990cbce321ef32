"""From the start of a node of a user's to its first message, beside the real rclpy where it is."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import TYPE_CHECKING, Final

from tests.benchmarks.report import Timings, say_beside
from tests.support.ros2_peer import started_program
from tests.support.student_programs import environment_at
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Callable

RUNS: Final = 7
_PROGRAM: Final = """\
import rclpy
from rclpy.node import Node
from std_msgs.msg import String

rclpy.init()
node = Node("first")
node.create_publisher(String, "topic", 10).publish(String(data="x"))
print("sent", flush=True)
rclpy.shutdown()
"""


def run() -> None:
    """Start the same program by `studio run`, and with the real rclpy."""
    ours, theirs = Timings("studio run, to the first message"), Timings("the real rclpy")
    with running_router() as endpoint, tempfile.TemporaryDirectory() as scratch:
        file = Path(scratch) / "first.py"
        file.write_text(_PROGRAM)
        words = [sys.executable, "-P", "-m", "studio", "run", str(file)]

        def start() -> subprocess.Popen[str]:
            environment = environment_at(endpoint)
            return subprocess.Popen(words, env=environment, stdout=subprocess.PIPE, text=True)

        for _ in range(RUNS):
            _take(ours, start)
            if os.environ.get("STUDIO_ROS2_PEER"):
                _take(theirs, lambda: started_program(endpoint, file))
    say_beside("a node that publishes once, a router runs", *(
        one for one in (ours, theirs) if one.values_ms
    ))  # fmt: skip


def _take(timings: Timings, start: Callable[[], subprocess.Popen[str]]) -> None:
    begin_s = time.perf_counter()
    with start() as process:
        assert process.stdout is not None
        for line in process.stdout:
            if line == "sent\n":
                timings.values_ms.append((time.perf_counter() - begin_s) * 1000)
        process.communicate()
