"""Values on a command line: what begins with a dash may be a number or YAML, and no option."""

from __future__ import annotations

import argparse
import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

# `-1` alone is an option of `topic pub`; argparse itself knows it as a number elsewhere.
_VALUE = re.compile(r"-(?!1$)(\d|\.\d|\.?inf\b|\.?nan\b|$)", re.IGNORECASE)

_HIGHEST_DOMAIN = 232


def domain_number(text: str) -> int:
    """Read a ROS_DOMAIN_ID, for argparse."""
    number = int(text)
    if not 0 <= number <= _HIGHEST_DOMAIN:
        raise argparse.ArgumentTypeError(f"{number} is no domain: 0 to {_HIGHEST_DOMAIN}")
    return number


def shield_values(words: Sequence[str]) -> list[str]:
    """Put a blank before values that begin with a dash, which argparse then takes for values.

    YAML and Python's numbers pass over the blank; words behind `--` are values already.
    """
    end = words.index("--") if "--" in words else len(words)
    shielded = [f" {word}" if _VALUE.match(word) else word for word in words[:end]]
    return [*shielded, *words[end:]]
