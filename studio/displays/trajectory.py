"""JointTrajectory and DisplayTrajectory: a ghost of the document's robot that moves as planned."""

from __future__ import annotations

import math
import re
from abc import abstractmethod
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from studio.displays.display import Display, Status, TopicRole, reading_fields
from studio.displays.drawing import NOTHING, LinkParts, Placed
from studio.displays.properties import Property, rgb_of, switch
from studio.displays.trajectory_states import States, chain_of, motion_of, thinned
from studio.robot.values import Robot
from studio.tf.rotations import compose

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.displays.display import Received
    from studio.displays.drawing import Drawing, Pose
    from studio.displays.posed_robot import PosedRobot
    from studio.displays.properties import Value
    from studio.displays.trajectory_states import Motion
    from studio.displays.turning import Floats
    from studio.ros.types.library import TypeLibrary
    from studio.tf.rotations import Pose as Row

_SPEED: Final = re.compile(r"\s*(\d{1,6}(?:\.\d{1,6})?)\s*([xs])\s*")
_REALTIME: Final = "REALTIME"
_TIME: Final = "State Display Time"
_FIRST_SPEED: Final = 3.0, "x"
GROUPS_MAX: Final = 4_000
"""Links of all ghosts of a trail together."""
_NAMES_MAX: Final = 3
_LOOKS: Final = ("Show Robot Visual", "Show Robot Collision", "Robot Alpha", "Robot Color",
                 "Color Enabled")  # fmt: skip
_TRAIL: Final = ("Show Trail", "Trail Step Size")


def speed_of(text: str) -> tuple[float, str] | None:
    """Return a number and its unit: x, times as fast as planned; s, seconds for each state.

    Returns:
        None when it is no speed; then MoveIt's first value holds.
    """
    if text.strip().upper() == _REALTIME:
        return 1.0, "x"
    found = _SPEED.fullmatch(text)
    if found is None or not float(found[1]):
        return None
    return float(found[1]), found[2]


TRAJECTORY_PROPERTIES: Final = (
    switch("Show Robot Visual", "Shows the visuals of the robot that moves.", on=True),
    switch("Show Robot Collision", "Shows its collision shapes.", on=False),
    Property("Robot Alpha", "number", 0.5, "How opaque it is: 0 is not seen.", 0.0, 1.0),
    Property(
        _TIME, "text", "3x",
        "How fast it moves: times as fast as planned, as 3x; or seconds for each state, as 0.1s.",
        choices=("3x", "1x", "0.5x", "0.05s", "0.1s", "0.5s", _REALTIME),
    ),
    switch("Loop Animation", "Begins again after the last state.", on=False),
    switch("Show Trail", "Shows the states that were passed, too.", on=False),
    Property(
        "Trail Step Size", "whole", 1, "Shows every how many-th state.", low=1, high=10_000,
        when=("Show Trail", (True,)),
    ),
    switch(
        "Interrupt Display", "Shows a new trajectory at once, and not after the one that is shown.",
        on=False,
    ),
    Property("Robot Color", "colour", "#963296", "Colour of the robot that moves.",
             when=("Color Enabled", (True,))),
    switch("Color Enabled", "Gives it one colour.", on=False),
    switch("Pause", "Holds it at the place on its way that is set.", on=False),
    Property(
        "Pause/Place", "number", 0.0, "Where it stands on its way: 0 at the start, 1 at the end.",
        low=0.0, high=1.0, when=("Pause", (True,)),
    ),
)  # fmt: skip


class TrajectoryDisplay(Display):
    """Draws the robot in one state after another; derived classes read the messages."""

    ICON: ClassVar[str] = "ghost"
    PROPERTIES: ClassVar[tuple[Property, ...]] = TRAJECTORY_PROPERTIES

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self._robot: PosedRobot | None = None
        self._of: Robot = Robot("")
        self._parts: dict[str, LinkParts] = {}
        self._forget()

    def _forget(self) -> None:
        self._motion: Motion | None = None
        self._next: Motion | None = None
        self._states: States | None = None
        self._began_ns: int | None = None
        self._place = 0.0
        self._trail: dict[int, dict[str, Placed]] = {}
        """By state, the robot there."""
        self._passed: tuple[int, dict[str, Placed]] = (0, {})
        """How many robots of the trail were passed, and all of their links."""
        self._drawing: Drawing = NOTHING
        self._drawn_at: float | None = None
        self._left_out = 0

    @abstractmethod
    def read(self, message: Any, kind: str) -> Motion:  # noqa: ANN401 - of the topic's type
        """Return the motion of a message.

        Raises:
            DisplayMessageError: It makes no sense.
        """

    def stand(self, robot: PosedRobot) -> None:
        """Take the robot that moves; another one moves from now on."""
        self._robot = robot
        if robot.robot is not self._of:
            self._of = robot.robot
            self._refit()

    def take(self, received: Received, role: str = "") -> None:
        """Take a trajectory; it is shown after the one that is on its way, or at once.

        Raises:
            StudioError: It cannot be read, or makes no sense.
        """
        del role
        message = self.decode(received)
        with reading_fields(received.type_name):
            motion = thinned(self.read(message, received.type_name.rpartition("/")[2]))
        if self._motion is None or self.values["Interrupt Display"] or self._is_over():
            self._begin(motion)
        else:
            self._next = motion

    def reset(self) -> None:
        """Forget all trajectories."""
        self._forget()
        super().reset()

    def changed(self, name: str) -> None:
        """Take new settings."""
        if name in _LOOKS or not name:
            self._parts.clear()
        if name in (*_LOOKS, *_TRAIL) or not name:
            self._lay_trail()
        self._drawn_at = None

    def draw(self, now_ns: int) -> Drawing:
        """Return the robot in the state of now, and those before it if a trail is shown."""
        self._advance(now_ns)
        motion, states = self._motion, self._states
        if motion is None or states is None or not motion.size or not self._of.links:
            return NOTHING
        state = self._state()
        if self._drawn_at != state:
            self._drawn_at = state
            ghost = self._ghost("ghost", states.poses_at(state), state)
            self._drawing = {**self._trail_until(state), **ghost}
        return self._drawing

    def statuses(self) -> tuple[Status, ...]:
        """Return why nothing moves, or not all of it."""
        if self._motion is None:
            return ()
        if not self._of.links:
            return (Status("error", "empty", "There is no robot that could move: open one."),)
        found = [
            self._empty(),
            self._odd_speed(),
            self._unknown(),
            self._transparent(),
            self._thinned(),
        ]
        return tuple(one for one in found if one is not None)

    def _begin(self, motion: Motion) -> None:
        self._motion, self._next, self._began_ns, self._place = motion, None, None, 0.0
        self._refit()

    def _refit(self) -> None:
        """Work out the states for the robot as it is."""
        self._parts.clear()
        self._states = None
        if self._motion is not None and self._robot is not None and self._of.links:
            self._states = States(self._motion, self._robot)
        self._lay_trail()
        self._drawn_at = None

    def _speed(self) -> tuple[float, str]:
        return speed_of(str(self.values[_TIME])) or _FIRST_SPEED

    def _is_over(self) -> bool:
        """Whether the robot stands at the end of its way, or has none."""
        return self._motion is None or self._place >= max(self._motion.size - 1, 0)

    def _advance(self, now_ns: int) -> None:
        """Move on to the state of now; the next trajectory begins when this is over."""
        motion = self._motion
        if motion is None or self.values["Pause"]:
            self._began_ns = None
            return
        if self._began_ns is None or now_ns < self._began_ns:
            self._began_ns = now_ns - round(1e9 * self._elapsed_s(self._place))
        self._place = self._place_after((now_ns - self._began_ns) / 1e9)
        if not self._is_over():
            return
        if self._next is not None:
            self._begin(self._next)
            self._began_ns = now_ns
        elif self.values["Loop Animation"] and motion.size > 1:
            self._place, self._began_ns = 0.0, now_ns

    def _state(self) -> float:
        if self._motion is not None and self.values["Pause"]:
            return float(self.values["Pause/Place"]) * max(self._motion.size - 1, 0)
        return self._place

    def _place_after(self, elapsed_s: float) -> float:
        """Return the state that is reached after so long, also between two."""
        motion = self._motion
        if motion is None or motion.size == 0:
            return 0.0
        number, unit = self._speed()
        last = motion.size - 1
        if unit == "s":
            return float(min(math.floor(elapsed_s / number + 1e-9), last))
        times_s = motion.times_s - motion.times_s[0]
        planned_s = elapsed_s * number
        if planned_s >= times_s[-1]:
            return float(last)
        low = int(np.searchsorted(times_s, planned_s, side="right")) - 1
        span_s = float(times_s[low + 1] - times_s[low])
        return low + (planned_s - float(times_s[low])) / span_s

    def _elapsed_s(self, place: float) -> float:
        """Return after how long a state is reached."""
        motion = self._motion
        if motion is None or motion.size == 0:
            return 0.0
        number, unit = self._speed()
        if unit == "s":
            return place * number
        times_s = motion.times_s - motion.times_s[0]
        low = min(int(place), motion.size - 1)
        high = min(low + 1, motion.size - 1)
        reached_s = times_s[low] + (place - low) * (times_s[high] - times_s[low])
        return float(reached_s) / number

    def _ghost(self, path: str, poses: Floats, state: float) -> dict[str, Placed]:
        """Return one robot, its links at poses (L, 7) in the root frame."""
        motion = self._motion
        root, frame = None, self._of.root
        if motion is not None and motion.roots is not None and motion.frame:
            w, x, y, z, px, py, pz = motion.roots[min(round(state), motion.size - 1)].tolist()
            root, frame = (w, x, y, z, px, py, pz), motion.frame
        made: dict[str, Placed] = {}
        links = self._states.links if self._states is not None else ()
        for link, pose in zip(links, poses.tolist(), strict=True):
            parts = self._part(link)
            if parts is not None:
                offset = _offset(root, pose)
                made[f"{path}/{link}"] = Placed(
                    frame, 0, {"link": parts}, follows=True, offset=offset
                )
        return made

    def _part(self, link: str) -> LinkParts | None:
        """Return the shapes of a link, the same object as long as its looks do not change."""
        found = self._parts.get(link)
        made = self._of.links.get(link)
        opacity = float(self.values["Robot Alpha"])
        if found is None and made is not None and opacity > 0.0:
            visual = bool(self.values["Show Robot Visual"]) and bool(made.visuals)
            collision = bool(self.values["Show Robot Collision"]) and bool(made.collisions)
            if not (visual or collision):
                return None
            rgb = rgb_of(self.values["Robot Color"]) if self.values["Color Enabled"] else None
            found = LinkParts(made, self._of, visual, collision, opacity=opacity, rgb=rgb)
            self._parts[link] = found
        return found

    def _lay_trail(self) -> None:
        """Place the robots of a trail; those that were passed are drawn."""
        self._trail, self._passed, self._left_out = {}, (0, {}), 0
        motion, states = self._motion, self._states
        if motion is None or states is None or not self.values["Show Trail"] or not motion.size:
            return
        rows = list(range(0, motion.size, int(self.values["Trail Step Size"])))
        if rows[-1] != motion.size - 1:
            rows.append(motion.size - 1)
        drawn = max(1, sum(self._part(link) is not None for link in states.links))
        most = max(2, GROUPS_MAX // drawn)
        if len(rows) > most:
            self._left_out = len(rows) - most
            kept: list[int] = np.linspace(0, len(rows) - 1, most).round().astype(int).tolist()
            rows = [rows[at] for at in kept]
        for row, poses in zip(rows, states.poses_of(rows), strict=True):
            self._trail[row] = self._ghost(str(row), poses, row)

    def _trail_until(self, state: float) -> dict[str, Placed]:
        """Return the robots of the trail that were passed; the same object until it is one more."""
        rows = [row for row in self._trail if row <= state]
        if self._passed[0] != len(rows):
            links = {path: one for row in rows for path, one in self._trail[row].items()}
            self._passed = len(rows), links
        return self._passed[1]

    def _empty(self) -> Status | None:
        if self._motion is None or self._motion.size:
            return None
        return Status("warn", "empty", "The trajectory has no point.")

    def _odd_speed(self) -> Status | None:
        text = str(self.values[_TIME])
        if speed_of(text) is not None:
            return None
        sentence = f'"{text[:60]}" is no speed, as 3x, 0.5x, 0.05s or REALTIME are: it goes at 3x.'
        return Status("warn", None, sentence, (_TIME, "3x"))

    def _unknown(self) -> Status | None:
        unknown = self._states.unknown if self._states is not None else ()
        if not unknown:
            return None
        names = ", ".join(name[:60] for name in unknown[:_NAMES_MAX])
        more = f" and {len(unknown) - _NAMES_MAX} more" if len(unknown) > _NAMES_MAX else ""
        sentence = f"The robot has no joint {names}{more}: what is planned for it is not shown."
        return Status("warn", "unknown_joint", sentence)

    def _transparent(self) -> Status | None:
        if not self.values["Robot Alpha"]:
            sentence = "Robot Alpha is 0, so nothing of the robot is seen."
            return Status("warn", "transparent", sentence, ("Robot Alpha", 0.5))
        if not self.values["Show Robot Visual"] and not self.values["Show Robot Collision"]:
            sentence = "Neither visuals nor collision shapes of the robot are switched on."
            return Status("warn", "empty", sentence, ("Show Robot Visual", True))
        return None

    def _thinned(self) -> Status | None:
        if not self._left_out:
            return None
        sentence = f"{self._left_out:,} robots of the trail are left out: there are too many links."
        return Status("ok", "thinned", sentence)


class JointTrajectoryDisplay(TrajectoryDisplay):
    """Joints that the message does not name stay where the robot has them."""

    KIND: ClassVar[str] = "JointTrajectory"
    DOC: ClassVar[str] = "A ghost of the robot that moves as a trajectory of joints has it."
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("trajectory_msgs/msg/JointTrajectory",)),
    )

    def read(self, message: Any, kind: str) -> Motion:  # noqa: ANN401 - as the base has it
        """Return the motion of a message."""
        return motion_of(message, kind)


class DisplayTrajectoryDisplay(TrajectoryDisplay):
    """Joints that the trajectories do not name are as in the state that they begin in."""

    KIND: ClassVar[str] = "DisplayTrajectory"
    DOC: ClassVar[str] = "A ghost of the robot that moves as MoveIt planned."
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("moveit_msgs/msg/DisplayTrajectory",)),
    )

    def read(self, message: Any, kind: str) -> Motion:  # noqa: ANN401 - as the base has it
        """Return the motions of a message, one after the other."""
        return chain_of(message, kind)

    def statuses(self) -> tuple[Status, ...]:
        """Return whose plan it is, too, if it is another robot's."""
        found = super().statuses()
        model = "" if self._motion is None else self._motion.model
        if model in ("", self._of.name) or not self._of.links:
            return found
        plan, own = model[:60], self._of.name[:60]
        sentence = f'The plan is for "{plan}", and this robot is "{own}".'
        return (Status("warn", "other_robot", sentence), *found)


def _offset(root: Row | None, pose: list[float]) -> Pose:
    w, x, y, z, px, py, pz = pose
    made = (w, x, y, z, px, py, pz) if root is None else compose(root, (w, x, y, z, px, py, pz))
    return made[:4], made[4:]
