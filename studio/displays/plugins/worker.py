"""The process of a plug-in: `python -m studio.displays.plugins.worker NAME TRACE`.

It loads one file, makes displays of the class in it, and draws when it is asked. While it works on
a request, a clock without the interpreter's lock runs beside it: after most of the time that it has
it writes into the file TRACE where the plug-in is, for the studio to read if it ends the process.
"""

from __future__ import annotations

import faulthandler
import importlib.util
import inspect
import os
import sys
import traceback
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, TextIO, cast

from studio.displays.display import Display, Received
from studio.displays.plugins.packing import (
    ShapeBook,
    pack_property,
    pack_role,
    pack_status,
)
from studio.displays.plugins.prints import prefix_prints
from studio.displays.plugins.requests import CODEC, Describe, Described, Drawn, Failed, Step
from studio.errors import DisplayError, StudioError
from studio.ros.messages import shared_types
from studio.settings import PLUGIN_LOAD_S, PLUGIN_MEMORY_BYTES, PLUGIN_STEP_S
from studio.worker_process import serve

if TYPE_CHECKING:
    from collections.abc import Mapping
    from types import ModuleType

    from studio.displays.drawing import Drawing
    from studio.displays.properties import Value

_MOST: Final = 0.8
"""Of the time for a request, until it is written where the plug-in is."""
_BYTES_MAX: Final = 64 << 20
"""Of all arrays that are new in one drawing."""
_MODULE: Final = "studio_plugin"


class _Shown:
    """One display of the plug-in and what was sent of it."""

    def __init__(self, display: Display) -> None:
        self.display, self.book = display, ShapeBook()
        self.drawing: Drawing | None = None


class Plugin:
    """Answers requests about one file."""

    def __init__(self, trace: TextIO) -> None:
        self._trace = trace
        self._path = Path()
        self._kind: type[Display] | None = None
        self._shown: dict[int, _Shown] = {}

    def answer(self, request: Describe | Step) -> Described | Drawn | Failed:
        """Answer one request; whatever the plug-in raises is an answer, too."""
        limit_s = PLUGIN_LOAD_S if isinstance(request, Describe) else PLUGIN_STEP_S
        self._trace.seek(0)
        self._trace.truncate()
        faulthandler.dump_traceback_later(_MOST * limit_s, file=self._trace)
        try:
            return self._answer(request)
        except DisplayError as error:
            return Failed(str(error))
        except BaseException as error:  # noqa: BLE001 - it may even want to exit
            return Failed(fault_in(self._path, error))
        finally:
            faulthandler.cancel_dump_traceback_later()

    def _answer(self, request: Describe | Step) -> Described | Drawn:
        if request.texts:
            add_texts(request.texts)
        if isinstance(request, Describe):
            return self._describe(Path(request.path))
        return self._step(request)

    def _describe(self, path: Path) -> Described:
        self._path = path
        kind = self._kind = display_in(_loaded(path), path)
        kind(shared_types())  # what fails at once is to be known now
        return Described(
            str(kind.KIND), str(kind.DOC), str(kind.ICON), str(kind.FIRST_TOPIC),
            tuple(map(pack_role, kind.TOPICS)), tuple(map(pack_property, kind.PROPERTIES)),
        )  # fmt: skip

    def _step(self, request: Step) -> Drawn:
        for number in request.gone:
            self._shown.pop(number, None)
        shown = self._shown.get(request.display)
        if shown is None:
            assert self._kind is not None
            shown = self._shown[request.display] = _Shown(self._kind(shared_types()))
        display = shown.display
        if request.values is not None:
            _set(display, request.values)
        if request.reset:
            display.reset()
        refused = ""
        for one in request.came:
            received = Received(one.type_name, one.cdr, one.received_ns)
            refused = self._taken(display, received, one.role)
        return self._drawn(shown, request.now_ns, refused)

    def _taken(self, display: Display, received: Received, role: str) -> str:
        """Have a message taken in; return why it cannot be read."""
        try:
            display.take(received, role)
        except StudioError as error:
            return str(error)
        return ""

    def _drawn(self, shown: _Shown, now_ns: int, refused: str) -> Drawn:
        display = shown.display
        drawing = display.draw(now_ns)
        groups, shapes = None, ()
        if drawing is not shown.drawing:
            groups, shapes = shown.book.pack(drawing)
            shown.drawing = drawing
            size_bytes = sum(_bytes_of(one.fields) for one in shapes)
            if size_bytes > _BYTES_MAX:
                most = _BYTES_MAX >> 20
                raise DisplayError(
                    f"It draws {size_bytes >> 20} MB at once, and {most} MB are taken."
                )
        own = frozenset(display.PROPERTIES)
        more = (one for one in display.properties() if one not in own)
        return Drawn(
            groups, shapes, tuple(map(pack_status, display.statuses())), refused,
            tuple(map(pack_role, display.roles())), tuple(map(pack_property, more)),
        )  # fmt: skip


def add_texts(texts: dict[str, str]) -> None:
    """Know these message types; what is wrong with one is said when it is used."""
    library = shared_types()
    for name, text in texts.items():
        with suppress(StudioError):
            library.add_texts({name: text})


def _set(display: Display, values: Mapping[str, Value]) -> None:
    for name, value in values.items():
        if display.values.get(name) != value:
            display.set(name, value)


def _bytes_of(fields: Mapping[str, Any]) -> int:
    packed = [cast("dict[str, bytes]", one) for one in fields.values() if isinstance(one, dict)]
    return sum(len(one["data"]) for one in packed)


def _loaded(path: Path) -> ModuleType:
    # Behind all others: a file beside the plug-in shall not stand in for a library.
    sys.path.append(str(path.parent))
    spec = importlib.util.spec_from_file_location(_MODULE, path)
    if spec is None or spec.loader is None:
        raise DisplayError(f"{path.name} is no Python file.")
    module = importlib.util.module_from_spec(spec)
    sys.modules[_MODULE] = module
    spec.loader.exec_module(module)
    return module


def display_in(module: ModuleType, path: Path) -> type[Display]:
    """Return the display that a file defines.

    Raises:
        DisplayError: There is none, there are several, or it has no name.
    """
    found = [
        one
        for one in vars(module).values()
        if inspect.isclass(one) and issubclass(one, Display) and one.__module__ == _MODULE
    ]
    made = [one for one in dict.fromkeys(found) if not inspect.isabstract(one) and _is_named(one)]
    if not made:
        raise DisplayError(
            f"{path.name} defines no display: a class derived from Display, or from one of its "
            "kinds, with a KIND and a DOC."
        )
    if len(made) > 1:
        names = ", ".join(one.__name__ for one in made)
        raise DisplayError(f"{path.name} defines {names}: put each display in a file of its own.")
    return made[0]


def _is_named(kind: type[Display]) -> bool:
    return "KIND" in vars(kind) and bool(getattr(kind, "DOC", ""))


def fault_in(path: Path, error: BaseException) -> str:
    """Return what a plug-in raised, in one line, and where in its file."""
    what = traceback.format_exception_only(error)[-1].strip()
    lines = [one for one in traceback.extract_tb(error.__traceback__) if one.filename == str(path)]
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f"{path.name}:{error.lineno}: {what}"
    return f"{path.name}:{lines[-1].lineno}: {what}" if lines else f"{path.name}: {what}"


def main() -> None:
    """Serve until the pipe closes."""
    name, trace = sys.argv[1], Path(sys.argv[2])
    answers = _answers_apart(name)
    with trace.open("w", encoding="utf-8") as file:
        serve(CODEC, Plugin(file).answer, PLUGIN_MEMORY_BYTES, answers)


def _answers_apart(name: str) -> int:
    """Keep the pipe of answers; what is printed goes to the terminal under the plug-in's name."""
    answers = os.dup(1)
    prefix_prints(name)
    return answers


if __name__ == "__main__":
    main()
