"""Messages about the plan of a launch file: its arguments, and all that it would start."""

from __future__ import annotations

from typing import Annotated, Literal, TypeAlias

from pydantic import Field, StringConstraints

from studio.launch.plan import Plan
from studio.protocol.message import ArgumentName, Command, Event

_PATH_MAX = 4096
_ARGUMENTS_MAX = 200
FilePath: TypeAlias = Annotated[str, StringConstraints(min_length=1, max_length=_PATH_MAX)]
Word: TypeAlias = Annotated[str, StringConstraints(max_length=10_000)]
LaunchArguments: TypeAlias = Annotated[dict[ArgumentName, Word], Field(max_length=_ARGUMENTS_MAX)]


class PlanLaunch(Command):
    """Ask what a launch file would start; a later one of the same person ends this one."""

    type: Literal["plan_launch"] = "plan_launch"
    file: FilePath
    arguments: LaunchArguments = Field(default_factory=dict)


class CancelPlan(Command):
    """End the planning that the same person asked for."""

    type: Literal["cancel_plan"] = "cancel_plan"


class LaunchPlan(Event):
    """Answer to `plan_launch`."""

    type: Literal["launch_plan"] = "launch_plan"
    request: int
    plan: Plan
