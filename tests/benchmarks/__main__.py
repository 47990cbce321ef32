"""`python -m tests.benchmarks [name ...]`: all benchmarks, or those whose name is given.

The name of a group stands for all that are in it.
"""

from __future__ import annotations

import argparse
import sys
from functools import partial
from typing import TYPE_CHECKING

from tests.benchmarks import (
    bag_drag,
    bag_plot,
    bags,
    classroom,
    copies,
    data_images,
    data_lane,
    dds,
    displays,
    drag,
    edit_to_pixels,
    edit_to_websocket,
    evaluator,
    fan_out,
    first_message,
    large,
    launch_start,
    line,
    live_clouds,
    live_scene,
    loop,
    memory,
    meshes_to_websocket,
    page,
    recording,
    relays,
    rewinding,
    rounds,
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
    "node": first_message.run,
    "launch": launch_start.run,
    "evaluator": evaluator.run,
    "edit": edit_to_websocket.run,
    "pixels": edit_to_pixels.run,
    "drag": drag.run,
    "fanout": fan_out.run,
    "classroom": classroom.run,
    "copies": copies.run,
    "relays": relays.run,
    "line": line.run,
    "live": live_scene.run,
    "clouds": live_clouds.run,
    "large": large.run,
    "meshes": meshes_to_websocket.run,
    "tf": tf.run,
    "wire": wire.run,
    "dds": dds.run,
    "recording": recording.run,
    "rewinding": rewinding.run,
    "bag_reading": bags.run,
    "bag_drag": bag_drag.run,
    "bag_plot": bag_plot.run,
    "displays": displays.run,
    "loop": loop.run,
    "data": data_lane.run,
    "images": data_images.run,
    "memory": memory.run,
}
GROUPS: dict[str, tuple[str, ...]] = {"bags": ("bag_reading", "bag_drag", "bag_plot", "recording")}


def main(arguments: list[str]) -> int:
    """Run the named ones; answers the exit code."""
    options = _read(arguments)
    names = [name for one in options.names for name in GROUPS.get(one, (one,))]
    unknown = [name for name in names if name not in BENCHMARKS]
    if unknown:
        known = ", ".join((*BENCHMARKS, *GROUPS))
        say(f"There is no benchmark {unknown[0]}: choose of {known}.")
        return 2
    say_machine()
    runs = {**BENCHMARKS, "memory": partial(memory.run, options.minutes)}
    for name in names or runs:
        say(f"\n[{name}]")
        runs[name]()
    say_verdicts()
    rounds.say_beside_last(rounds.figures())
    if options.keep:
        say(f"\nkept in {rounds.keep(options.keep, rounds.figures())}")
    return 0


def _read(arguments: list[str]) -> argparse.Namespace:
    """The names, for how many minutes memory is watched, and the round to keep the figures as."""
    parser = argparse.ArgumentParser(prog="python -m tests.benchmarks")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--minutes", type=float, default=1.0, help="for which memory is watched")
    parser.add_argument(
        "--keep", default="", metavar="ROUND", help="write the figures as a round's"
    )
    return parser.parse_args(arguments)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
