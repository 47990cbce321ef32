"""Messages about lessons: the demos, which of them run, and what they print."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field

from studio.protocol.message import Command, Event, Message

DemoName: TypeAlias = Annotated[str, Field(max_length=100)]
"""As `studio demos` lists it."""
Key: TypeAlias = Literal[
    "up", "down", "left", "right", "g", "t", "r", "e", "d", "c", "v", "b", "f", "q"
]
"""Keys that demos read."""


class GetLessons(Command):
    """Ask which demos there are."""

    type: Literal["get_lessons"] = "get_lessons"


class LessonView(Message):
    """A demo as a lesson."""

    demo: str
    chapter: str
    node: str
    """Its full name in the graph, while it runs."""
    has_keys: bool
    """Whether it is driven by `press_key`."""


class Lessons(Event):
    """Answer to `get_lessons`: in the order in which they are taught, chapter by chapter."""

    type: Literal["lessons"] = "lessons"
    request: int
    lessons: tuple[LessonView, ...]


class GetDemos(Command):
    """Ask which demos run."""

    type: Literal["get_demos"] = "get_demos"


class DemoView(Message):
    """A demo that was started from a page."""

    demo: str
    state: Literal["starting", "running", "stopping", "stopped", "ended"]
    """`running`: its node was seen; `stopped`: from a page; `ended`: by itself."""
    for_s: float
    """Seconds since it was started, or since its end."""
    code: int
    """Exit code; below 0: the signal that ended it."""
    reason: str
    """The last line that it printed, once it has ended."""


class Demos(Event):
    """Answer to `get_demos`."""

    type: Literal["demos"] = "demos"
    request: int
    demos: tuple[DemoView, ...]
    """Those started since the studio started."""
    elsewhere: tuple[str, ...]
    """Demos whose node runs, though no page started it."""


class GetDemoOutput(Command):
    """Ask what a demo printed, in its last run."""

    type: Literal["get_demo_output"] = "get_demo_output"
    demo: DemoName
    run: int = 0
    """The run that `after` belongs to; 0: none."""
    after: int = Field(default=0, ge=0)
    """Lines up to this one are known."""


class DemoOutput(Event):
    """Answer to `get_demo_output`."""

    type: Literal["demo_output"] = "demo_output"
    request: int
    run: int
    """If it is not the run asked about, the lines known are of an earlier run."""
    lines: tuple[str, ...]
    last: int
    """Number of the last of them; the first of a run is 1."""


class GetDemoCode(Command):
    """Ask for the source code of a demo."""

    type: Literal["get_demo_code"] = "get_demo_code"
    demo: DemoName


class CodeFile(Message):
    """One Python file of a demo."""

    name: str
    """Below the folder of the demos, as `turtlesim/turtle.py`."""
    text: str


class DemoCode(Event):
    """Answer to `get_demo_code`: the file that is run first, then those of its own package."""

    type: Literal["demo_code"] = "demo_code"
    request: int
    files: tuple[CodeFile, ...]


class StartDemo(Command):
    """Start a demo as a process of its own, in the system that the studio is connected with."""

    type: Literal["start_demo"] = "start_demo"
    demo: DemoName


class StopDemo(Command):
    """End a demo that was started from a page; done when it has ended."""

    type: Literal["stop_demo"] = "stop_demo"
    demo: DemoName


class PressKey(Command):
    """Press a key of a demo that is driven by keys."""

    type: Literal["press_key"] = "press_key"
    demo: DemoName
    pressed: Key
