"""The plan of a launch file: what it would start, as frozen values, JSON both ways.

All texts are what is known before anything runs. A value that depends on an argument without a
value is written as `$(var NAME)`, and a condition that depends on one holds `None`.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TypeAlias

import msgspec

Value: TypeAlias = bool | int | float | str | list[bool | int | float | str | None] | None
"""A parameter's value as JSON has it."""


@dataclass(frozen=True, slots=True)
class Where:
    """A line of a launch file, 1-based; 0 where it is not known."""

    file: str = ""
    line: int = 0

    def __str__(self) -> str:
        return f"{self.file}:{self.line}" if self.line else self.file


@dataclass(frozen=True, slots=True)
class Condition:
    """What a thing depends on; `holds` is None where a value that it needs is not known."""

    text: str
    holds: bool | None


@dataclass(frozen=True, slots=True)
class Argument:
    """An argument that a launch file declares.

    Attributes:
        name: As in `name:=value`.
        default: Its default as text; None: it has none.
        choices: The only values allowed; empty: any.
        description: As written; empty where none is.
        value: The value that counts; None: it needs one and has none.
        given: Whether the caller gave the value.
        where: The line that declares it.
        include: The include that declares it; None: the file itself.
        condition: Only declared if this holds.
    """

    name: str
    default: str | None = None
    choices: tuple[str, ...] = ()
    description: str = ""
    value: str | None = None
    given: bool = False
    where: Where = Where()
    include: int | None = None
    condition: Condition | None = None


@dataclass(frozen=True, slots=True)
class Parameter:
    """A parameter that a node is given.

    Attributes:
        name: Levels parted by dots.
        value: The value; for a robot description its text is not here, see `robot`.
        file: The file of parameters that it comes from; empty: the launch file itself.
        robot: Its robot, as a place in `Plan.robots`; None: it is no robot description.
    """

    name: str
    value: Value = None
    file: str = ""
    robot: int | None = None


@dataclass(frozen=True, slots=True)
class Remap:
    """A name that a node uses, and the one that it gets."""

    source: str
    target: str


@dataclass(frozen=True, slots=True)
class Start:
    """How the studio would start a thing, or why it does not.

    Attributes:
        kind: `node` (of a package's Python code), `studio` (the studio's own), `page` (the page
            shows it), `installed` (a program of this machine), `command` (a command line) or
            `none`.
        text: The file or the command that runs; for `none` half a sentence with the reason.
    """

    kind: str
    text: str

    @property
    def starts(self) -> bool:
        """Whether something runs."""
        return self.kind != "none"


@dataclass(frozen=True, slots=True)
class Node:
    """A node that would run.

    Attributes:
        id: Of this thing within the plan; nodes and processes share the numbers.
        kind: `node`, `lifecycle`, `container` or `composable`.
        package: Of its executable, or of its plug-in.
        executable: Its name in the package; for `composable` the name of its plug-in.
        name: Its name; empty: as its code names it.
        namespace: Absolute, `/` for none.
        full_name: Namespace and name; empty where the name is not known.
        arguments: Words of its command line that are not ROS's.
        ros_arguments: Words that the launch file puts behind `--ros-args` itself.
        output: `screen`, `log`, `both` or another word of ROS.
        container: For `composable` the full name of the container.
        when: Empty: at once; else half a sentence, such as `when spawner exits` or `after 3 s`.
        files: Files of parameters, in the order given.
        prefix: Words before its command, such as those of a debugger.
        cwd: Its folder; empty: that of the launch.
    """

    id: int
    kind: str
    package: str
    executable: str
    name: str = ""
    namespace: str = "/"
    full_name: str = ""
    parameters: tuple[Parameter, ...] = ()
    files: tuple[str, ...] = ()
    remaps: tuple[Remap, ...] = ()
    arguments: tuple[str, ...] = ()
    ros_arguments: tuple[str, ...] = ()
    environment: dict[str, str] = field(default_factory=dict[str, str])
    output: str = "log"
    respawn: bool = False
    respawn_delay_s: float = 0.0
    container: str = ""
    condition: Condition | None = None
    when: str = ""
    include: int | None = None
    where: Where = Where()
    start: Start = Start("none", "")
    prefix: tuple[str, ...] = ()
    cwd: str = ""


@dataclass(frozen=True, slots=True)
class Process:
    """A command that would run; `shell`: by a shell, as one line."""

    id: int
    command: tuple[str, ...]
    name: str = ""
    shell: bool = False
    cwd: str = ""
    environment: dict[str, str] = field(default_factory=dict[str, str])
    output: str = "log"
    respawn: bool = False
    respawn_delay_s: float = 0.0
    condition: Condition | None = None
    when: str = ""
    include: int | None = None
    where: Where = Where()
    start: Start = Start("none", "")


@dataclass(frozen=True, slots=True)
class Include:
    """A launch file within another; `parent` is None right in the file that was asked for."""

    id: int
    file: str
    arguments: dict[str, str] = field(default_factory=dict[str, str])
    parent: int | None = None
    condition: Condition | None = None
    when: str = ""
    where: Where = Where()
    failed: str = ""
    """Why it was not read; empty where it was."""


@dataclass(frozen=True, slots=True)
class Happening:
    """What is done later; what it starts has the same `when`.

    Attributes:
        kind: `on_exit`, `on_start`, `on_io`, `on_shutdown`, `on_completion`, `on_state`, `timer`
            or `other`.
        when: Half a sentence, such as `when spawner exits`.
        does: One line for each of its actions; a function is named, for it decides only then.
    """

    kind: str
    when: str
    does: tuple[str, ...] = ()
    condition: Condition | None = None
    include: int | None = None
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class Setting:
    """A variable of the environment that is set; `value` None: unset."""

    name: str
    value: str | None
    condition: Condition | None = None
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class LogLine:
    """A line that the launch file logs."""

    text: str
    condition: Condition | None = None
    when: str = ""
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class Unsupported:
    """A name that the studio does not know, or does not do; the plan goes on without it."""

    name: str
    sentence: str
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class Failure:
    """What went wrong, in a sentence; the plan holds what could be known all the same."""

    sentence: str
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class Robot:
    """A robot description that a node is given: the file and the arguments that xacro would get.

    `kind` is `xacro` or `urdf`; `node` is the id of the first node that gets it, if one does.
    """

    file: str
    kind: str
    mappings: dict[str, str] = field(default_factory=dict[str, str])
    node: int | None = None
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class Plan:
    """All that a launch file would do with the given arguments.

    Attributes:
        file: The launch file.
        package: The package that it lies in; empty: in none.
        unknown: Names of arguments that were given, and that nobody declares.
        ended: Why planning ended early; empty: it is whole.
    """

    file: str
    package: str = ""
    arguments: tuple[Argument, ...] = ()
    nodes: tuple[Node, ...] = ()
    processes: tuple[Process, ...] = ()
    includes: tuple[Include, ...] = ()
    happenings: tuple[Happening, ...] = ()
    settings: tuple[Setting, ...] = ()
    log: tuple[LogLine, ...] = ()
    robots: tuple[Robot, ...] = ()
    unsupported: tuple[Unsupported, ...] = ()
    failures: tuple[Failure, ...] = ()
    unknown: tuple[str, ...] = ()
    ended: str = ""

    @property
    def missing(self) -> tuple[Argument, ...]:
        """The arguments that need a value and have none."""
        return tuple(one for one in self.arguments if one.value is None)


_DECODER = msgspec.json.Decoder(Plan)


def plan_to_json(plan: Plan) -> bytes:
    """Write a plan as JSON."""
    return msgspec.json.encode(plan)


def plan_from_json(data: bytes) -> Plan:
    """Read a plan.

    Raises:
        msgspec.DecodeError: It is none.
    """
    return _DECODER.decode(data)
