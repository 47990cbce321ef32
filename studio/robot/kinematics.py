"""Forward kinematics over arrays: joint positions in, link poses out.

Matrices are named `a_from_b`: they express points of frame b in frame a. A joint's own frame lies
at its origin in the parent link; moving the joint moves the child link in that frame.
"""

from __future__ import annotations

import math
from copy import copy
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

import numpy as np

from studio.robot.rotations import cross_matrices, matrix_from_rpy, unit_vectors, wxyz_from_matrices
from studio.robot.values import JointType

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from studio.robot.values import Joint, Robot

Floats: TypeAlias = "NDArray[np.float64]"

_TURNS = (JointType.REVOLUTE, JointType.CONTINUOUS)
_MOVES = (*_TURNS, JointType.PRISMATIC)
_UNLIMITED_SWING = {JointType.REVOLUTE: math.pi / 2, JointType.PRISMATIC: 0.1}
"""Half the range, rad or m, of a joint whose limits are missing or upside down."""
_SWING_PERIOD_S = 4.0


class Kinematics:
    """The kinematics of one robot; immutable: `refitted` makes that of a robot with other numbers.

    Positions are arrays of shape (..., J) in the order of `movable`: revolute, continuous and
    prismatic joints with the followers of mimic among them, in document order. Planar and floating
    joints stand still at their origin. A joint whose axis is zero does not move, as in ROS.
    """

    def __init__(self, robot: Robot) -> None:
        self._robot = robot
        self._turned: tuple[Floats, Floats] | None = None
        """The last rotations of links, and their quaternions."""
        self._stood: tuple[Floats, Floats] | None = None
        """The last positions, and the poses of links in their parents at them."""
        self.link_names = tuple(robot.links)
        joints = tuple(robot.joints.values())
        moving = [joint for joint in joints if joint.type in _MOVES]
        self.movable = tuple(joint.name for joint in moving)
        self.free = tuple(joint.name for joint in moving if joint.mimic is None)
        self._index = {name: index for index, name in enumerate(self.movable)}
        self._row = {joint.name: row for row, joint in enumerate(joints)}
        self._joints = {joint.name: joint for joint in moving}
        self.lower, self.upper = _limits(moving)
        self._lead_in(robot)
        self._motion = _Motion.of(joints)
        self._at = np.array([i for i, one in enumerate(joints) if one.type in _MOVES], np.intp)
        self._link_up(joints)

    def refitted(self, robot: Robot, changed: Iterable[str]) -> Kinematics:
        """Return the kinematics of `robot`, which has the same links and joints but for numbers.

        Args:
            robot: Its links, and its joints' types, parents, children and leaders, are as here.
            changed: Names of the joints whose origin, axis, limits or mimic differ.
        """
        joints = [robot.joints[name] for name in changed]
        made = copy(self)
        moving = [joint for joint in joints if joint.name in self._index]
        at = [self._index[joint.name] for joint in moving]
        made._joints = self._joints | {joint.name: joint for joint in moving}
        if any(_range(self._joints[joint.name]) != _range(joint) for joint in moving):
            made.lower, made.upper = self.lower.copy(), self.upper.copy()
            made.lower[at], made.upper[at] = _limits(moving)
        if any(joint.mimic for joint in joints):
            made._lead_in(robot)
        rows = [self._row[one.name] for one in joints]
        if all(_turns_as(self._robot.joints[one.name], one) for one in joints):
            made._motion = self._motion.shifted(rows, joints)
            made._stood = self._stood_shifted(rows, joints)
        else:
            made._motion = self._motion.with_rows(rows, joints)
            made._stood = None
        made._robot = robot
        return made

    def reaches_as(self, other: Kinematics) -> bool:
        """Whether it is one refitted from the other with the same limits and leaders."""
        return (
            self.lower is other.lower
            and self.upper is other.upper
            and self._multiplier is other._multiplier
        )

    def clamp(self, name: str, value: float) -> float:
        """Return the nearest position within the limits of a movable joint.

        Raises:
            KeyError: No movable joint has that name.
            ValueError: `value` is not finite.
        """
        if not math.isfinite(value):
            raise ValueError(f'Position {value} of joint "{name}" is not a finite number.')
        index = self._index[name]
        return float(min(max(value, self.lower[index]), self.upper[index]))

    def positions_with_mimic(self, positions: Mapping[str, float] | Floats) -> Floats:
        """Positions of all movable joints, (J,), followers computed from their leaders.

        Args:
            positions: By name (missing joints stand at zero, names of followers and unknown names
                are skipped), or an array (..., number of `free`) in the order of `free`.
        """
        if isinstance(positions, np.ndarray):
            free = positions
        else:
            free = np.array([positions.get(name, 0.0) for name in self.free], dtype=np.float64)
        leaders = np.concatenate((free, np.zeros((*free.shape[:-1], 1))), axis=-1)
        return leaders[..., self._leader] * self._multiplier + self._offset

    def world_from_links(self, positions: Floats) -> Floats:
        """Return the pose of every link, (..., L, 4, 4); roots stand at the identity."""
        return self._chain(self._parent_from_child(positions))[..., :-1, :, :]

    def wxyz_xyz(self, positions: Floats) -> Floats:
        """Return the pose of every link, (..., L, 7): unit quaternion with w >= 0, then metres."""
        world_from_links = self.world_from_links(positions)
        wxyz = self._wxyz(world_from_links[..., :3, :3])
        return np.concatenate((wxyz, world_from_links[..., :3, 3]), axis=-1)

    def wxyz_xyz_in_parents(self, positions: Floats) -> Floats:
        """Return links' poses in their parents, (..., L, 7), as `wxyz_xyz`; roots: identity."""
        parent_from_links = self._parent_from_child(positions)[..., :-1, :, :]
        wxyz = wxyz_from_matrices(parent_from_links[..., :3, :3])
        return np.concatenate((wxyz, parent_from_links[..., :3, 3]), axis=-1)

    @property
    def axes(self) -> Floats:
        """Unit axis of each movable joint in its own frame, (J, 3); zero where none is given."""
        return self._motion.axes[self._at]

    def axis_of(self, joint: str) -> tuple[float, float, float]:
        """Unit axis of a joint in its own frame; x for one that does not move."""
        index = self._index.get(joint)
        if index is None:
            return (1.0, 0.0, 0.0)
        x, y, z = self._motion.axes[self._at[index]].tolist()
        return (x, y, z)

    def zero_positions(self) -> Floats:
        """Zero for every movable joint, or the nearest position within its limits."""
        return self._followed(np.clip(0.0, self.lower, self.upper))

    def random_positions(self, rng: np.random.Generator) -> Floats:
        """Return positions within the limits of all joints; in a whole turn without limits."""
        middle, half = self._swing_range()
        return self._followed(middle + half * rng.uniform(-1.0, 1.0, len(self.movable)))

    def swing(self, t_s: float, start: Floats | None = None) -> Floats:
        """Positions at time `t_s` of an endless smooth swing that begins at `start` (or zero).

        A limited joint goes to and fro between its limits; a continuous one turns.
        """
        begin = self.zero_positions() if start is None else start
        middle, half = self._swing_range()
        omega = 2 * math.pi / _SWING_PERIOD_S
        reach = np.where(half > 0, half, 1.0)
        phase = np.arcsin(np.clip((begin - middle) / reach, -1.0, 1.0))
        to_and_fro = middle + half * np.sin(omega * t_s + phase)
        turned = (begin + omega * t_s + math.pi) % (2 * math.pi) - math.pi
        return self._followed(np.where(self._turns, turned, to_and_fro))

    def _followed(self, positions: Floats) -> Floats:
        free = positions[[self._index[name] for name in self.free]]
        return self.positions_with_mimic(free)

    def _swing_range(self) -> tuple[Floats, Floats]:
        """Middle and half of each joint's range, rad or m."""
        limited = np.isfinite(self.lower) & np.isfinite(self.upper)
        lower = np.where(limited, self.lower, -self._default_half)
        upper = np.where(limited, self.upper, self._default_half)
        return (lower + upper) / 2, (upper - lower) / 2

    def _wxyz(self, rotations: Floats) -> Floats:
        """Their quaternions; what an edit moves it seldom turns, so those made last may do."""
        turned = self._turned
        if turned is None or not np.array_equal(turned[0], rotations):
            turned = self._turned = rotations, wxyz_from_matrices(rotations)
        return turned[1]

    def _lead_in(self, robot: Robot) -> None:
        """Find for each movable joint the free joint that leads it: q = multiplier * lead + offset.

        A leader that cannot move counts as a free joint that stands at zero.
        """
        place = {name: index for index, name in enumerate(self.free)}
        found = [_leading(self._joints[name], robot.joints) for name in self.movable]
        self._leader = np.array(
            [place.get(name, len(place)) for name, _, _ in found], dtype=np.intp
        )
        self._multiplier = np.array([multiplier for _, multiplier, _ in found], dtype=np.float64)
        self._offset = np.array([offset for _, _, offset in found], dtype=np.float64)
        types = [self._joints[name].type for name in self.movable]
        self._turns = np.array([one is JointType.CONTINUOUS for one in types], dtype=np.bool_)
        self._default_half = np.array([_UNLIMITED_SWING.get(one, math.pi) for one in types])

    def _link_up(self, joints: tuple[Joint, ...]) -> None:
        """Index arrays of the tree; index L stands for the world, above all roots."""
        place = {name: index for index, name in enumerate(self.link_names)}
        world = len(place)
        self._child = np.array([place[one.child] for one in joints], dtype=np.intp)
        parent = np.full(world + 1, world, dtype=np.intp)
        parent[self._child] = [place[one.parent] for one in joints]
        self._jumps: list[NDArray[np.intp]] = []
        while np.any(parent != world):
            self._jumps.append(parent)
            if len(self._jumps) > world.bit_length():
                raise ValueError("The joints form a cycle.")
            parent = parent[parent]

    def _stood_shifted(
        self, rows: Sequence[int], joints: Sequence[Joint]
    ) -> tuple[Floats, Floats] | None:
        """Return the last poses with the origins of other joints in some rows; None: not known."""
        if self._stood is None or any(one.type is JointType.PRISMATIC for one in joints):
            return None
        positions, links = self._stood[0], self._stood[1].copy()
        if rows:
            links[self._child[rows], :3, 3] = [one.origin.xyz for one in joints]
        return positions, links

    def _parent_from_child(self, positions: Floats) -> Floats:
        """Return links' poses in their parents, (..., L + 1, 4, 4); roots and world: identity."""
        if positions.ndim > 1:
            return self._links_at(positions)
        stood = self._stood  # an edit leaves the joints where they stand
        if stood is None or not np.array_equal(stood[0], positions):
            stood = self._stood = positions.copy(), self._links_at(positions)
        return stood[1]

    def _links_at(self, positions: Floats) -> Floats:
        batch = positions.shape[:-1]
        motion, at = self._motion, self._at
        shape = motion.parent_from_joint.shape
        moved = np.broadcast_to(motion.parent_from_joint, (*batch, *shape)).copy()
        moved[..., at, :3, :3] += (
            np.sin(positions)[..., None, None] * motion.sine[at]
            + (1.0 - np.cos(positions))[..., None, None] * motion.versine[at]
        )
        translations = moved[..., :3, 3]  # a view: an index list and a number beside it mix axes
        translations[..., at, :] += positions[..., None] * motion.slide[at]
        links = np.empty((*batch, len(self.link_names) + 1, 4, 4))
        links[...] = np.eye(4)
        links[..., self._child, :, :] = moved
        return links

    def _chain(self, parent_from_child: Floats) -> Floats:
        """Multiply down the tree by doubling: log2(depth) products of all links at once."""
        world_from_links = parent_from_child
        for jump in self._jumps:
            world_from_links = world_from_links[..., jump, :, :] @ world_from_links
        return world_from_links


class _Motion(NamedTuple):
    """Each joint's motion as matrices: R(q) = A + sin(q) B + (1 - cos(q)) C, t(q) = t + q d."""

    parent_from_joint: Floats
    """Shape (N, 4, 4): the pose at zero, A and t."""
    axes: Floats
    """Shape (N, 3), of length 1; zero where none is given."""
    sine: Floats
    """Shape (N, 3, 3): B, zero for a joint that does not turn."""
    versine: Floats
    """Shape (N, 3, 3): C."""
    slide: Floats
    """Shape (N, 3): d, zero for a joint that turns."""

    @classmethod
    def of(cls, joints: Sequence[Joint]) -> _Motion:
        """Return the motions of all joints, in order."""
        origins = np.array([(*one.origin.xyz, *one.origin.rpy) for one in joints], np.float64)
        origins = origins.reshape(-1, 6)
        parent_from_joint = np.zeros((len(joints), 4, 4))
        parent_from_joint[:, :3, :3] = rotations = matrix_from_rpy(origins[:, 3:])
        parent_from_joint[:, :3, 3] = origins[:, :3]
        parent_from_joint[:, 3, 3] = 1.0
        axes = unit_vectors(np.array([one.axis for one in joints], np.float64).reshape(-1, 3))
        turns = np.array([one.type in _TURNS for one in joints], np.bool_)
        cross = cross_matrices(axes) * turns[:, None, None]
        sine = rotations @ cross
        slide = (rotations @ axes[:, :, None])[:, :, 0] * ~turns[:, None]
        return cls(parent_from_joint, axes, sine, sine @ cross, slide)

    def with_rows(self, rows: Sequence[int], joints: Sequence[Joint]) -> _Motion:
        """Return the same with other joints in some rows."""
        if not rows:
            return self
        new = _Motion.of(joints)
        copies = [array.copy() for array in self]
        for array, values in zip(copies, new, strict=True):
            array[rows] = values
        return _Motion(*copies)

    def shifted(self, rows: Sequence[int], joints: Sequence[Joint]) -> _Motion:
        """Return the same with the origins of other joints in some rows, turned as those before."""
        if not rows:
            return self
        parent_from_joint = self.parent_from_joint.copy()
        parent_from_joint[rows, :3, 3] = [joint.origin.xyz for joint in joints]
        return self._replace(parent_from_joint=parent_from_joint)


def floating_motion(xyz_m: Floats, wxyz: Floats) -> Floats:
    """Motion (4, 4) of a floating joint; the quaternion need not be normalised, but not zero."""
    w, x, y, z = wxyz / np.linalg.norm(wxyz)
    motion = np.eye(4)
    motion[:3, :3] = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    motion[:3, 3] = xyz_m
    return motion


def _turns_as(one: Joint, other: Joint) -> bool:
    """Whether two joints differ in no more than where they are and how far they go."""
    return one.origin.rpy == other.origin.rpy and one.axis == other.axis


def _limits(joints: list[Joint]) -> tuple[Floats, Floats]:
    """Least and greatest position; infinite where nothing limits the joint."""
    pairs = [_range(joint) for joint in joints]
    lower, upper = np.array(pairs, dtype=np.float64).reshape(-1, 2).T
    return lower, upper


def _range(joint: Joint) -> tuple[float, float]:
    limit = joint.limit
    if joint.type is JointType.CONTINUOUS or limit is None or limit.lower > limit.upper:
        return -math.inf, math.inf
    return limit.bounds


def _leading(joint: Joint, joints: Mapping[str, Joint]) -> tuple[str, float, float]:
    """Return the free joint that a chain of mimics follows, with one multiplier and offset."""
    multiplier, offset = 1.0, 0.0
    for _ in range(len(joints)):
        mimic = joint.mimic
        if mimic is None:
            return joint.name, multiplier, offset
        offset += multiplier * mimic.offset
        multiplier *= mimic.multiplier
        if mimic.joint not in joints:
            return mimic.joint, multiplier, offset
        joint = joints[mimic.joint]
    raise ValueError(f'Joint "{joint.name}" mimics itself in a round.')
