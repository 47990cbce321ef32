"""The plan of a launch file: what it would start, as frozen values; the page gets it as it is.

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
class PlannedCondition:
    """What a thing depends on; `holds` is None where a value that it needs is not known."""

    text: str
    holds: bool | None


@dataclass(frozen=True, slots=True)
class PlannedArgument:
    """An argument that a launch file declares."""

    name: str
    """As in `name:=value`."""
    default: str | None = None
    """Its default as text; None: it has none."""
    choices: tuple[str, ...] = ()
    """The only values allowed; empty: any."""
    description: str = ""
    """As written; empty where none is."""
    value: str | None = None
    """The value that counts; None: it needs one and has none."""
    given: bool = False
    """Whether the caller gave the value."""
    where: Where = Where()
    """The line that declares it."""
    include: int | None = None
    """The include that declares it; None: the file itself."""
    condition: PlannedCondition | None = None
    """Only declared if this holds."""


@dataclass(frozen=True, slots=True)
class PlannedParameter:
    """A parameter that a node is given."""

    name: str
    """Levels parted by dots."""
    value: Value = None
    """The value; for a robot description its text is not here, see `robot`."""
    file: str = ""
    """The file of parameters that it comes from; empty: the launch file itself."""
    robot: int | None = None
    """Its robot, as a place in `Plan.robots`; None: it is no robot description."""


@dataclass(frozen=True, slots=True)
class PlannedRemap:
    """A name that a node uses, and the one that it gets."""

    source: str
    target: str


@dataclass(frozen=True, slots=True)
class PlannedStart:
    """How the studio would start a thing, or why it does not."""

    kind: str
    """`node` (of a package's Python code), `studio` (the studio's own), `page` (the page shows
    it), `installed` (a program of this machine), `command` (a command line) or `none`.
    """
    text: str
    """The file or the command that runs; for `none` half a sentence with the reason."""

    @property
    def starts(self) -> bool:
        """Whether something runs."""
        return self.kind != "none"


@dataclass(frozen=True, slots=True)
class PlannedNode:
    """A node that would run."""

    id: int
    """Of this thing within the plan; nodes and processes share the numbers."""
    kind: str
    """`node`, `lifecycle`, `container` or `composable`."""
    package: str
    """Of its executable, or of its plug-in."""
    executable: str
    """Its name in the package; for `composable` the name of its plug-in."""
    name: str = ""
    """Its name; empty: as its code names it."""
    namespace: str = "/"
    """Absolute, `/` for none."""
    full_name: str = ""
    """Namespace and name; empty where the name is not known."""
    parameters: tuple[PlannedParameter, ...] = ()
    files: tuple[str, ...] = ()
    """Files of parameters, in the order given."""
    remaps: tuple[PlannedRemap, ...] = ()
    arguments: tuple[str, ...] = ()
    """Words of its command line that are not ROS's."""
    ros_arguments: tuple[str, ...] = ()
    """Words that the launch file puts behind `--ros-args` itself."""
    environment: dict[str, str] = field(default_factory=dict[str, str])
    output: str = "log"
    """`screen`, `log`, `both` or another word of ROS."""
    respawn: bool = False
    respawn_delay_s: float = 0.0
    container: str = ""
    """For `composable` the full name of the container."""
    condition: PlannedCondition | None = None
    when: str = ""
    """Empty: at once; else half a sentence, such as `when spawner exits` or `after 3 s`."""
    include: int | None = None
    where: Where = Where()
    start: PlannedStart = PlannedStart("none", "")
    prefix: tuple[str, ...] = ()
    """Words before its command, such as those of a debugger."""
    cwd: str = ""
    """Its folder; empty: that of the launch."""


@dataclass(frozen=True, slots=True)
class PlannedProcess:
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
    condition: PlannedCondition | None = None
    when: str = ""
    include: int | None = None
    where: Where = Where()
    start: PlannedStart = PlannedStart("none", "")


@dataclass(frozen=True, slots=True)
class PlannedInclude:
    """A launch file within another; `parent` is None right in the file that was asked for."""

    id: int
    file: str
    arguments: dict[str, str] = field(default_factory=dict[str, str])
    parent: int | None = None
    condition: PlannedCondition | None = None
    when: str = ""
    where: Where = Where()
    failed: str = ""
    """Why it was not read; empty where it was."""


@dataclass(frozen=True, slots=True)
class PlannedHappening:
    """What is done later; what it starts has the same `when`."""

    kind: str
    """`on_exit`, `on_start`, `on_io`, `on_shutdown`, `on_completion`, `on_state`, `timer` or
    `other`.
    """
    when: str
    """Half a sentence, such as `when spawner exits`."""
    does: tuple[str, ...] = ()
    """One line for each of its actions; a function is named, for it decides only then."""
    condition: PlannedCondition | None = None
    include: int | None = None
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class PlannedSetting:
    """A variable of the environment that is set; `value` None: unset."""

    name: str
    value: str | None
    condition: PlannedCondition | None = None
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class PlannedLog:
    """A line that the launch file logs."""

    text: str
    condition: PlannedCondition | None = None
    when: str = ""
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class PlannedGap:
    """A name that the studio does not know, or does not do; the plan goes on without it."""

    name: str
    sentence: str
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class PlannedFailure:
    """What went wrong, in a sentence; the plan holds what could be known all the same."""

    sentence: str
    where: Where = Where()


@dataclass(frozen=True, slots=True)
class PlannedRobot:
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
    """All that a launch file would do with the given arguments."""

    file: str
    """The launch file."""
    package: str = ""
    """The package that it lies in; empty: in none."""
    arguments: tuple[PlannedArgument, ...] = ()
    nodes: tuple[PlannedNode, ...] = ()
    processes: tuple[PlannedProcess, ...] = ()
    includes: tuple[PlannedInclude, ...] = ()
    happenings: tuple[PlannedHappening, ...] = ()
    settings: tuple[PlannedSetting, ...] = ()
    log: tuple[PlannedLog, ...] = ()
    robots: tuple[PlannedRobot, ...] = ()
    unsupported: tuple[PlannedGap, ...] = ()
    failures: tuple[PlannedFailure, ...] = ()
    unknown: tuple[str, ...] = ()
    """Names of arguments that were given, and that nobody declares."""
    ended: str = ""
    """Why planning ended early; empty: it is whole."""

    @property
    def missing(self) -> tuple[PlannedArgument, ...]:
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
