"""Displays of an owner's own, good and bad, as texts of their files."""

from __future__ import annotations

import re
from pathlib import Path

_HEAD = """
import sys, os, time
import numpy as np
from studio.displays.display import Display, StillDisplay, TopicRole
from studio.displays.drawing import LinkParts, Placed, Points, Text, Triangles
from studio.displays.properties import Property
"""


def example() -> str:
    """The worked example of the README."""
    readme = Path(__file__).resolve().parents[2] / "README.md"
    section = readme.read_text(encoding="utf-8").partition("### Displays of your own")[2]
    found = re.search(r"```python\n(.*?)```", section, re.DOTALL)
    assert found is not None
    return found[1]


def drawing(kind: str, body: str, more: str = "") -> str:
    """A display that does so when it draws; the second line of `body` is line 13 of the file."""
    lines = "\n".join(f"        {line}" for line in body.splitlines())
    return f"""{_HEAD}
class Made(Display):
    KIND = "{kind}"
    DOC = "It is made for a test."
    def draw(self, now_ns):
{lines}
{more}"""


def points(positions: str, colors: str = "np.array([255, 0, 0], np.uint8)") -> str:
    """The body of one that draws points."""
    return f"""
shape = Points({positions}, {colors})
return {{"cloud": Placed("map", 0, {{"points": shape}})}}"""


GOOD = drawing("Good", points("np.zeros((2, 3), np.float32)"))
BAD: dict[str, tuple[str, str]] = {
    "raises": (drawing("Raises", "x = 1\nraise ValueError('no such luck')"),
               "raises.py:13: ValueError: no such luck"),
    "blocks": (drawing("Blocks", "x = 1\nwhile True:\n    x += 1"), "blocks.py:1"),
    "sleeps": (drawing("Sleeps", "x = 1\nnp.sort(np.zeros(20)); time.sleep(1000)"),
               "sleeps.py:13 in draw: it gave no answer within 1 s"),
    "exits": (drawing("Exits", "sys.exit(3)"), "exits.py:12: SystemExit: 3"),
    "dies": (drawing("Dies", "os._exit(3)"), "dies.py: it ended its process (code "),
    "swells": (drawing("Swells", "x = bytearray(4 << 30)"), "swells.py:12: MemoryError"),
}  # fmt: skip
"""By the name of the file: its text, and what its row says."""

UNLOADABLE: dict[str, tuple[str, str]] = {
    "breaks": ("def (:\n", "breaks.py:1: SyntaxError"),
    "imports": ("import nothing_that_is_there\n",
                "imports.py:1: ModuleNotFoundError: No module named 'nothing_that_is_there'"),
    "empty": ("", "empty.py defines no display"),
    "two": (drawing("One", "return {}", "class More(Made):\n    KIND = 'Two'\n    DOC = 'More.'\n"),
            "two.py defines Made, More: put each display in a file of its own."),
    "refuses": (f"{_HEAD}\nclass Made(StillDisplay):\n    KIND = 'Refuses'\n    DOC = 'It.'\n"
                "    PROPERTIES = (Property('A', 'whole', 'many', 'It.'),)\n", "A is a number"),
}  # fmt: skip
"""The same, of files that hold no display that could be made."""
