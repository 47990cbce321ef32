"""Values on a command line that begin with a dash: numbers and YAML are values, not options."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Sequence

# `-1` alone is an option of `topic pub`; argparse itself knows it as a number elsewhere.
_VALUE = re.compile(r"-(?!1$)(\d|\.\d|\.?inf\b|\.?nan\b|$)", re.IGNORECASE)


def shield_values(words: Sequence[str]) -> list[str]:
    """Put a blank before values that begin with a dash, which argparse then takes for values.

    YAML and Python's numbers pass over the blank; words behind `--` are values already.
    """
    end = words.index("--") if "--" in words else len(words)
    shielded = [f" {word}" if _VALUE.match(word) else word for word in words[:end]]
    return [*shielded, *words[end:]]
