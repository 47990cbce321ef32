"""Checks of command lines in README files and scripts: options and forms that do not exist."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, Final

from studio.packages.executables import executables
from studio.packages.lint.checked import WARNING, edit, found, meant

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.packages.sources.spans import SourceText
    from studio.problems import Fix, Problem

_DOCTOR: Final = re.compile(rb"ros2 doctor\b[^\r\n`]{0,300}?(--include-dds)\b")
_TYPE_ENDING: Final = re.compile(
    rb"ros2 (?:service|interface|topic|action)\b[^\r\n`]{0,300}?"
    rb"\b\w{1,80}/(?:srv|msg|action)/\w{1,80}(\.(?:srv|msg|action))\b"
)
_LAUNCH: Final = re.compile(rb"(?m)ros2 launch +(<[^<>\r\n]+>|[\w.-]+)[ \t]*(?=[`\r\n#;&]|$)")
_RUN: Final = re.compile(rb"ros2 run +(\w+) +([\w.-]+)")
_CD: Final = re.compile(rb"(?m)^[ \t$]*cd +([^\r\n&;`]+)")
_COLCON: Final = re.compile(rb"(?m)^[ \t$]*colcon build\b")
_SRC: Final = re.compile(r"(?:.*/)?src/?")
FINDINGS_MAX: Final = 50


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield lines that fail as they are written."""
    for name in checked.source.names:
        if name.count("/") > 1 or not name.endswith((".md", ".sh", ".bash", ".txt", ".rst")):
            continue
        text = checked.source.text(name)
        if text is None or not text.is_utf8 or name.endswith("CMakeLists.txt"):
            continue
        for number, one in enumerate(_lines(checked, text)):
            if number < FINDINGS_MAX:
                yield one


def _lines(checked: CheckedPackage, text: SourceText) -> Iterator[Problem]:
    for one in _DOCTOR.finditer(text.data):
        sentence = "ros2 doctor has no --include-dds: --report prints the middleware, too."
        mend = edit("Write --report", text.replaced(one.start(1), one.end(1), "--report"))
        yield found(WARNING, "shell-doctor", sentence, text, one.start(1), mend)
    for one in _TYPE_ENDING.finditer(text.data):
        ending = one[1].decode()
        sentence = f"A type is named without the {ending} of its file."
        mend = edit(f"Remove {ending}", text.replaced(one.start(1), one.end(1), ""))
        yield found(WARNING, "shell-type", sentence, text, one.start(), mend)
    for one in _LAUNCH.finditer(text.data):
        what = one[1].decode()
        if not what.endswith((".py", ".xml", ".yaml")):
            sentence = (
                f"ros2 launch {what} names no launch file: ros2 launch PACKAGE FILE.launch.py is "
                "meant; a single node is started by ros2 run."
            )
            yield found(WARNING, "shell-launch", sentence, text, one.start())
    for one in _RUN.finditer(text.data):
        source = checked.packages.get(one[1].decode())
        names = {each.name for each in executables(source)} if source else set[str]()
        name = one[2].decode()
        if source is not None and source.is_python and name not in names:
            right = meant(name, names, 0.6)
            mend: Fix | None = None
            if right:
                mend = edit(f"Write {right}", text.replaced(one.start(2), one.end(2), right))
            sentence = f'{one[1].decode()} has no executable "{name}".'
            yield found(WARNING, "shell-run", sentence, text, one.start(), mend)
    yield from _built_in_src(text)


def _built_in_src(text: SourceText) -> Iterator[Problem]:
    moves = [(one.start(), one[1].decode().strip()) for one in _CD.finditer(text.data)]
    for one in _COLCON.finditer(text.data):
        before = [where for at, where in moves if at < one.start()]
        if before and _SRC.fullmatch(before[-1]):
            sentence = (
                "colcon build is run in the workspace, the folder above src: inside src it makes "
                "build, install and log there."
            )
            at = one.start() + len(one[0]) - len(one[0].lstrip(b" \t$"))
            line = f"cd ..{text.line_break}{text.indent_at(at)}"
            mend = edit("Go up first", text.put_in(at, line))
            yield found(WARNING, "shell-colcon", sentence, text, at, mend)


WHY: Final = {
    "shell-doctor": {
        "en": "ros2 doctor stops at an option that it does not have.",
        "de": "ros2 doctor bricht bei einer Option ab, die es nicht gibt.",
    },
    "shell-type": {
        "en": 'ros2 says "The passed service type is invalid".',
        "de": "ros2 meldet „The passed service type is invalid“.",
    },
    "shell-launch": {
        "en": "ros2 launch starts launch files: it takes a package and a file, or a path.",
        "de": "ros2 launch startet Launch-Dateien: ein Paket und eine Datei, oder einen Pfad.",
    },
    "shell-run": {
        "en": "ros2 run starts executables by the names in console_scripts.",
        "de": "ros2 run startet Programme unter den Namen aus console_scripts.",
    },
    "shell-colcon": {
        "en": "setup.bash is then looked for in the wrong place, and packages are found twice.",
        "de": "setup.bash liegt dann am falschen Ort, und Pakete werden doppelt gefunden.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
