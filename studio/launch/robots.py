"""Robots of a plan: which file a node's robot description is made of, and with which arguments."""

from __future__ import annotations

import os
import re
import shlex
import sys
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, Final

from studio.launch.plan import PlannedRobot, Where
from studio.launch.vocabulary.places import here

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.launch.vocabulary.requests import Request

_ROBOTS_MAX: Final = 200
_FILES_MAX: Final = 100
_FILE_MAX_BYTES: Final = 8 << 20
_MARK: Final = re.compile(r"studio-robot (\d+)")
_BEGIN: Final = "$(var "
_BEGIN_AS_WORD: Final = "$(var\0"
_SUFFIXES: Final = (".urdf", ".xacro", ".xml", ".sdf")
_VALUED: Final = frozenset({"-o", "--verbosity", "-v", "--xacro-ns"})


class Robots:
    """Notes robots as launch files come to them."""

    def __init__(self, real: Callable[[str], str]) -> None:
        self._real = real
        self._robots: list[PlannedRobot] = []
        self._opened: dict[str, Where] = {}

    def all(self) -> tuple[PlannedRobot, ...]:
        """Return those that are known."""
        return tuple(self._robots)

    def stand_in(self, file: str, kind: str, mappings: Mapping[str, str], where: Where) -> str:
        """Note a robot and return a text that stands for its description."""
        return _text_of(self._noted(file, kind, mappings, where))

    def _noted(self, file: str, kind: str, mappings: Mapping[str, str], where: Where) -> int:
        real = {name: self._real(value) for name, value in mappings.items()}
        robot = PlannedRobot(self._real(file), kind, real)
        for number, known in enumerate(self._robots):
            if replace(known, node=None, where=Where()) == robot:
                return number
        if len(self._robots) < _ROBOTS_MAX:
            self._robots.append(replace(robot, where=where))
        return len(self._robots) - 1

    def of_command(self, line: str, where: Where) -> str | None:
        """Return a stand-in of what a command prints; None: it makes no robot description."""
        whole = line.replace(_BEGIN, _BEGIN_AS_WORD)  # else a blank in it parts a word
        try:
            words = shlex.split(whole)
        except ValueError:
            words = whole.split()
        words = [word.replace(_BEGIN_AS_WORD, _BEGIN) for word in words]
        while words and os.path.basename(words[0]) in ("ros2", "run", "python3"):  # noqa: PTH119
            words = words[1:]
        if not words:
            return None
        name = os.path.basename(words[0])  # noqa: PTH119 - a word
        if name == "cat" and len(words) == 2:
            return self.stand_in(words[1], "urdf", {}, where)
        if name not in ("xacro", "xacro.py"):
            return None
        while len(words) > 1 and words[1] == "xacro":
            words = words[1:]
        file, mappings = _file_and_mappings(words[1:])
        return self.stand_in(file, "xacro", mappings, where)

    def note_file(self, path: str) -> None:
        """Note a file that was read."""
        if len(self._opened) < _FILES_MAX:
            self._opened.setdefault(path, here())

    def watch_opened_files(self) -> None:
        """Note each file that is opened in this process, from now on, and may be a robot's."""

        def hook(event: str, arguments: tuple[Any, ...]) -> None:
            if event == "open" and isinstance(arguments[0], str) and _may_be(arguments[0]):
                self.note_file(os.path.abspath(arguments[0]))  # noqa: PTH100

        sys.addaudithook(hook)

    def robot_of(self, text: str, where: Where, node: int) -> int | None:
        """Return which robot a text describes, as a place in `all`; None: it is none's."""
        if found := _MARK.search(text):
            number = int(found[1])
        elif "<robot" in text or "<sdf" in text:
            file = self._file_of(text)
            number = self._noted(file, "urdf", {}, self._opened.get(file, where))
        else:
            return None
        return self._given_to(number, node)

    def _given_to(self, number: int, node: int) -> int | None:
        if not 0 <= number < len(self._robots):
            return None
        if self._robots[number].node is None:
            self._robots[number] = replace(self._robots[number], node=node)
        return number

    def _file_of(self, text: str) -> str:
        """Return the opened file that has this text, or the only one that may have become it."""
        wanted = text.strip()
        for path in list(self._opened):
            if _content(path).strip() == wanted:
                return path
        robots = [path for path in self._opened if "<robot" in _content(path)]
        return robots[0] if len(robots) == 1 else ""

    def note_arguments(self, request: Request, node: int) -> None:
        """Note the file that is a robot_state_publisher's argument."""
        if request.executable not in (
            "robot_state_publisher",
            "joint_state_publisher",
            "joint_state_publisher_gui",
        ):
            return
        for word in request.arguments:
            if _may_be(word) and Path(word).is_file():
                self._given_to(self._noted(word, "urdf", {}, request.where), node)

    def xacro_module(self) -> ModuleType:
        """Return a stand-in for xacro's module, which notes what it would expand."""
        module = ModuleType("xacro")
        robots = self

        class Document:
            """What xacro makes of a file."""

            def __init__(self, file: str, mappings: Mapping[str, str]) -> None:
                self._text = robots.stand_in(file, "xacro", mappings, here())
                self.file = file

            def toxml(self, *_: Any, **__: Any) -> str:
                return self._text

            toprettyxml = toxml

        def process_file(input_file_name: Any, mappings: Any = None, **_: Any) -> Document:
            given = {str(k): str(v) for k, v in (mappings or {}).items()}
            return Document(os.fspath(input_file_name), given)

        def process(input_file_name: Any, mappings: Any = None, **_: Any) -> str:
            return process_file(input_file_name, mappings).toxml()

        def parse(inp: Any, filename: Any = None) -> Any:
            return Document(str(filename or getattr(inp, "name", "")), {})

        def process_doc(doc: Any, mappings: Any = None, **_: Any) -> None:
            again = process_file(doc.file, mappings)
            doc.__dict__.update(again.__dict__)

        module.__dict__.update(
            process_file=process_file, process=process, parse=parse, process_doc=process_doc,
            XacroException=type("XacroException", (Exception,), {}),
        )  # fmt: skip
        return module


def _text_of(number: int) -> str:
    return f'<?xml version="1.0"?><robot name="planned"><!-- studio-robot {number} --></robot>'


def _file_and_mappings(words: list[str]) -> tuple[str, dict[str, str]]:
    file, mappings = "", dict[str, str]()
    skip = False
    for word in words:
        name, assigns, value = word.partition(":=")
        if skip:
            skip = False
        elif word in _VALUED:
            skip = True
        elif assigns and not word.startswith("-"):
            mappings[name] = value
        elif not word.startswith("-") and not file:
            file = word
    return file, mappings


def _may_be(path: str) -> bool:
    lower = path.lower()
    return lower.endswith(_SUFFIXES) and not lower.endswith(("package.xml", ".launch.xml"))


def _content(path: str) -> str:
    try:
        with Path(path).open("rb") as file:
            return file.read(_FILE_MAX_BYTES).decode(errors="replace")
    except OSError:
        return ""
