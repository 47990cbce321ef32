"""`python -m tests.benchmarks [name ...]`: all benchmarks, or those whose name is given."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

from tests.benchmarks import (
    displays,
    drag,
    edit_to_pixels,
    edit_to_websocket,
    evaluator,
    fan_out,
    live_scene,
    meshes_to_websocket,
    page,
    start,
    tf,
    wire,
)
from tests.benchmarks.report import say, say_machine, say_verdicts

if TYPE_CHECKING:
    from collections.abc import Callable

BENCHMARKS: dict[str, Callable[[], None]] = {
    "start": start.run,
    "page": page.run,
    "evaluator": evaluator.run,
    "edit": edit_to_websocket.run,
    "pixels": edit_to_pixels.run,
    "drag": drag.run,
    "fanout": fan_out.run,
    "live": live_scene.run,
    "meshes": meshes_to_websocket.run,
    "tf": tf.run,
    "wire": wire.run,
    "displays": displays.run,
}


def main(names: list[str]) -> int:
    """Run the named ones; answers the exit code."""
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        say(f"There is no benchmark {unknown[0]}: choose of {', '.join(BENCHMARKS)}.")
        return 2
    say_machine()
    for name in names or BENCHMARKS:
        say(f"\n[{name}]")
        BENCHMARKS[name]()
    say_verdicts()
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
