"""Messages about the plan of a launch file: its arguments, and all that it would start.

Fields are those of `studio.launch.plan`, where they are explained.
"""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.protocol.message import ArgumentName, Command, Event, Message

_PATH_MAX = 4096
_ARGUMENTS_MAX = 200
FilePath: TypeAlias = Annotated[str, StringConstraints(min_length=1, max_length=_PATH_MAX)]
Word: TypeAlias = Annotated[str, StringConstraints(max_length=10_000)]
LaunchArguments: TypeAlias = Annotated[dict[ArgumentName, Word], Field(max_length=_ARGUMENTS_MAX)]
ParameterValue: TypeAlias = bool | int | float | str | list[bool | int | float | str | None] | None


class PlanLaunch(Command):
    """Ask what a launch file would start; a later one of the same person ends this one."""

    type: Literal["plan_launch"] = "plan_launch"
    file: FilePath
    arguments: LaunchArguments = Field(default_factory=dict)


class CancelPlan(Command):
    """End the planning that the same person asked for."""

    type: Literal["cancel_plan"] = "cancel_plan"


class PlannedWhere(Message):
    """A line of a launch file, 1-based; 0 where it is not known."""

    file: str
    line: int


class PlannedCondition(Message):
    """What a thing depends on; `holds` null where a value that it needs is not known."""

    text: str
    holds: bool | None


class PlannedArgument(Message):
    """An argument that a launch file declares; `value` null: it needs one and has none."""

    name: str
    default: str | None
    choices: tuple[str, ...]
    description: str
    value: str | None
    given: bool
    where: PlannedWhere
    include: int | None
    condition: PlannedCondition | None


class PlannedParameter(Message):
    """A parameter that a node is given; `robot` is the place of its robot in those of the plan."""

    name: str
    value: ParameterValue
    file: str
    robot: int | None


class PlannedRemap(Message):
    """A name that a node uses, and the one that it gets."""

    source: str
    target: str


class PlannedStart(Message):
    """How the studio would start a thing, or, for `none`, half a sentence why it does not."""

    kind: str
    text: str


class PlannedNode(Message):
    """A node that would run."""

    id: int
    kind: str
    package: str
    executable: str
    name: str
    namespace: str
    full_name: str
    parameters: tuple[PlannedParameter, ...]
    files: tuple[str, ...]
    remaps: tuple[PlannedRemap, ...]
    arguments: tuple[str, ...]
    output: str
    respawn: bool
    respawn_delay_s: float
    container: str
    condition: PlannedCondition | None
    when: str
    include: int | None
    where: PlannedWhere
    start: PlannedStart


class PlannedProcess(Message):
    """A command that would run."""

    id: int
    command: tuple[str, ...]
    name: str
    shell: bool
    respawn: bool
    condition: PlannedCondition | None
    when: str
    include: int | None
    where: PlannedWhere
    start: PlannedStart


class PlannedInclude(Message):
    """A launch file within another; `parent` is null right in the file that was asked for."""

    id: int
    file: str
    arguments: dict[str, str]
    parent: int | None
    condition: PlannedCondition | None
    when: str
    where: PlannedWhere
    failed: str


class PlannedHappening(Message):
    """What is done later."""

    kind: str
    when: str
    does: tuple[str, ...]
    condition: PlannedCondition | None
    include: int | None
    where: PlannedWhere


class PlannedSetting(Message):
    """A variable of the environment that is set; `value` null: unset."""

    name: str
    value: str | None
    condition: PlannedCondition | None
    where: PlannedWhere


class PlannedLog(Message):
    """A line that the launch file logs."""

    text: str
    condition: PlannedCondition | None
    when: str
    where: PlannedWhere


class PlannedGap(Message):
    """A name that the studio does not know, or does not do."""

    name: str
    sentence: str
    where: PlannedWhere


class PlannedFailure(Message):
    """What went wrong."""

    sentence: str
    where: PlannedWhere


class PlannedRobot(Message):
    """A robot description that a node is given, and the arguments that xacro would get."""

    file: str
    kind: str
    mappings: dict[str, str]
    node: int | None
    where: PlannedWhere


class PlanView(Message):
    """All that a launch file would do with the given arguments."""

    file: str
    package: str
    arguments: tuple[PlannedArgument, ...]
    nodes: tuple[PlannedNode, ...]
    processes: tuple[PlannedProcess, ...]
    includes: tuple[PlannedInclude, ...]
    happenings: tuple[PlannedHappening, ...]
    settings: tuple[PlannedSetting, ...]
    log: tuple[PlannedLog, ...]
    robots: tuple[PlannedRobot, ...]
    unsupported: tuple[PlannedGap, ...]
    failures: tuple[PlannedFailure, ...]
    unknown: tuple[str, ...]
    ended: str


class LaunchPlan(Event):
    """Answer to `plan_launch`."""

    type: Literal["launch_plan"] = "launch_plan"
    request: int
    plan: PlanView
