"""One interactive marker as values: its controls with their shapes, its menu, and where it is."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final, NamedTuple, TypeAlias

import numpy as np

from studio.displays.display import stamp_ns_of
from studio.displays.drawing import NO_TURN, ORIGIN
from studio.displays.markers.batches import shapes_of
from studio.displays.markers.kinds import NOT_DRAWN, SENTENCES, Problem
from studio.displays.markers.store import MarkerStore
from studio.displays.selection import wxyz_of
from studio.displays.turning import FAR, unit_quaternions
from studio.errors import DisplayMessageError, FrameError
from studio.ros.cdr import codec_of
from studio.ros.columns.markers import MarkerCodec
from studio.ros.interactive_markers.names import OrientationMode
from studio.ros.interactive_markers.tools import make_title
from studio.tf.rotations import compose, inverse

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from studio.displays.drawing import Pose, Shape
    from studio.ros.types.classes import MessageValue
    from studio.ros.types.library import TypeLibrary

NAME_MAX: Final = 1000
"""Letters of a name that is sent back in feedback as it is; a longer one is refused."""
TEXT_MAX: Final = 300
"""Letters of a description or of an entry of a menu that are shown."""
ENTRIES_MAX: Final = 500
_MARKER_ARRAY: Final = "visualization_msgs/msg/MarkerArray"
_OWN: Final = "-"
"""Stands for the axes of the control in the header of its markers."""

SeenFrom: TypeAlias = "Callable[[str, str, int], Pose]"
"""Returns the pose of the second frame in the first one at a stamp, ns; raises a FrameError."""


class MenuItem(NamedTuple):
    """An entry of a menu; `parent` 0: it is in no submenu."""

    id: int
    parent: int
    title: str
    command_type: int
    command: str


@dataclass(frozen=True, slots=True, eq=False)
class ControlModel:
    """One control.

    Attributes:
        name: Unique within its marker.
        description: For the user; may be empty.
        mode: A `Mode`.
        facing: An `OrientationMode`.
        wxyz: Orientation of the control; it acts along and about its x.
        independent: Whether the shapes of a control that faces the eye turn with the marker.
        always_visible: Whether it is seen while no interaction is wanted.
        shapes: In the axes of the control, by name.
    """

    name: str
    description: str
    mode: int
    facing: int
    wxyz: tuple[float, float, float, float]
    independent: bool
    always_visible: bool
    shapes: Mapping[str, Shape]


@dataclass(frozen=True, slots=True, eq=False)
class MarkerModel:
    """An interactive marker.

    Attributes:
        name: As the server knows it.
        description: For the user; may be empty.
        frame: Its reference frame.
        stamp_ns: Of its pose; 0: it moves with its frame.
        pose: In the reference frame.
        scale: Size of its handles, m.
        controls: Those that can be shown.
        title: What shows its description.
        menu: Its entries, parents first.
        problems: What is wrong with parts of it, in sentences.
    """

    name: str
    description: str
    frame: str
    stamp_ns: int
    pose: Pose
    scale: float
    controls: tuple[ControlModel, ...]
    title: Mapping[str, Shape]
    menu: tuple[MenuItem, ...]
    problems: tuple[str, ...] = ()

    def at(self, pose: Pose) -> MarkerModel:
        """Return the same elsewhere."""
        return replace(self, pose=pose)


def read_marker(message: MessageValue, types: TypeLibrary, seen_from: SeenFrom) -> MarkerModel:
    """Read a completed InteractiveMarker; it takes a while, and may be done in any thread.

    Args:
        message: As the client hands it on; it is changed.
        types: Of which it is.
        seen_from: For markers of a control that are in another frame.

    Raises:
        DisplayMessageError: Nothing of it can be shown.
    """
    name = message.name
    if len(name) > NAME_MAX:
        raise _refused(name, f"its name has {len(name):,} letters, and {NAME_MAX:,} are the most")
    if not message.header.frame_id:
        raise _refused(name, "it names no frame in its header")
    pose = pose_of(message.pose, f'interactive marker "{shown_name(name)}"')
    if not 0 <= message.scale <= FAR:
        raise _refused(name, f"its scale is {message.scale}")
    controls = [one for one in message.controls if len(one.name) <= NAME_MAX]
    reading = _Reading(message, types, seen_from, pose)
    shapes = reading.shapes_by_control(controls)
    models = (_control(one, of_one) for one, of_one in zip(controls, shapes, strict=True))
    read = tuple(one for one in models if one is not None)
    if len(read) < len(message.controls):
        reading.problems.append("Some of its controls have names or turns that make no sense.")
    return MarkerModel(
        name=name,
        description=message.description[:TEXT_MAX],
        frame=message.header.frame_id.removeprefix("/"),
        stamp_ns=stamp_ns_of(message.header),
        pose=pose,
        scale=float(message.scale),
        controls=read,
        title=_title(message, types),
        menu=tuple(_menu(message.menu_entries[:ENTRIES_MAX])),
        problems=tuple(reading.problems),
    )


def pose_of(pose: MessageValue, what: str) -> Pose:
    """Return a geometry_msgs/Pose with a turn of length 1.

    Raises:
        DisplayMessageError: Its numbers are not finite, or too large to be drawn.
    """
    place, turn = pose.position, pose.orientation
    xyz = (place.x, place.y, place.z)
    wxyz = unit_turn((turn.w, turn.x, turn.y, turn.z))
    if wxyz is None or not all(abs(one) <= FAR for one in xyz):
        raise DisplayMessageError(what, "its pose has numbers that are not finite or too large")
    return wxyz, xyz


def unit_turn(
    wxyz: tuple[float, float, float, float],
) -> tuple[float, float, float, float] | None:
    """Return a quaternion at length 1, no turn for one of zeros; None: it is not finite."""
    if not all(abs(one) <= FAR for one in wxyz):
        return None
    return wxyz_of(unit_quaternions(np.array([wxyz]))[0][0])


def shown_name(name: str) -> str:
    """Return a name as sentences have it."""
    return name if len(name) <= 60 else f"{name[:60]}…"


def _refused(name: str, reason: str) -> DisplayMessageError:
    return DisplayMessageError(f'interactive marker "{shown_name(name)}"', reason)


def _control(control: MessageValue, shapes: Mapping[str, Shape]) -> ControlModel | None:
    turn = control.orientation
    wxyz = unit_turn((turn.w, turn.x, turn.y, turn.z))
    if wxyz is None:
        return None
    known = {int(one) for one in OrientationMode}
    facing = control.orientation_mode if control.orientation_mode in known else 0
    return ControlModel(
        name=control.name,
        description=control.description[:TEXT_MAX],
        mode=control.interaction_mode,
        facing=facing,
        wxyz=wxyz,
        independent=control.independent_marker_orientation,
        always_visible=control.always_visible,
        shapes=shapes,
    )


def _menu(entries: Iterable[MessageValue]) -> Iterator[MenuItem]:
    """Yield the entries of a menu; one before its parent, or of an id again, is left out."""
    seen = {0}
    for one in entries:
        if one.id not in seen and one.parent_id in seen:
            seen.add(one.id)
            command = one.command[:TEXT_MAX]
            yield MenuItem(one.id, one.parent_id, one.title[:TEXT_MAX], one.command_type, command)


def _title(message: MessageValue, types: TypeLibrary) -> Mapping[str, Shape]:
    if not message.description.strip():
        return {}
    reading = _Reading(message, types, _nowhere, (NO_TURN, ORIGIN))
    return reading.shapes_by_control([make_title(message, types)])[0]


def _nowhere(target: str, frame: str, stamp_ns: int) -> Pose:
    del target, frame, stamp_ns
    return NO_TURN, ORIGIN


class _Reading:
    """Reads the markers of all controls of an interactive marker at once."""

    def __init__(
        self, message: MessageValue, types: TypeLibrary, seen_from: SeenFrom, pose: Pose
    ) -> None:
        self.problems: list[str] = []
        self._message, self._types, self._seen_from = message, types, seen_from
        self._pose = pose
        self._faults: dict[str, None] = {}

    def shapes_by_control(self, controls: Sequence[MessageValue]) -> list[Mapping[str, Shape]]:
        """Return the shapes of each control, by name."""
        array = self._types.message(_MARKER_ARRAY)()
        for number, control in enumerate(controls):
            for at, marker in enumerate(control.markers):
                if self._put_in_axes(control, marker):
                    marker.ns, marker.id, marker.action = str(number), at, 0
                    marker.lifetime.sec = marker.lifetime.nanosec = 0
                    array.markers.append(marker)
        store = MarkerStore()
        store.take(MarkerCodec().decode(bytes(codec_of(type(array)).encode(array))), 0)
        self._say_problems(store)
        return _parted(store, len(controls))

    def _put_in_axes(self, control: MessageValue, marker: MessageValue) -> bool:
        """Express a marker in the axes of its control; False: it is not known where that is.

        Most name no frame and are there already. Others are anchored where they are now, and go
        with the control from then on.
        """
        header = marker.header
        frame, header.frame_id = header.frame_id.removeprefix("/"), _OWN
        if not frame:
            return True
        own = self._message.header.frame_id.removeprefix("/")
        stamp_ns = stamp_ns_of(header)
        try:
            reference_from_frame = (
                (NO_TURN, ORIGIN) if frame == own else self._seen_from(own, frame, stamp_ns)
            )
            frame_from_marker = pose_of(marker.pose, "marker")
        except (FrameError, DisplayMessageError) as error:
            self._note(f"A marker of a control is not shown: {error}")
            return False
        turns = control.orientation_mode == OrientationMode.INHERIT
        reference_from_control = (self._pose[0] if turns else NO_TURN), self._pose[1]
        _set_pose(
            marker.pose,
            compose(
                inverse(_flat(reference_from_control)),
                compose(_flat(reference_from_frame), _flat(frame_from_marker)),
            ),
        )
        return True

    def _say_problems(self, store: MarkerStore) -> None:
        problems = store.table.problems[: store.table.size]
        found = {int(one) for one in np.unique(problems).tolist()} - {int(Problem.NONE)}
        for one in sorted(found | {int(one) for one in store.refused.values()}, reverse=True):
            sentence = SENTENCES[Problem(one)]
            if sentence.level == "error":
                self._note(f"A marker of a control {sentence.text}.")

    def _note(self, sentence: str) -> None:
        if sentence not in self._faults and len(self._faults) < 5:
            self._faults[sentence] = None
            self.problems.append(sentence)


def _parted(store: MarkerStore, count: int) -> list[Mapping[str, Shape]]:
    """Return the shapes of markers by their controls, whose numbers are the namespaces."""
    rows: list[list[int]] = [[] for _ in range(count)]
    for row in range(store.table.size):
        if store.table.problems[row] < NOT_DRAWN:
            rows[int(store.table.keys[row][0])].append(row)
    return [
        shapes_of(store.table.rows(np.array(each, dtype=np.intp))) if each else {} for each in rows
    ]


def _flat(pose: Pose) -> tuple[float, float, float, float, float, float, float]:
    (w, x, y, z), (px, py, pz) = pose
    return w, x, y, z, px, py, pz


def _set_pose(pose: MessageValue, parts: tuple[float, ...]) -> None:
    turn, place = pose.orientation, pose.position
    turn.w, turn.x, turn.y, turn.z, place.x, place.y, place.z = parts
