"""Time of a document's 3D view, as RViz's Time panel has it: its clocks, pause and reset."""

from __future__ import annotations

from typing import Literal

from studio.protocol.message import Command, Event


class GetSceneTime(Command):
    """Ask for the time now; /clock is subscribed for some seconds after."""

    type: Literal["get_scene_time"] = "get_scene_time"


class PauseScene(Command):
    """Pause drawing, or go on; messages are received meanwhile, and drawn when it goes on."""

    type: Literal["pause_scene"] = "pause_scene"
    paused: bool


class ResetScene(Command):
    """Forget all messages and transforms received, and begin to count the time anew.

    All is subscribed again, so that latched messages come once more.
    """

    type: Literal["reset_scene"] = "reset_scene"


class SceneTime(Event):
    """Answer to `get_scene_time`; all in seconds, with hundredths that mean something."""

    type: Literal["scene_time"] = "scene_time"
    request: int
    ros_s: float
    """Since the epoch, or of the simulation; it stands still while drawing is paused."""
    ros_elapsed_s: float
    wall_s: float
    """Since the epoch, by the clock of the studio's machine."""
    wall_elapsed_s: float
    from_clock: bool
    """Whether ROS time comes from /clock, as in a simulation; else it is the wall's."""
    paused: bool
