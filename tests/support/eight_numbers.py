"""A node that publishes eight numbers as it is told, in a process of its own.

`python -m tests.support.eight_numbers` says how many listen; a line `once` has it publish 0 to 7,
a line `run N` the next N messages, a thousand in a second. It ends with its input.
"""

from __future__ import annotations

import subprocess
import sys
import threading
import time
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Final

import studio.ros.client as rclpy
from studio.ros.messages import message
from tests.support.demos import RunningDemo, running

if TYPE_CHECKING:
    from collections.abc import Generator

    from studio.ros.client import Publisher

TOPIC: Final = "/eight"
SERIES: Final = 8
_NUMBERS: Final = "std_msgs/msg/Float64MultiArray"
_LOOK_S: Final = 0.05


class EightNumbers:
    """The process, as a test tells it what to do."""

    def __init__(self, running: RunningDemo) -> None:
        self._running = running

    def wait_for_listeners(self, count: int) -> None:
        """Until so many hear it."""
        self._running.wait_for(f"listeners {count}\n")

    def publish_once(self) -> None:
        """0 to 7."""
        self._tell("once")

    def publish_at_1_khz(self, count: int) -> None:
        """1 to 8, 2 to 9, and so on; does not wait for it."""
        self._tell(f"run {count}")

    def end(self) -> None:
        """Publish nothing more."""
        assert self._running.process.stdin is not None
        self._running.process.stdin.close()
        self._running.wait()

    def _tell(self, line: str) -> None:
        pipe = self._running.process.stdin
        assert pipe is not None
        pipe.write(f"{line}\n")
        pipe.flush()


@contextmanager
def eight_numbers(endpoint: str) -> Generator[EightNumbers]:
    """Have it at a router."""
    words = [sys.executable, "-m", __name__]
    with running(words, endpoint, subprocess.PIPE) as process:
        made = EightNumbers(process)
        try:
            yield made
        finally:
            made.end()


def main() -> None:
    """Do as the lines say."""
    with rclpy.init():
        node = rclpy.create_node("eight_numbers")
        out = node.create_publisher(message(_NUMBERS), TOPIC, 10)
        threading.Thread(target=_say_listeners, args=(out,), daemon=True).start()
        for line in sys.stdin:
            _publish(out, int(line.removeprefix("run ")) if line.startswith("run ") else 0)
        node.destroy_node()


def _say_listeners(out: Publisher) -> None:
    said = 0
    while True:
        if (count := out.get_subscription_count()) != said:
            sys.stdout.write(f"listeners {(said := count)}\n")
            sys.stdout.flush()
        time.sleep(_LOOK_S)


def _publish(out: Publisher, count: int) -> None:
    """Evenly; without a count the very first alone."""
    if count == 0:
        out.publish(_numbers(0))
    began_s = time.monotonic()
    for number in range(1, count + 1):
        out.publish(_numbers(number))
        time.sleep(max(0.0, began_s + number / 1000 - time.monotonic()))


def _numbers(first: int) -> Any:  # noqa: ANN401
    return message(_NUMBERS)(data=[float(first + at) for at in range(SERIES)])


if __name__ == "__main__":
    main()
