"""Joint positions from a topic, kept until the loop collects them."""

from __future__ import annotations

import threading
from collections import deque
from typing import TYPE_CHECKING, Final, Literal

from studio.live.topics.request import Request
from studio.live.topics.source import decoder
from studio.nodes.link_transforms import JointReading, LinkTransform
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from studio.live.topics.source import TopicSource
    from studio.robot.kinematics import Kinematics
    from studio.robot.values import Robot
    from studio.ros.node.samples import RawSample
    from studio.ros.types.classes import MessageValue


_STATE_TYPE: Final = "sensor_msgs/msg/JointState"
_TF_TYPE: Final = "tf2_msgs/msg/TFMessage"
_STATES: Final = Request(
    "/joint_states", (_STATE_TYPE,), depth=5, usually=(False, False), as_known_here=True
)
_TF: Final = Request("/tf", (_TF_TYPE,), latched=False, depth=100, as_known_here=True)
SILENT_AFTER_S: Final = 2.0
_STRANGERS_KEPT: Final = 12
_RATE_OVER_S: Final = 1.0
_ARRIVALS_KEPT: Final = 2000
"""A higher rate is reported as this one."""


class NewestPositions:
    """The newest position of each joint, so that a slow loop skips and does not lag.

    `take` may be called by any thread, all else by the loop. Several publishers may each publish
    some of the joints.
    """

    def __init__(self, clock: Callable[[], float], movable: Iterable[str]) -> None:
        self._clock = clock
        self._lock = threading.Lock()
        self._movable = frozenset(movable)
        self._newest: dict[str, float] = {}
        self._strangers: dict[str, None] = {}
        self._arrivals: deque[float] = deque(maxlen=_ARRIVALS_KEPT)
        self._last_s: float | None = None
        self._newest_stamp_ns = 0
        self.stamp_ns = 0
        """Stamp of the positions last collected, by their source's clock; 0: there was none."""

    def fit(self, movable: Iterable[str]) -> None:
        """Take the positions of other joints from now on."""
        with self._lock:
            self._movable = frozenset(movable)
            self._strangers.clear()

    def take(self, positions: Mapping[str, float], stamp_ns: int = 0) -> None:
        """Keep the positions of a message, rad or m by name of the joint, and its stamp."""
        now_s = self._clock()
        with self._lock:
            self._last_s, self._newest_stamp_ns = now_s, stamp_ns
            self._arrivals.append(now_s)
            for name, position in positions.items():
                if name in self._movable:
                    self._newest[name] = position
                elif len(self._strangers) < _STRANGERS_KEPT:
                    self._strangers[name] = None

    def collect(self) -> dict[str, float]:
        """Return what came since the last call."""
        with self._lock:
            taken, self._newest = self._newest, {}
            self.stamp_ns = self._newest_stamp_ns
        return taken

    def strangers(self) -> tuple[str, ...]:
        """Return the first joints that came and that the robot does not have."""
        with self._lock:
            return tuple(self._strangers)

    def state(self) -> Literal["waiting", "live", "silent"]:
        """Return whether anything came yet, and lately."""
        last_s = self._last_s
        if last_s is None:
            return "waiting"
        return "live" if self._clock() - last_s < SILENT_AFTER_S else "silent"

    def rate_hz(self) -> int:
        """Return how many messages came in the last second."""
        since_s = self._clock() - _RATE_OVER_S
        with self._lock:
            return sum(1 for at_s in self._arrivals if at_s > since_s)


class FollowedJoints:
    """Receives joint positions of a robot, from `/joint_states` or from `/tf`."""

    def __init__(
        self, source: TopicSource, robot: Robot, kinematics: Kinematics, *, from_tf: bool
    ) -> None:
        self._newest = NewestPositions(lambda: source.now_ns / NANOSECONDS, kinematics.movable)
        self._kinematics = kinematics
        self._reading = JointReading(robot, kinematics)
        self.collect, self.state = self._newest.collect, self._newest.state
        self.rate_hz, self.strangers = self._newest.rate_hz, self._newest.strangers
        self._decode = decoder(source, _TF_TYPE if from_tf else _STATE_TYPE)
        take = self._take_tf if from_tf else self._take_state
        self.close = source.subscribe(_TF if from_tf else _STATES, take=take).close

    def fit(self, robot: Robot, kinematics: Kinematics) -> None:
        """Go on with the robot as it is now."""
        if kinematics is not self._kinematics:
            if kinematics.movable != self._kinematics.movable:
                self._newest.fit(kinematics.movable)
            self._kinematics = kinematics
            self._reading = JointReading(robot, kinematics)

    @property
    def stamp_ns(self) -> int:
        """Stamp of the positions last collected, from their joint state; 0: it had none."""
        return self._newest.stamp_ns

    def _take_state(self, sample: RawSample) -> None:
        state = self._decode(sample)
        if len(state.name) == len(state.position):
            stamp = state.header.stamp
            positions = dict(zip(state.name, state.position.tolist(), strict=True))
            self._newest.take(positions, stamp.sec * NANOSECONDS + stamp.nanosec)

    def _take_tf(self, sample: RawSample) -> None:
        transforms = map(_link_transform, self._decode(sample).transforms)
        if positions := self._reading.positions(transforms):
            self._newest.take(positions)


def _link_transform(stamped: MessageValue) -> LinkTransform:
    at, turn = stamped.transform.translation, stamped.transform.rotation
    return LinkTransform(
        stamped.header.frame_id,
        stamped.child_frame_id,
        (at.x, at.y, at.z),
        (turn.w, turn.x, turn.y, turn.z),
    )
