"""`studio bag`: record and play topics (not served yet)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.cli.verbs import Verbs

if TYPE_CHECKING:
    import argparse

_WITH = "with ros2 bag on a machine that has ROS"


def add(parser: argparse.ArgumentParser) -> None:
    """Take any line of `bag`."""
    verbs = Verbs(parser)
    verbs.add_unserved("record", "record topics", "bag record", f"record {_WITH}")
    verbs.add_unserved("play", "play what was recorded", "bag play", f"play it {_WITH}")
    verbs.add_unserved("info", "print what was recorded", "bag info", f"look at it {_WITH}")
