"""The course's listings under `studio run` and under the real rclpy, where it has their types."""

from __future__ import annotations

import re
import signal
import subprocess
import sys
import threading
from typing import TYPE_CHECKING, NamedTuple

import pytest

from tests.support.course_listings import course_folder, cut, listing
from tests.support.ros2_peer import started_program
from tests.support.student_programs import environment_at
from tests.support.sweep import some_of
from tests.support.wire import wait_until

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

pytestmark = pytest.mark.network

_LOG = re.compile(r"\[(\w+)\] \[\d+\.\d+\] \[([^\]]*)\]: (.*)")
_RAISED = re.compile(r"^(?:\w+\.)*(\w+(?:Exception|Error))\b", re.MULTILINE)
ALONE = (
    *("my_first_node", "my_tiny_node", "node_helloworld", "publisher_node"),
    *("my_node", "topic_publisher", "qos_topic_node", "basic_node", "publisher_of_4"),
    *("parameter_node", "timer_node"),
)
SILENT = {"my_first_node", "qos_topic_node"}
PAIRS = (
    ("publisher_node", "subscriber_node", "I heard"),
    ("topic_publisher", "topic_subscriber", "I heard"),
    ("service_server", "service_client", "Result"),
    ("service_server_node", "service_client_node", "Result"),
)


class Program:
    """A listing that runs, and the lines of its log so far."""

    def __init__(self, process: subprocess.Popen[str]) -> None:
        self.process = process
        self.lines: list[str] = []
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    @property
    def logs(self) -> list[str]:
        """Level, name and text of each line in the log."""
        found = map(_LOG.match, list(self.lines))
        return [f"{one[1]} {one[2]} {one[3]}" for one in found if one and one[2] != "rcl"]

    def wait_for_logs(self, count: int) -> None:
        wait_until(f"{count} lines", lambda: len(self.logs) >= count or not self._reader.is_alive())

    def interrupt(self) -> tuple[int, str]:
        """End it by Ctrl-C; its exit code, and what was raised last, if nothing caught it."""
        self.process.send_signal(signal.SIGINT)
        return self.ended()

    def ended(self) -> tuple[int, str]:
        code = self.process.wait(30)
        self._reader.join()
        raised = _RAISED.findall("".join(self.lines))
        # Python ends itself by the signal, the studio by the code that a shell makes of that.
        return 128 - code if code < 0 else code, raised[-1] if raised else ""

    def close(self) -> None:
        self.process.kill()
        self.process.wait()
        self._reader.join()
        if self.process.stdout is not None:
            self.process.stdout.close()

    def _read(self) -> None:
        assert self.process.stderr is not None
        with self.process.stderr as errors:
            self.lines.extend(iter(errors.readline, ""))


class World(NamedTuple):
    """Starts listings, in ROS or here, and ends them."""

    endpoint: str
    folder: Path
    started: list[Program]

    def start(self, name: str, *, real: bool, text: str = "") -> Program:
        file = self.folder / f"{name}.py"
        file.write_text(text or listing(name), encoding="utf-8")
        if real:
            process = started_program(self.endpoint, file)
        else:
            process = subprocess.Popen(
                [sys.executable, "-P", "-m", "studio", "run", "--no-hints", str(file)],
                env=environment_at(self.endpoint),
                stdin=subprocess.DEVNULL,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
            )
        self.started.append(Program(process))
        return self.started[-1]


@pytest.fixture
def world(endpoint: str, tmp_path: Path) -> Generator[World]:
    made = World(endpoint, tmp_path, [])
    yield made
    for one in made.started:
        one.close()


@pytest.mark.parametrize("name", some_of(ALONE, every=4))
def test_a_listing_logs_and_ends_as_under_rclpy(world: World, name: str):
    ours, real = world.start(name, real=False), world.start(name, real=True)
    count = 0 if name in SILENT else 1 if name in {"my_node", "basic_node"} else 3
    if name in SILENT:
        wait_until("both are there", lambda: is_spinning(ours) and is_spinning(real))
    for one in (ours, real):
        one.wait_for_logs(count)
    assert ours.logs[:count] == real.logs[:count] != [""]
    assert ours.interrupt() == real.interrupt()


def is_spinning(program: Program) -> bool:
    """Whether a silent program has caught signals: then it is in its `spin`."""
    status = f"/proc/{program.process.pid}/status"
    with open(status, encoding="utf-8") as file:  # noqa: PTH123
        caught = next(line for line in file if line.startswith("SigCgt"))
    return bool(int(caught.split()[1], 16) & (1 << (signal.SIGTERM - 1)))


@pytest.mark.parametrize("pair", some_of(PAIRS, every=4), ids=lambda pair: pair[0])
@pytest.mark.parametrize("real_first", [True, False])
def test_a_listing_speaks_with_its_other_half_in_ros(
    world: World, pair: tuple[str, str, str], *, real_first: bool
):
    first, second, said = pair
    world.start(first, real=real_first)
    other = world.start(second, real=not real_first)
    wait_until(said, lambda: any(said in line for line in other.logs))


@pytest.mark.skipif(course_folder() is None, reason="STUDIO_COURSE names no folder of its texts")
def test_a_parameter_that_every_node_has_cannot_be_declared_again(world: World):
    printed = cut("parameter_node", corrected=False)
    ours, real = (world.start("printed", real=one, text=printed) for one in (False, True))
    assert ours.ended() == real.ended() == (1, "ParameterAlreadyDeclaredException")
