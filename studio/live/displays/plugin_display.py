"""A display of the owner's own: its file with the process that runs it, and what stands for it."""

from __future__ import annotations

import asyncio
import itertools
import logging
import os
import re
import tempfile
from collections import deque
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, ClassVar, Final

from studio.displays.display import Display, Status
from studio.displays.drawing import NOTHING
from studio.displays.plugins.packing import (
    ShapeShelf,
    unpack_property,
    unpack_role,
    unpack_status,
)
from studio.displays.plugins.requests import CODEC, Came, Describe, Described, Drawn, Failed, Step
from studio.errors import DisplayError, StudioError, WorkerDiedError, WorkerTimeoutError
from studio.live.displays.plugins import PREFIX
from studio.ros.messages import shared_types
from studio.settings import PLUGIN_LOAD_S, PLUGIN_STEP_S
from studio.workers import Worker

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.displays.display import Received, TopicRole
    from studio.displays.drawing import Drawing
    from studio.displays.properties import Property, Value
    from studio.files import Stamp
    from studio.ros.types.library import TypeLibrary

_IDLE_NS: Final = 100_000_000
"""Without news a plug-in is asked so seldom what it draws now."""
_WAITING_MAX: Final = 100
_CAME_BYTES_MAX: Final = 64 << 20
_NAME: Final = re.compile(r"[A-Za-z][\w ]{0,59}")
_ICON: Final = re.compile(r"[a-zA-Z]{1,30}")
_PLACE: Final = re.compile(r'File "([^"]+)", line (\d+) in (\S+)')

_log = logging.getLogger(__name__)


class PluginFile:
    """One file with the process that runs it; a display that fails is off until it changes."""

    def __init__(self, path: Path, stamp: Stamp) -> None:
        self.path, self.stamp = path, stamp
        self.fault = ""
        """Why it is off, in a sentence; empty: it works."""
        self.kind: type[PluginDisplay] | None = None
        self._texts: frozenset[str] = frozenset()
        """Names of the message types that its process was told of."""
        handle, trace = tempfile.mkstemp(prefix="studio-display-", suffix=".txt")
        os.close(handle)
        self._trace = Path(trace)
        name = path.stem
        self._worker = Worker(
            f'"{path.name}"', "studio.displays.plugins.worker", CODEC, name, trace,
            others_first=True,
        )  # fmt: skip
        self._gone: deque[int] = deque()
        self._is_closed = False

    async def load(self) -> None:
        """Run the file, and make a kind of display of what it defines."""
        self.fault = ""
        texts = self._new_texts(shared_types())
        try:
            answer = await self._worker.ask(Describe(str(self.path), texts), object, PLUGIN_LOAD_S)
            if isinstance(answer, Described):
                self.kind = _kind_of(self, answer)
            else:
                self._switch_off(_sentence_of(answer))
        except StudioError as error:
            self._switch_off(self._said(error))

    async def step(self, step: Step) -> Drawn | None:
        """Have it draw; None: it failed, and is off from now on."""
        if self.fault or self._is_closed:
            return None
        try:
            answer = await self._worker.ask(step, object, PLUGIN_STEP_S, starts=False)
        except StudioError as error:
            if not (self.fault or self._is_closed):
                self._switch_off(self._said(error))
            return None
        if isinstance(answer, Drawn):
            return answer
        self._switch_off(_sentence_of(answer))
        await self._worker.close()
        return None

    def texts_for(self, types: TypeLibrary) -> dict[str, str]:
        """Return the definitions of the user's message types that it does not know yet."""
        return self._new_texts(types) if len(self._texts) != len(types.own_names()) else {}

    def forget(self, number: int) -> None:
        """One of its displays is no more."""
        self._gone.append(number)

    def take_gone(self) -> tuple[int, ...]:
        """Return the numbers of displays that are no more, once."""
        gone = tuple(self._gone)
        self._gone.clear()
        return gone

    async def close(self) -> None:
        """End its process; what waits for it is not said to have failed."""
        self._is_closed = True
        await self._worker.close()
        await asyncio.to_thread(self._trace.unlink, missing_ok=True)

    def _new_texts(self, types: TypeLibrary) -> dict[str, str]:
        names = frozenset(types.own_names())
        new = {name: types.text_of(name) or "" for name in names - self._texts}
        self._texts = names
        return new

    def _switch_off(self, sentence: str) -> None:
        self.fault = sentence
        _log.warning("The display %s is switched off: %s", self.path.name, sentence)

    def _said(self, error: StudioError) -> str:
        """Return why its process gave no answer, and where in the file it was."""
        match error:
            case WorkerTimeoutError():
                what = f"it gave no answer within {error.timeout_s:g} s"
            case WorkerDiedError():
                what = f"it ended its process (code {error.exit_code})"
            case _:
                return f"{self.path.name}: {str(error).rstrip('.')}"
        return f"{self._place()}: {what}"

    def _place(self) -> str:
        """Return where in the file the process was when its time was nearly over."""
        with suppress(OSError):
            for file, line, name in _PLACE.findall(self._trace.read_text("utf-8", "replace")):
                if file == str(self.path):
                    return f"{self.path.name}:{line} in {name}"
        return self.path.name


def _sentence_of(answer: object) -> str:
    return answer.sentence if isinstance(answer, Failed) else "it gave a strange answer"


class PluginDisplay(Display):
    """Stands for a display in another process: passes on what comes, and draws what came back.

    Each file has a class of its own, with what the file says of itself.
    """

    FILE: ClassVar[PluginFile]
    _numbers: ClassVar[itertools.count[int]] = itertools.count(1)

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._number = next(self._numbers)
        self._came: deque[Came] = deque()
        self._lost = 0
        self._reset = self._values_changed = True
        self._asked_ns = 0
        self._working: asyncio.Task[None] | None = None
        self._shelf = ShapeShelf()
        self._drawing: Drawing = NOTHING
        self._statuses: tuple[Status, ...] = ()
        self._refused = self._bad_drawing = ""
        self._roles: tuple[TopicRole, ...] = self.TOPICS
        self._more: tuple[Property, ...] = ()

    def roles(self) -> tuple[TopicRole, ...]:
        """Return the topics that it wanted last."""
        return self._roles

    def properties(self) -> tuple[Property, ...]:
        """Return those of its kind, and those that came with messages."""
        return (*self.PROPERTIES, *self._more)

    def changed(self, name: str) -> None:
        """Pass on the values with the next step."""
        del name
        self._values_changed = True

    def reset(self) -> None:
        """Have it forget its messages."""
        self._came.clear()
        self._reset = True

    def take(self, received: Received, role: str = "") -> None:
        """Keep a message until the next step; of too many the oldest are dropped."""
        self._came.append(Came(role, received.type_name, bytes(received.cdr), received.received_ns))
        size = sum(len(one.cdr) for one in self._came)
        while len(self._came) > _WAITING_MAX or (len(self._came) > 1 and size > _CAME_BYTES_MAX):
            size -= len(self._came.popleft().cdr)
            self._lost += 1

    def draw(self, now_ns: int) -> Drawing:
        """Return what it drew last, and ask for more if it is idle."""
        if self.FILE.fault:
            self._drawing = NOTHING
        elif self._working is None and self._is_due(now_ns):
            self._asked_ns = now_ns
            self._working = asyncio.create_task(self._step(now_ns))
            self._working.add_done_callback(self._stepped)
        return self._drawing

    def statuses(self) -> tuple[Status, ...]:
        """Return what it says, or why it is switched off."""
        if fault := self.FILE.fault:
            sentence = f"It is switched off until its file changes: {fault.rstrip('.')}."
            return (Status("error", "plugin", sentence),)
        found = list(self._statuses)
        if self._lost:
            sentence = f"It is slow: {self._lost:,} messages were left out."
            found.insert(0, Status("warn", "plugin", sentence))
        for fault in (self._refused, self._bad_drawing):
            if fault:
                found.insert(0, Status("error", "bad_message", fault))
        return tuple(found)

    def close(self) -> None:
        """Have its process forget it."""
        self.FILE.forget(self._number)

    def _is_due(self, now_ns: int) -> bool:
        news = self._came or self._reset or self._values_changed
        return bool(news) or not 0 <= now_ns - self._asked_ns < _IDLE_NS

    async def _step(self, now_ns: int) -> None:
        came = tuple(self._came)
        self._came.clear()
        step = Step(
            self._number, dict(self.values) if self._values_changed else None, self._reset, came,
            now_ns, self.FILE.take_gone(), self.FILE.texts_for(self._types),
        )  # fmt: skip
        self._reset = self._values_changed = False
        drawn = await self.FILE.step(step)
        if drawn is None:
            return
        self._refused = drawn.refused if came else self._refused
        try:
            if drawn.groups is not None:
                # Arrays of many numbers are looked through: not on the loop.
                self._drawing = await asyncio.to_thread(
                    self._shelf.unpack, drawn.groups, drawn.shapes
                )
            self._bad_drawing = ""
            self._statuses = tuple(map(unpack_status, drawn.statuses[:20]))
            self._roles = tuple(map(unpack_role, drawn.roles[:10]))
            self._more = tuple(map(unpack_property, drawn.more[:1000]))
        except StudioError as error:
            self._bad_drawing = str(error)
            self._shelf, self._reset = ShapeShelf(), False
            self.FILE.forget(self._number)
            self._number, self._values_changed = next(self._numbers), True

    def _stepped(self, task: asyncio.Task[None]) -> None:
        self._working = None
        if not task.cancelled() and (error := task.exception()):
            _log.error("A plug-in could not be asked.", exc_info=error)

    def _property(self, name: str) -> Property:
        for one in self._more:
            if one.name == name:
                return one
        return super()._property(name)


class MissingDisplay(Display):
    """Keeps the place of a display that was saved and cannot be made here, as RViz's own does."""

    KIND: ClassVar[str] = "Missing"
    DOC: ClassVar[str] = "A display that is not here."
    ICON: ClassVar[str] = "alert"

    def __init__(self, types: TypeLibrary, why: Callable[[], Status]) -> None:
        super().__init__(types)
        self._why = why

    def draw(self, now_ns: int) -> Drawing:
        """Nothing is seen of it."""
        del now_ns
        return NOTHING

    def statuses(self) -> tuple[Status, ...]:
        """Return why it is not here, and what would bring it."""
        return (self._why(),)


def _kind_of(file: PluginFile, described: Described) -> type[PluginDisplay]:
    """Return the class that stands for the display of a file.

    Raises:
        DisplayError: What it says of itself makes no sense.
    """
    if not _NAME.fullmatch(described.kind):
        raise DisplayError("its KIND is no name of 60 letters at most.")
    return type(
        "PluginDisplay",
        (PluginDisplay,),
        {
            "FILE": file,
            "KIND": PREFIX + described.kind,
            "DOC": described.doc[:500],
            "ICON": described.icon if _ICON.fullmatch(described.icon) else "box",
            "FIRST_TOPIC": described.first_topic[:300],
            "TOPICS": tuple(map(unpack_role, described.topics[:10])),
            "PROPERTIES": tuple(map(unpack_property, described.properties[:1000])),
        },
    )
