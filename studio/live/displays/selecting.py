"""Selecting: which items of displays were pointed at, where they are, and what is known of them."""

from __future__ import annotations

import asyncio
import time
from contextlib import suppress
from itertools import islice
from typing import TYPE_CHECKING, Final, NamedTuple, Protocol

import numpy as np

from studio.displays.drawing import NO_TURN, Points
from studio.displays.selection import (
    Item,
    Picked,
    box_of,
    orientation_fact,
    position_fact,
    xyz_of,
)
from studio.displays.turning import product, turned
from studio.errors import FrameError
from studio.protocol.commands import Commands, Limits, Scope
from studio.protocol.selection import (
    ITEMS_MAX,
    PART_NAME_MAX,
    DescribeItems,
    FactView,
    ItemDetails,
    ItemRef,
    ItemsDescribed,
    ItemsPicked,
    ItemView,
    PickItems,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping

    from numpy.typing import NDArray

    from studio.displays.display import Display
    from studio.displays.drawing import Pose, Wxyz, Xyz
    from studio.displays.selection import Fact
    from studio.live.displays.placing import Lookup, Shown
    from studio.protocol.selection import PickedNode
    from studio.robot.values import Robot

_AT_ONCE_S: Final = 0.01
"""Then others have their turn on the event loop."""
_DIGITS: Final = 6
"""Of places, m."""
_ROBOT: Final = ""
"""Stands for a display where links of the document's robot are meant."""


class Drawn(Protocol):
    """A display at work."""

    @property
    def display(self) -> Display:
        """What makes its drawings."""
        ...

    @property
    def shown(self) -> Shown:
        """What is drawn of it, and the poses of its groups in the fixed frame."""
        ...


class AllDrawn(NamedTuple):
    """What is drawn in the scene of a document."""

    displays: Mapping[str, Drawn]
    """By id."""
    robot: Robot
    """The document's own."""
    lookup: Lookup
    """Looks up frames in the fixed frame."""
    fixed: str
    """The fixed frame."""


class Selecting:
    """Answers for the displays of one document; used on the event loop only.

    Args:
        now: Returns what is drawn now.
    """

    def __init__(self, now: Callable[[], AllDrawn]) -> None:
        self._now = now

    async def pick(self, command: PickItems) -> ItemsPicked:
        """Return the items that were pointed at; parts that are not there any more are ignored."""
        found: dict[str, dict[str, None]] = {}
        rest = _Turns()
        for node in command.nodes:
            found.setdefault(node.display, {}).update(dict.fromkeys(self._keys_at(node)))
            await rest.after()
        chosen = _chosen({display: [*keys] for display, keys in found.items()}, ITEMS_MAX)
        items = tuple(
            ItemRef(display=display, key=key)
            for display, keys in chosen.items()
            for key in keys
            if _is_sendable(key)
        )
        left_out = sum(map(len, found.values())) - len(items)
        return ItemsPicked(request=command.request, items=items, left_out=left_out)

    async def describe(self, command: DescribeItems) -> ItemsDescribed:
        """Return where items are now, and all that is known of a few of them."""
        rest = _Turns()
        views: list[ItemView] = []
        for ref in islice(_refs_of(command), ITEMS_MAX):
            item = self._item(ref)
            if item is not None:
                views.append(self._view(ref, item))
            await rest.after()
        details: list[ItemDetails] = []
        for ref in command.detailed:
            if (made := self._details(ref)) is not None:
                details.append(made)
            await rest.after()
        return ItemsDescribed(
            request=command.request,
            fixed=self._now().fixed,
            items=tuple(views),
            details=tuple(details),
        )

    def _keys_at(self, node: PickedNode) -> Iterable[str]:
        from studio.scene.picked_rows import rows_of  # noqa: PLC0415 - imports viser

        drawn = self._now().displays.get(node.display)
        placed = drawn.shown.drawing.get(node.path) if drawn is not None else None
        shape = placed.shapes.get(node.shape) if placed is not None else None
        if drawn is None or shape is None:
            return ()
        rows = rows_of(shape, node.node, np.array(node.rows, dtype=np.intp))
        return drawn.display.picked(Picked(node.path, node.shape, rows, node.place))

    def _item(self, ref: ItemRef) -> Item | None:
        now = self._now()
        if ref.display == _ROBOT:
            is_there = ref.key in now.robot.links
            return Item("link", ref.key, "", ref.key, 0, None) if is_there else None
        drawn = now.displays.get(ref.display)
        if drawn is None:
            return None
        from studio.displays.display import Display  # noqa: PLC0415 - imports what reads messages

        if type(drawn.display).item is Display.item:
            return _group_of(ref.key, drawn.shown)
        item = drawn.display.item(ref.key)
        return None if item is None else _as_drawn(item, drawn.shown)

    def _view(self, ref: ItemRef, item: Item) -> ItemView:
        pose = self._pose_of(ref.display, item)
        return ItemView(
            display=ref.display,
            key=ref.key,
            kind=item.kind,
            name=item.name,
            path=item.path,
            frame=item.frame,
            stamp=_stamp(item.stamp_ns),
            place=None if pose is None else _placed(pose, item)[0],
            box=_box_numbers(item),
            shape=item.shape,
        )

    def _details(self, ref: ItemRef) -> ItemDetails | None:
        item = self._item(ref)
        if item is None:
            return None
        facts = self._facts(ref)
        pose = self._pose_of(ref.display, item)
        in_fixed: list[Fact] = []
        if pose is not None:
            xyz, wxyz = _placed(pose, item)
            in_fixed.append(position_fact(xyz))
            if wxyz is not None:
                in_fixed.append(orientation_fact(wxyz))
        return ItemDetails(
            display=ref.display,
            key=ref.key,
            facts=tuple(map(_fact_view, facts)),
            in_fixed=tuple(map(_fact_view, in_fixed)),
        )

    def _facts(self, ref: ItemRef) -> tuple[Fact, ...]:
        now = self._now()
        if ref.display != _ROBOT:
            return now.displays[ref.display].display.facts(ref.key)
        from studio.displays.robot_model import link_facts  # noqa: PLC0415 - reads robots

        return link_facts(now.robot, ref.key)

    def _pose_of(self, display: str, item: Item) -> Pose | None:
        """Return the pose of the group of an item in the fixed frame."""
        now = self._now()
        if display == _ROBOT:
            with suppress(FrameError):
                return now.lookup(item.frame, 0)
            return None
        drawn = now.displays.get(display)
        return drawn.shown.poses.get(item.path) if drawn is not None else None


def _chosen(keys: Mapping[str, list[str]], most: int) -> dict[str, list[str]]:
    """Choose at most so many keys: displays of few keep all, others some, spread evenly."""
    chosen: dict[str, list[str]] = {}
    for at, display in enumerate(sorted(keys, key=lambda one: len(keys[one]))):
        of_display = keys[display]
        share = min(len(of_display), most // (len(keys) - at))
        chosen[display] = [of_display[n * len(of_display) // share] for n in range(share)]
        most -= share
    return {display: chosen[display] for display in keys}


def _is_sendable(key: str) -> bool:
    """Whether a page could ask for the item: namespaces of markers are made by others."""
    return len(key) <= PART_NAME_MAX and "\0" not in key


class _Turns:
    """Lets others have their turn once this took long."""

    def __init__(self) -> None:
        self._began_s = time.perf_counter()

    async def after(self) -> None:
        """Call it after each part of the work."""
        if time.perf_counter() - self._began_s > _AT_ONCE_S:
            await asyncio.sleep(0)
            self._began_s = time.perf_counter()


COMMANDS: Final = Commands[Selecting](Scope.DOCUMENT)
COMMANDS.viewer(PickItems, lambda one, c, _: one.pick(c), limits=Limits(per_second=10))
COMMANDS.viewer(DescribeItems, lambda one, c, _: one.describe(c), limits=Limits(per_second=8))


def _group_of(path: str, shown: Shown) -> Item | None:
    """Return a group of a display that does not say what its shapes are."""
    placed = shown.drawing.get(path)
    if placed is None:
        return None
    return Item("message", path, path, placed.frame, placed.stamp_ns, box_of(placed.shapes))


def _as_drawn(item: Item, shown: Shown) -> Item:
    """Return a point of a sweep where it is drawn, which is not where its message has it."""
    placed = shown.drawing.get(item.path)
    if item.row is None or item.box is None or placed is None or placed.sweep is None:
        return item
    shape = placed.shapes.get(item.shape)
    if not isinstance(shape, Points) or item.row >= len(shape.positions):
        return item
    middle = xyz_of(shape.positions[item.row].tolist())
    return item._replace(box=item.box._replace(middle=middle))


def _refs_of(command: DescribeItems) -> Iterator[ItemRef]:
    for group in command.items:
        for key in group.keys:
            yield ItemRef(display=group.display, key=key)


def _placed(pose: Pose, item: Item) -> tuple[Xyz, Wxyz | None]:
    """Return where an item is in the fixed frame by the pose of its group, and how it is turned."""
    wxyz, xyz = np.array(pose[0]), np.array(pose[1])
    own = item.xyz if item.xyz is not None else (item.box.middle if item.box else (0.0, 0.0, 0.0))
    moved: NDArray[np.float64] = xyz + turned(wxyz[None], np.array(own))[0]
    x, y, z = (round(one, _DIGITS) for one in moved.tolist())
    turn = NO_TURN if item.wxyz is None and item.kind == "link" else item.wxyz
    if turn is None:
        return (x, y, z), None
    w, i, j, k = product(wxyz, np.array(turn)).tolist()
    return (x, y, z), (w, i, j, k)


def _box_numbers(item: Item) -> tuple[float, ...] | None:
    if item.box is None:
        return None
    middle, size_m, wxyz = item.box
    turn = () if wxyz == NO_TURN else wxyz
    return tuple(round(one, _DIGITS) for one in (*middle, *size_m, *turn))


def _stamp(stamp_ns: int) -> str:
    return f"{stamp_ns // 10**9}.{stamp_ns % 10**9:09d}" if stamp_ns else ""


def _fact_view(fact: Fact) -> FactView:
    return FactView(name=fact.name[:300], value=fact.value, unit=fact.unit, kind=fact.kind)
