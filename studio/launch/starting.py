"""How the studio would start a node or a command, or why it does not."""

from __future__ import annotations

import os
import shlex
import shutil
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

from studio.errors import EntryPointError, ProgramNotFoundError, StudioError
from studio.launch.plan import PlannedStart
from studio.launch.vocabulary.texts import is_unknown
from studio.programs.finding import command_program, find_program, workspace_folder

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.launch.vocabulary.requests import Request
    from studio.packages.index import PackageIndex
    from studio.programs.program import Program

_KINDS: Final = {
    "workspace": "node",
    "studio": "studio",
    "installed": "installed",
    "command": "command",
}
_NOT_SERVED: Final = {
    "gazebo_ros": "the studio has no physics: start Gazebo where ROS is installed",
    "ros_gz_sim": "the studio has no physics: start Gazebo where ROS is installed",
    "ros_ign_gazebo": "the studio has no physics: start Gazebo where ROS is installed",
    "ros_gz_bridge": "there is no Gazebo to bridge to",
    "controller_manager": "the studio runs no ros2_control: start it where ROS is installed",
    "rqt_graph": "the Graph panel shows what it shows",
    "rqt_gui": "the studio's panels show what rqt shows",
    "rqt_console": "the Log panel shows what it shows",
}
"""What is known of packages that the studio does not have."""


@dataclass(frozen=True, slots=True)
class Beginning:
    """What runs, as `Start` says it.

    Attributes:
        command: Its words, without those that the launch file adds; empty where nothing runs.
        environment: Variables that it needs.
        config: Of rviz2, which the page shows: the file behind `-d`.
        fails_in_ros: Nothing runs by a fault of the user's own package: ROS 2 ends the launch.
    """

    start: PlannedStart
    command: tuple[str, ...] = ()
    environment: Mapping[str, str] = field(default_factory=dict[str, str])
    config: str = ""
    fails_in_ros: bool = False

    @property
    def fault(self) -> str:
        """What is wrong with the user's own package, as half a sentence; empty: nothing is."""
        if not self.fails_in_ros:
            return ""
        return f"{self.start.text}: it would fail in ROS 2, too, where that ends the launch"


def beginning_of(index: PackageIndex, request: Request) -> Beginning:
    """Find how a request is started."""
    if request.kind == "composable":
        return _none("the studio loads no compiled plug-ins: start it where ROS is installed")
    if request.kind == "process":
        return _of_command(index, request)
    named = (request.package, request.executable)
    if any(is_unknown(one) for one in named):
        return _none("which one depends on an argument that has no value")
    if not request.package:
        return _of_words([request.executable], {})
    if request.kind == "container":
        return _none("it loads compiled plug-ins, which the studio does not: start it in ROS")
    try:
        program = find_program(index, *named)
    except StudioError as error:
        known = _NOT_SERVED.get(request.package)
        if known is not None:
            return _none(known)
        is_users = isinstance(error, ProgramNotFoundError | EntryPointError) and (
            workspace_folder(index, request.package) is not None
        )
        return replace(_none(_half(str(error))), fails_in_ros=is_users)
    if named == ("rviz2", "rviz2"):
        return Beginning(
            PlannedStart("page", "the page shows it"),
            program.command,
            {},
            config_of(request.arguments),
        )
    return _of_program(program)


def config_of(arguments: list[str]) -> str:
    """Return the file behind `-d` or `--display-config`; empty: none is given."""
    for number, word in enumerate(arguments):
        if word in ("-d", "--display-config"):
            return (arguments[number + 1 :] or [""])[0]
        if word.startswith("--display-config="):
            return word.partition("=")[2]
    return ""


def _of_program(program: Program) -> Beginning:
    text = str(program.file) if program.file is not None else " ".join(program.command[3:])
    start = PlannedStart(_KINDS[program.kind], text or program.command[0])
    return Beginning(start, program.command, dict(program.environment))


def _of_command(index: PackageIndex, request: Request) -> Beginning:
    words = request.command
    if any(is_unknown(word) for word in words):
        return _none("a word of it depends on an argument that has no value")
    if request.shell:
        return _of_shell(index, " ".join(words))
    try:
        program = command_program(index, words)
    except StudioError as error:
        return _none(_half(str(error)))
    if program is not None:
        return _of_program(program)
    if os.path.basename(words[0]) == "ros2":  # noqa: PTH119 - a word, not a path
        from studio.programs.program import studio_command  # noqa: PLC0415

        command = studio_command(words[1:])
        return Beginning(PlannedStart("command", "studio " + " ".join(words[1:])), command)
    return _of_words(words, {})


def _of_shell(index: PackageIndex, line: str) -> Beginning:
    """Start a line by the shell; where it is one `ros2 ...`, the studio's own does it."""
    try:
        words = shlex.split(line)
    except ValueError as error:
        return _none(f"the line is none that a shell takes ({error})")
    is_plain = not any(letter in line for letter in "|&;<>()$`\\*?[#~=%{")
    if words and os.path.basename(words[0]) in ("ros2", "rviz2", "xacro"):  # noqa: PTH119
        from studio.launch.vocabulary.requests import Request  # noqa: PLC0415

        if is_plain or words[0] == "ros2":
            return _of_command(index, Request(None, "process", command=words))
    return Beginning(PlannedStart("command", line), ("/bin/sh", "-c", line))


def _of_words(words: list[str], environment: dict[str, str]) -> Beginning:
    found = shutil.which(words[0]) if words and words[0] else None
    if found is None:
        name = words[0] if words else ""
        if len(words) == 1 and len(parts := name.split()) > 1 and os.sep not in parts[0]:
            return _none(
                f"'{name}' is one word of cmd, and so the name of a program: write {parts}, or "
                "shell=True"
            )
        return _none(f"{name} is no program on this machine: install it, or give its whole path")
    return Beginning(PlannedStart("installed", found), (found, *words[1:]), environment)


def _none(reason: str) -> Beginning:
    return Beginning(PlannedStart("none", reason))


def _half(sentence: str) -> str:
    return sentence.rstrip(".")
