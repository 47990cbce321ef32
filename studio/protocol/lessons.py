"""Messages about lessons: their texts, checks and ticks; and about the demos that they run."""

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


LessonName: TypeAlias = Annotated[str, Field(max_length=60)]
Language: TypeAlias = Annotated[str, Field(pattern=r"^[a-z]{0,2}$")]
"""Two letters; empty: whatever there is."""
LESSON_MAX = 60_000
"""Characters of the text of a lesson."""


class GetLessons(Command):
    """Ask which lessons there are."""

    type: Literal["get_lessons"] = "get_lessons"


class LessonView(Message):
    """A lesson; one of the course that has a demo is named as its demo."""

    name: str
    chapter: str
    node: str
    """The full name of its demo's node in the graph, while it runs; empty: it has no demo."""
    has_keys: bool
    """Whether the demo is driven by `press_key`."""
    own: bool
    """Whether its text is asked for by `get_lesson_text`, and is no file of the page."""
    writable: bool
    """Whether it was written in the page."""
    version: str
    """Of its text, if that is asked for by `get_lesson_text`: another one when it was written."""
    steps: int
    """Blocks of checks in it."""
    done: int
    """How many of them are done by who asks."""


class Lessons(Event):
    """Answer to `get_lessons`: in the order in which they are taught, chapter by chapter."""

    type: Literal["lessons"] = "lessons"
    request: int
    lessons: tuple[LessonView, ...]


class GetLessonText(Command):
    """Ask for the text of a lesson."""

    type: Literal["get_lesson_text"] = "get_lesson_text"
    lesson: LessonName
    language: Language = ""


class LessonText(Event):
    """Answer to `get_lesson_text`."""

    type: Literal["lesson_text"] = "lesson_text"
    request: int
    text: str


class SaveLesson(Command):
    """Write a lesson in the studio's data folder."""

    type: Literal["save_lesson"] = "save_lesson"
    lesson: LessonName
    language: Language = ""
    text: str = Field(max_length=LESSON_MAX)


class DeleteLesson(Command):
    """Delete a lesson that was written in the page."""

    type: Literal["delete_lesson"] = "delete_lesson"
    lesson: LessonName


class ReadLesson(Command):
    """Ask what is faulty in the text of a lesson."""

    type: Literal["read_lesson"] = "read_lesson"
    text: str = Field(max_length=LESSON_MAX)


class LessonFault(Message):
    """What is wrong with a text, and in which line, counted from 1."""

    line: int
    sentence: str


class CheckView(Message):
    """One check of a lesson, and how it stands."""

    kind: str
    """Names its form, as `topic_type`; empty: the line is faulty, and its step is never done."""
    line: str
    """As it is written."""
    values: dict[str, str]
    """What fills the form."""
    ok: bool = False
    code: str = ""
    """Names what is missing; empty: nothing, or it was not looked at yet."""
    found: dict[str, str] = Field(default_factory=dict)
    """What fills the sentence about what is missing."""


class StepView(Message):
    """A block of checks of a lesson, in the order of its text."""

    id: str
    heading: str
    done_s: float | None = None
    """When all of them held for the first time, in seconds since the epoch."""
    checks: tuple[CheckView, ...]


class LessonRead(Event):
    """Answer to `read_lesson`."""

    type: Literal["lesson_read"] = "lesson_read"
    request: int
    faults: tuple[LessonFault, ...]
    steps: tuple[StepView, ...]


class OpenLesson(Command):
    """Receive `lesson_state` of a lesson from now on, about the document that the page shows."""

    type: Literal["open_lesson"] = "open_lesson"
    lesson: LessonName


class CloseLesson(Command):
    """Receive it no more."""

    type: Literal["close_lesson"] = "close_lesson"


class SawPanel(Command):
    """A panel was opened in the page, which checks of the page ask about."""

    type: Literal["saw_panel"] = "saw_panel"
    panel: Annotated[str, Field(max_length=64)]


class LessonState(Event):
    """How the steps of the opened lesson stand, whenever that changed."""

    type: Literal["lesson_state"] = "lesson_state"
    lesson: str
    steps: tuple[StepView, ...]


class GetLessonTable(Command):
    """Ask who has done which step of a lesson."""

    type: Literal["get_lesson_table"] = "get_lesson_table"
    lesson: LessonName


class LessonRow(Message):
    """A person and their steps."""

    person: str
    name: str
    here: bool
    reads: bool
    """Whether they have the lesson open."""
    done_s: tuple[float | None, ...]
    """When each step was done, in seconds since the epoch."""


class LessonTable(Event):
    """Answer to `get_lesson_table`."""

    type: Literal["lesson_table"] = "lesson_table"
    request: int
    lesson: str
    steps: tuple[StepView, ...]
    rows: tuple[LessonRow, ...]


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
