"""What a ROS package may be called, and what to do about a name that is none."""

from __future__ import annotations

import re
from typing import Final

LENGTH_LIMIT: Final = 60
_NAME: Final = re.compile(r"[a-z][a-z0-9]*(?:_[a-z0-9]+)*")


def name_fault(name: str) -> str:
    """What is wrong with a name for a new package, as a sentence; empty when nothing is.

    The rule is that of ROS (REP 144): small letters, digits and single underscores, a letter first.
    """
    if len(name) < 2:
        return "A package name has two characters at least."
    if len(name) > LENGTH_LIMIT:
        return f"A package name has {LENGTH_LIMIT} characters at most."
    if not _NAME.fullmatch(name):
        return (
            "A package name is of small letters, digits and single underscores, "
            "with a letter first and no underscore last: my_rover_description, say."
        )
    return ""


def robot_of(package: str) -> str:
    """The robot that a package describes: its name without the ending that says so."""
    return package.removesuffix("_description") or package
