"""The states that a robot goes through on a trajectory: when, and where its links are then."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from studio.displays.turning import unit_quaternions
from studio.errors import DisplayMessageError
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from numpy.typing import NDArray

    from studio.displays.posed_robot import PosedRobot
    from studio.displays.turning import Floats

STATES_MAX: Final = 10_000
"""Of a longer trajectory as many states are kept, spread evenly."""
_POSITIONS_MAX: Final = 10_000_000
"""Of all joints in all states of a plan: a joint that one part names has a row in each."""


class Motion(NamedTuple):
    """What a message tells of joints.

    Attributes:
        names: J names of joints.
        times_s: Shape (S,): when each state is reached, from the start; ascending.
        positions: Shape (S, J), rad or m; NaN: as it was.
        start: Positions of other joints, by name.
        frame: Frame that `roots` are in; empty: the root link stays where it is.
        roots: Shape (S, 7): pose of the root link, w, x, y, z and m.
        model: Name of the robot that it was planned for; empty: it is not said.
    """

    names: tuple[str, ...]
    times_s: Floats
    positions: Floats
    start: Mapping[str, float]
    frame: str = ""
    roots: Floats | None = None
    model: str = ""

    @property
    def size(self) -> int:
        """Number of states."""
        return len(self.times_s)


def motion_of(message: Any, kind: str) -> Motion:  # noqa: ANN401 - trajectory_msgs/JointTrajectory
    """Read one trajectory of joints.

    Raises:
        DisplayMessageError: A point has another number of positions than there are joints, or
            one that is no finite number.
    """
    names = tuple(map(str, message.joint_names))
    rows: list[NDArray[np.float64]] = []
    for at, each in enumerate(message.points):
        if len(each.positions) != len(names):
            reason = f"point {at} has {len(each.positions)} positions for {len(names)} joints"
            raise DisplayMessageError(kind, reason)
        rows.append(np.asarray(each.positions, np.float64))
    positions = np.array(rows, np.float64).reshape(len(rows), len(names))
    if not np.isfinite(positions).all():
        raise DisplayMessageError(kind, "a position is NaN or infinite")
    return Motion(names, _times_s(message.points), positions, {})


def chain_of(message: Any, kind: str) -> Motion:  # noqa: ANN401 - moveit_msgs/DisplayTrajectory
    """Read trajectories that follow each other, and the state that they begin in.

    Raises:
        DisplayMessageError: One of them makes no sense.
    """
    state = message.trajectory_start.joint_state
    start = {
        str(name): float(value)
        for name, value in zip(state.name, state.position, strict=False)
        if np.isfinite(value)
    }
    parts = [motion_of(one.joint_trajectory, kind) for one in message.trajectory]
    bases = [one.multi_dof_joint_trajectory for one in message.trajectory]
    names = tuple(dict.fromkeys(name for one in parts for name in one.names))
    times_s = _joined([part.times_s for part in parts])
    if len(times_s) * len(names) > _POSITIONS_MAX:
        reason = f"{len(times_s):,} states of {len(names):,} joints are more than can be shown"
        raise DisplayMessageError(kind, reason)
    column = {name: at for at, name in enumerate(names)}
    positions = np.full((len(times_s), len(names)), np.nan)
    begin = 0
    for part in parts:
        columns = [column[name] for name in part.names]
        positions[begin : begin + part.size, columns] = part.positions
        begin += part.size
    motion = Motion(names, times_s, positions, start, model=str(message.model_id))
    return _with_roots(motion, bases, kind)


def _joined(parts_s: Sequence[Floats]) -> Floats:
    """Return the times of parts that follow each other: each begins when the one before ends."""
    joined, end_s = [np.empty(0)], 0.0
    for times_s in parts_s:
        if len(times_s):
            joined.append(times_s + end_s)
            end_s = float(joined[-1][-1])
    return np.concatenate(joined)


def _with_roots(motion: Motion, bases: Sequence[Any], kind: str) -> Motion:
    """Add the poses of a joint of six degrees by which the whole robot moves, if there is one."""
    moving = [one for one in bases if len(one.joint_names) and len(one.points)]
    if not moving:
        return motion
    frame = str(moving[0].header.frame_id)
    placed = [[each for each in one.points if each.transforms] for one in moving]
    roots = np.array([_root(each) for one in placed for each in one]).reshape(-1, 7)
    if not np.isfinite(roots).all():
        raise DisplayMessageError(kind, "a pose of the robot is NaN or infinite")
    roots[:, :4], no_turn = unit_quaternions(roots[:, :4])
    if no_turn.any():
        raise DisplayMessageError(kind, "a pose of the robot has a quaternion of length 0")
    if motion.size == len(roots):
        return motion._replace(frame=frame, roots=roots)
    if motion.size:
        return motion
    return motion._replace(
        times_s=_joined([_times_s(one) for one in placed]),
        positions=np.full((len(roots), len(motion.names)), np.nan),
        frame=frame,
        roots=roots,
    )


def _root(point: Any) -> tuple[float, ...]:  # noqa: ANN401
    move, turn = point.transforms[0].translation, point.transforms[0].rotation
    return turn.w, turn.x, turn.y, turn.z, move.x, move.y, move.z


def _times_s(points: Sequence[Any]) -> Floats:
    """Return when each point is reached, s; one that is said to come before another comes at it."""
    times = [
        each.time_from_start.sec + each.time_from_start.nanosec / NANOSECONDS for each in points
    ]
    return np.maximum.accumulate(np.array(times, np.float64)) if times else np.empty(0)


def thinned(motion: Motion, most: int = STATES_MAX) -> Motion:
    """Return the states that are kept: the first and the last are always among them."""
    if motion.size <= most:
        return motion
    rows = np.unique(np.linspace(0, motion.size - 1, most).round().astype(np.intp))
    roots = None if motion.roots is None else motion.roots[rows]
    return motion._replace(
        times_s=motion.times_s[rows], positions=motion.positions[rows], roots=roots
    )


class States:
    """Where the links of a robot are in each state; made again with another robot."""

    def __init__(self, motion: Motion, robot: PosedRobot) -> None:
        self._motion, self._kinematics = motion, robot.kinematics
        free = robot.kinematics.free
        index = {name: at for at, name in enumerate(free)}
        now = robot.joints.by_name() | dict(motion.start)
        rest = np.array([now.get(name, 0.0) for name in free], np.float64)
        self._free = np.tile(rest, (motion.size, 1))
        known = [(at, index[name]) for at, name in enumerate(motion.names) if name in index]
        for at, column in known:
            told = _held(motion.positions[:, at], float(rest[column]))
            self._free[:, column] = told
        movable = frozenset(robot.kinematics.movable)
        self.unknown = tuple(name for name in motion.names if name not in movable)
        """Joints that the robot does not have."""

    @property
    def links(self) -> tuple[str, ...]:
        """The names of all links."""
        return self._kinematics.link_names

    def poses_at(self, state: float) -> Floats:
        """Return the poses of the links, (L, 7), in the root frame, also between two states."""
        low = min(int(state), self._motion.size - 1)
        high, share = min(low + 1, self._motion.size - 1), state - low
        free = self._free[low] + share * (self._free[high] - self._free[low])
        return self._kinematics.wxyz_xyz(self._kinematics.positions_with_mimic(free))

    def poses_of(self, states: Sequence[int]) -> Floats:
        """Return the poses of the links in some states, (S, L, 7)."""
        free = self._free[list(states)]
        return self._kinematics.wxyz_xyz(self._kinematics.positions_with_mimic(free))


def _held(values: Floats, first: float) -> Floats:
    """Return the values, NaN replaced by the one before."""
    known = np.isfinite(values)
    rows = np.maximum.accumulate(np.where(known, np.arange(len(values)), -1))
    return np.where(rows >= 0, values[rows], first)
