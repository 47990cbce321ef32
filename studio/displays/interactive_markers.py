"""InteractiveMarkers: markers of a server that people move, and how they look meanwhile."""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, ClassVar, Final, Literal

import numpy as np

from studio.displays.display import Display, Status
from studio.displays.drawing import NO_TURN, NOTHING, Axes, Placed
from studio.displays.interactive_marker import shown_name
from studio.displays.properties import Property, switch
from studio.ros.interactive_markers.names import UPDATE, UPDATE_TOPIC, OrientationMode

if TYPE_CHECKING:
    from collections.abc import Iterable, Mapping

    from studio.displays.display import Reason
    from studio.displays.drawing import Drawing, Pose, Shape
    from studio.displays.interactive_marker import ControlModel, MarkerModel
    from studio.displays.properties import Value
    from studio.ros.types.library import TypeLibrary

NAMESPACE: Final = "Interactive Markers Namespace"
DESCRIPTIONS: Final = "Show Descriptions"
AXES: Final = "Show Axes"
VISUAL_AIDS: Final = "Show Visual Aids"
TRANSPARENCY: Final = "Enable Transparency"
MARKERS_MAX: Final = 300
CONTROLS_MAX: Final = 1000
"""Of all markers of a display."""
_DRAWN_AT_ONCE: Final = 100
"""Controls whose shapes are new in one drawing: more would hold up the rest."""
_PROBLEMS_MAX: Final = 6
_NAME_KEPT: Final = 1000
_AXIS_RADIUS: Final = 0.05
"""Of the axes of a marker, as a share of their length."""


@dataclass(slots=True)
class ShownMarker:
    """A marker in the display.

    Attributes:
        number: Stands for its name in the scene, as long as the marker exists.
        model: As it is shown.
        control_numbers: By name; kept when the server sends the marker anew.
        turns_rad: By number of a control with a fixed orientation, how far it was turned by hand.
        held: Whether somebody drags it; poses of the server wait meanwhile.
        waiting: The last of those.
        drawn: Its groups as they were drawn last.
        is_stale: Whether they are to be made anew.
        shapes: Of its controls, by their numbers, as they are drawn.
        waiting_shapes: Controls whose shapes are still to be drawn: a few at a time.
    """

    number: int
    model: MarkerModel
    control_numbers: dict[str, int] = field(default_factory=dict[str, int])
    turns_rad: dict[int, float] = field(default_factory=dict[int, float])
    held: bool = False
    waiting: Pose | None = None
    drawn: dict[str, Placed] = field(default_factory=dict[str, "Placed"])
    is_stale: bool = True
    shapes: dict[int, Mapping[str, Shape]] = field(default_factory=dict[int, "Mapping[str, Shape]"])
    waiting_shapes: deque[ControlModel] = field(default_factory=deque["ControlModel"])


class InteractiveMarkersDisplay(Display):
    """Shows what a client of the server hands over; the client is elsewhere.

    In the scene each marker is some groups: `m<number>` is its reference frame, with nothing in it;
    `m<number>-body` turns with the marker, `m<number>-f<control>` keeps the axes of the reference
    frame, `m<number>-v<control>` and `m<number>-title` face the eye, which the page sees to. A
    shape of a control is named `c<control>-...`.

    Attributes:
        version: Grows whenever what can be done with the markers changes, and not with their poses.
        resets: How often all was to be forgotten: the client begins again then.
    """

    KIND = "InteractiveMarkers"
    DOC = "Shows markers of a server that can be moved, turned and clicked in the 3D view."
    ICON = "hand"
    OF_TYPES: ClassVar[tuple[str, ...]] = (UPDATE,)
    PROPERTIES: ClassVar[tuple[Property, ...]] = (
        Property(
            NAMESPACE, "marker_server", "", "Namespace of the server's topics, as /basic_controls."
        ),
        switch(DESCRIPTIONS, "Shows the description of each marker above it.", on=True),
        switch(AXES, "Shows the axes of each marker.", on=False),
        switch(VISUAL_AIDS, "Shows the axis along or about which a marker is moved.", on=False),
        switch(TRANSPARENCY, "Lets one see through handles that the server left open.", on=True),
    )

    def __init__(self, types: TypeLibrary, values: Mapping[str, Value] | None = None) -> None:
        super().__init__(types, values)
        self.version = 0
        self.resets = 0
        self._shown: dict[str, ShownMarker] = {}
        self._numbers = 0
        self._drawing: Drawing | None = NOTHING
        self._said: Status | None = None
        self._faults: dict[str, str] = {}
        """By marker, why it is not shown."""
        self._left_out = 0

    @classmethod
    def settings_for(cls, topic: str) -> Mapping[str, Value]:
        """Return the namespace that a topic of updates belongs to."""
        return {NAMESPACE: topic.removesuffix(UPDATE_TOPIC)} if topic else {}

    @property
    def namespace(self) -> str:
        """Of the server; empty: none was chosen."""
        text = str(self.values[NAMESPACE]).strip().rstrip("/")
        return text if not text or text.startswith(("/", "~")) else f"/{text}"

    @property
    def is_transparent(self) -> bool:
        """Whether handles may be seen through."""
        return bool(self.values[TRANSPARENCY])

    @property
    def has_visual_aids(self) -> bool:
        """Whether the axis of a movement is shown."""
        return bool(self.values[VISUAL_AIDS])

    @property
    def markers(self) -> tuple[ShownMarker, ...]:
        """All that are shown."""
        return tuple(self._shown.values())

    def marker(self, number: int) -> ShownMarker | None:
        """Return the one of a number; None: it is gone."""
        return next((one for one in self._shown.values() if one.number == number), None)

    def changed(self, name: str) -> None:
        """Draw anew; another namespace has other markers, and transparency is the client's."""
        if name in ("", NAMESPACE, TRANSPARENCY):
            self.clear()
        self.version += 1
        for one in self._shown.values():
            one.is_stale = True
        self._drawing = None

    def reset(self) -> None:
        """Forget all; the client asks again."""
        self.resets += 1
        super().reset()

    def clear(self) -> None:
        """Show no marker."""
        self._shown, self._faults, self._left_out = {}, {}, 0
        self._drawing = None
        self.version += 1

    def put(self, markers: Iterable[MarkerModel], *, left_out: int = 0) -> None:
        """Add markers, or replace those of their names; while one is dragged, its pose waits.

        Args:
            markers: As they were read.
            left_out: How many markers or controls were too many to be read.
        """
        self._left_out += left_out
        room = CONTROLS_MAX - sum(len(one.model.controls) for one in self._shown.values())
        for model in markers:
            self._faults.pop(model.name[:_NAME_KEPT], None)
            shown = self._shown.get(model.name)
            room += len(shown.model.controls) if shown else 0
            self._left_out += max(0, len(model.controls) - room)
            fitting = replace(model, controls=model.controls[: max(0, room)])
            room -= len(fitting.controls)
            if shown is not None:
                _replace(shown, fitting)
            elif len(self._shown) < MARKERS_MAX:
                self._numbers += 1
                shown = self._shown[model.name] = ShownMarker(self._numbers, fitting)
                _number_controls(shown)
            else:
                self._left_out += 1
        self._drawing = None
        self.version += 1

    def refuse(self, name: str, sentence: str) -> None:
        """Say why a marker is not shown; one of that name from before stays."""
        if len(self._faults) < MARKERS_MAX:
            self._faults[name[:_NAME_KEPT]] = sentence

    def move(self, name: str, pose: Pose, frame: str | None = None, stamp_ns: int = 0) -> bool:
        """Take a pose from the server; False: there is no such marker.

        Args:
            name: Of the marker.
            pose: In its reference frame.
            frame: The reference frame from now on; None: as before.
            stamp_ns: Of the pose, if there is a frame; 0: it moves with its frame.
        """
        shown = self._shown.get(name)
        if shown is None:
            return False
        if shown.held:
            shown.waiting = pose
            return True
        model = shown.model
        if frame is not None and (frame, stamp_ns) != (model.frame, model.stamp_ns):
            model = replace(model, frame=frame, stamp_ns=stamp_ns)
            self.version += 1
        self._set(shown, model.at(pose))
        return True

    def erase(self, names: Iterable[str]) -> None:
        """Show these no more."""
        for name in names:
            self._faults.pop(name[:_NAME_KEPT], None)
            if self._shown.pop(name, None) is not None:
                self._drawing = None
        self.version += 1

    def drag(self, shown: ShownMarker, pose: Pose, turn_rad: tuple[int, float]) -> None:
        """Show a marker where somebody dragged it; poses of the server wait from now on.

        Args:
            shown: The marker.
            pose: In its reference frame.
            turn_rad: A control's number, and how far it was turned by hand.
        """
        shown.held = True
        control, turn = turn_rad
        if turn:
            shown.turns_rad[control] = turn
        self._set(shown, shown.model.at(pose))

    def let_go(self, shown: ShownMarker) -> None:
        """The marker goes where the server wanted it meanwhile, if it did."""
        shown.held = False
        if shown.waiting is not None:
            waiting, shown.waiting = shown.waiting, None
            self._set(shown, shown.model.at(waiting))

    def say(self, level: Literal["ok", "warn", "error"], reason: Reason | None, text: str) -> None:
        """Report how it is with the server."""
        self._said = Status(level, reason, text) if text else None

    def draw(self, now_ns: int) -> Drawing:
        """Return all markers as they are now."""
        del now_ns
        if self._drawing is not None:
            return self._drawing
        made: dict[str, Placed] = {}
        room, waits = _DRAWN_AT_ONCE, False
        for shown in self._shown.values():
            while shown.waiting_shapes and room > 0:
                control = shown.waiting_shapes.popleft()
                shown.shapes[shown.control_numbers[control.name]] = control.shapes
                room, shown.is_stale = room - 1, True
            if shown.is_stale:
                shown.drawn, shown.is_stale = self._groups(shown), False
            waits |= bool(shown.waiting_shapes)  # the rest comes with the next drawings
            made |= shown.drawn
        self._drawing = None if waits else made
        return made

    def statuses(self) -> tuple[Status, ...]:
        """Return what is wrong: with the server first, then with its markers."""
        found = [self._said] if self._said is not None else []
        if self._left_out:
            sentence = (
                f"{self._left_out:,} markers or controls are left out: at most {MARKERS_MAX:,} "
                f"markers with {CONTROLS_MAX:,} controls in all are shown."
            )
            found.append(Status("error", "thinned", sentence))
        found += [Status("error", "bad_message", one) for one in self._faults.values()]
        for shown in self._shown.values():
            name = shown_name(shown.model.name)
            found += [Status("warn", "bad_message", f"{name}: {one}") for one in
                      shown.model.problems]  # fmt: skip
            if len(found) > _PROBLEMS_MAX:
                break
        return tuple(found[:_PROBLEMS_MAX])

    def _set(self, shown: ShownMarker, model: MarkerModel) -> None:
        before, shown.model = shown.model, model
        same_frame = (before.frame, before.stamp_ns) == (model.frame, model.stamp_ns)
        shown.is_stale |= not same_frame
        shown.drawn = self._moved(shown)
        self._drawing = None

    def _groups(self, shown: ShownMarker) -> dict[str, Placed]:
        """Return the groups of a marker with all their shapes."""
        model = shown.model
        body: dict[str, Shape] = self._axes(model) if self.values[AXES] else {}
        parts: dict[str, tuple[Mapping[str, Shape], Pose]] = {}
        for control in model.controls:
            number = shown.control_numbers[control.name]
            drawn = shown.shapes.get(number, {})
            shapes = {f"c{number}-{name}": shape for name, shape in drawn.items()}
            if control.facing == OrientationMode.INHERIT:
                body |= shapes
            elif shapes:
                parts[group_of(control, number)] = shapes, _offset(shown, control, number)
        parts["body"] = body, model.pose
        if self.values[DESCRIPTIONS] and model.title:
            parts["title"] = model.title, (NO_TURN, model.pose[1])
        groups = {f"m{shown.number}": _placed(model, {}, None)}
        for part, (shapes, offset) in parts.items():
            groups[f"m{shown.number}-{part}"] = _placed(model, shapes, offset)
        return groups

    def _moved(self, shown: ShownMarker) -> dict[str, Placed]:
        """Return the groups as they were drawn before, where the marker is now."""
        model, prefix = shown.model, f"m{shown.number}-"
        offsets: dict[str, Pose] = {
            f"{prefix}body": model.pose,
            f"{prefix}title": (NO_TURN, model.pose[1]),
        }
        for control in model.controls:
            number = shown.control_numbers[control.name]
            if control.facing != OrientationMode.INHERIT:
                path = f"{prefix}{group_of(control, number)}"
                offsets[path] = _offset(shown, control, number)
        return {
            path: _placed(model, placed.shapes, offsets[path]) if path in offsets else placed
            for path, placed in shown.drawn.items()
        }

    def _axes(self, model: MarkerModel) -> dict[str, Shape]:
        length_m = model.scale or 1.0
        origin, turn = np.zeros((1, 3), np.float32), np.array([NO_TURN], np.float32)
        return {"axes": Axes(origin, turn, length_m, _AXIS_RADIUS * length_m)}


def group_of(control: ControlModel, number: int) -> str:
    """Return the part of the scene that the shapes of a control are in."""
    if control.facing == OrientationMode.INHERIT:
        return "body"
    return f"{'f' if control.facing == OrientationMode.FIXED else 'v'}{number}"


def _replace(shown: ShownMarker, model: MarkerModel) -> None:
    if shown.held:
        shown.waiting, model = model.pose, model.at(shown.model.pose)
    shown.model, shown.is_stale = model, True
    _number_controls(shown)


def _number_controls(shown: ShownMarker) -> None:
    numbers = shown.control_numbers
    names = dict.fromkeys(one.name for one in shown.model.controls)
    for name in [one for one in numbers if one not in names]:
        number = numbers.pop(name)
        shown.turns_rad.pop(number, None)
        shown.shapes.pop(number, None)
    following = max(numbers.values(), default=-1) + 1
    for name in [one for one in names if one not in numbers]:
        numbers[name], following = following, following + 1
    shown.waiting_shapes = deque(shown.model.controls)


def _placed(model: MarkerModel, shapes: Mapping[str, Shape], offset: Pose | None) -> Placed:
    follows = model.stamp_ns == 0
    return Placed(model.frame, model.stamp_ns, shapes, follows=follows, offset=offset)


def _offset(shown: ShownMarker, control: ControlModel, number: int) -> Pose:
    """Return the pose of a control that does not turn with its marker, in the reference frame."""
    turn, place = shown.model.pose
    if control.facing == OrientationMode.VIEW_FACING:
        return (turn if control.independent else NO_TURN), place
    angle = shown.turns_rad.get(number, 0.0) / 2
    w, x, y, z = control.wxyz
    axis = (1 - 2 * (y * y + z * z), 2 * (x * y + w * z), 2 * (x * z - w * y))
    sine = float(np.sin(angle))
    return (float(np.cos(angle)), sine * axis[0], sine * axis[1], sine * axis[2]), place
