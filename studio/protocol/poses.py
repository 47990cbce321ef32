"""Messages about named poses: their list, and what is done with them."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from studio.protocol.message import Command, Event, Message


class PoseView(Message):
    """One named pose as the page lists it."""

    key: str
    """What the commands call it."""
    name: str
    group: str
    """The planning group of an SRDF that it is stated for; empty: none."""
    kind: Literal["own", "srdf", "initial"]
    """Saved here, a group state of an SRDF, or a file of initial positions."""
    file: str
    line: int
    positions: dict[str, float]
    """By joint of the robot that moves freely, rad or m."""
    unknown: tuple[str, ...]
    """Joints that the robot does not have, or that take no single number; the first ones."""
    unknown_count: int
    beyond: tuple[str, ...]
    """Joints whose limits do not let them go so far; the first ones."""


class Poses(Event):
    """All named poses that fit the robot."""

    type: Literal["poses"] = "poses"
    poses: tuple[PoseView, ...]
    path: str
    """The file that one's own are kept in."""
    only_here: str
    """Why one's own are kept for this session only; empty: they are in the file."""
    trouble: str
    """What is wrong with that file, in a sentence."""


class ApplyPose(Command):
    """Move the joints to a named pose; joints that it does not name stay."""

    type: Literal["apply_pose"] = "apply_pose"
    key: str = Field(max_length=5000)
    duration_s: float = Field(default=0.0, ge=0.0, le=5.0)
    """Of the way there; 0: at once."""


class SavePose(Command):
    """Keep where the joints are under a name; with `replace` also under one that there is."""

    type: Literal["save_pose"] = "save_pose"
    name: str = Field(max_length=100)
    replace: bool = False


class RenamePose(Command):
    """Give one's own pose another name."""

    type: Literal["rename_pose"] = "rename_pose"
    name: str = Field(max_length=100)
    new_name: str = Field(max_length=100)


class DeletePose(Command):
    """Forget one's own pose; the joints stay where they are."""

    type: Literal["delete_pose"] = "delete_pose"
    name: str = Field(max_length=100)
