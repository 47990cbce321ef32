"""The LiveScene: the drawings of a document's displays, each below a root of its own."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.displays.drawing import Picture
from studio.errors import SceneError
from studio.scene import node
from studio.scene.graph import LIVE, PoseWriter, live_node
from studio.scene.shapes import Shelves, mesh_uris_of, nodes_of, same_arrays

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Drawing, Shape
    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import Vector3
    from studio.scene.graph import Graph
    from studio.scene.node import Node, Quaternion

Pose: TypeAlias = "tuple[Quaternion, Vector3]"
"""w, x, y, z and x, y, z in m, in the fixed frame."""
Poses: TypeAlias = "Mapping[str, Pose | None]"
"""By path of the drawing; None: not connected to the fixed frame, so it is hidden."""

_Waiting: TypeAlias = "dict[tuple[str, str], Picture]"
"""By path and name: pictures to be encoded."""

_STREAMS: Final = itertools.count(1)
"""Numbers each set of arrays that was ever shown."""
_SHORTEST_QUATERNION: Final = 1e-6
PIXELS_AT_ONCE: Final = 1 << 20
"""Limit of pictures encoded in one step: a large map comes tile by tile."""
GROUPS_MAX: Final = 10_000
SHAPES_MAX: Final = 20_000
_SWEEP_AFTER: Final = 2000
"""Nodes removed: viser keeps a record of each until `sweep`."""


@dataclass(slots=True)
class _Drawn:
    """A shape and the nodes that it became, by the last part of their names."""

    shape: Shape
    stream: str
    nodes: dict[str, Node]


@dataclass(slots=True)
class _Group:
    """The shapes of one path."""

    visible: bool = False
    shapes: dict[str, _Drawn] = field(default_factory=dict[str, _Drawn])


class LiveDisplay:
    """Draws the groups of one display flat below its root; sends new objects only."""

    def __init__(self, graph: Graph, display_id: str, shelves: Shelves, *, visible: bool) -> None:
        self._graph, self._id, self._shelves = graph, display_id, shelves
        self._groups: dict[str, _Group] = {}
        self._meshes: dict[tuple[str, str], frozenset[str]] = {}
        """By path and name of a shape, the meshes that it draws."""
        self._waiting: _Waiting = {}
        self._paths: tuple[str, ...] = ()
        self._writer = PoseWriter(graph, lambda path: live_node(display_id, path))
        self.show(visible=visible)

    def show(self, *, visible: bool) -> None:
        """Show or hide all of it."""
        self._graph.put(live_node(self._id), node.group(visible=visible))

    def apply(self, drawing: Drawing, poses: Poses) -> int:
        """Draw another state of it; return how many nodes were removed.

        Raises:
            SceneError: It is more than a browser can draw; then all is as before.
        """
        changed, self._waiting = self._changed(drawing)
        with self._graph.atomic():
            removed = sum(self._drop(path) for path in tuple(self._groups) if path not in drawing)
            for path in drawing:
                if path not in self._groups:
                    self._groups[path] = _Group()
                    self._put_group(path)
            for path, shapes in changed.items():
                for name, drawn in shapes.items():
                    removed += self._put(path, name, drawn)
            removed += self._drop_shapes_gone(drawing)
            self._paths = tuple(drawing)
            self._place(dict.fromkeys(drawing) | dict(poses))
        return removed

    def place(self, poses: Poses) -> None:
        """Move groups; those that are not named stay where they are."""
        with self._graph.atomic():
            self._place(poses)

    def drop(self) -> int:
        """Remove all of it; return how many nodes were removed."""
        with self._graph.atomic():
            removed = sum(self._drop(path) for path in tuple(self._groups))
            self._graph.drop(live_node(self._id))
        return removed + 1

    def mesh_uris(self) -> set[str]:
        """URIs of the meshes that it draws or waits for."""
        return {uri for wanted in self._meshes.values() for uri in wanted}

    def draw_mesh(self, uri: str) -> None:
        """Draw a mesh again after it was loaded or failed."""
        for (path, name), wanted in tuple(self._meshes.items()):
            if uri in wanted:
                drawn = self._groups[path].shapes[name]
                nodes = nodes_of(drawn.shape, drawn.stream, self._shelves)
                self._put(path, name, replace(drawn, nodes=nodes))

    def draw_waiting(self) -> bool:
        """Draw the next of the pictures that had to wait; False if none is left."""
        if not self._waiting:
            return False
        path, name = next(iter(self._waiting))
        shape = self._waiting.pop((path, name))
        with self._graph.atomic():
            self._put(path, name, self._draw(self._groups[path].shapes.get(name), shape))
        return True

    @property
    def has_waiting(self) -> bool:
        """Whether pictures have to wait for another tick."""
        return bool(self._waiting)

    def _changed(self, drawing: Drawing) -> tuple[dict[str, dict[str, _Drawn]], _Waiting]:
        """Return what to put now, by path and name, and what has to wait; change nothing."""
        changed: dict[str, dict[str, _Drawn]] = {}
        waiting: _Waiting = {}
        pixels = 0
        for path, placed in drawing.items():
            group = self._groups.get(path)
            for name, shape in placed.shapes.items():
                old = group.shapes.get(name) if group else None
                if old is not None and old.shape is shape:
                    continue
                if isinstance(shape, Picture):
                    before, pixels = pixels, pixels + _pixels_of(shape)
                    if before and pixels > PIXELS_AT_ONCE:
                        waiting[path, name] = shape
                        continue
                changed.setdefault(path, {})[name] = self._draw(old, shape)
        return changed, waiting

    def _draw(self, old: _Drawn | None, shape: Shape) -> _Drawn:
        same = old is not None and same_arrays(old.shape, shape)
        stream = old.stream if old and same else str(next(_STREAMS))
        return _Drawn(shape, stream, nodes_of(shape, stream, self._shelves))

    def _put(self, path: str, name: str, drawn: _Drawn) -> int:
        shapes = self._groups[path].shapes
        old = shapes.get(name)
        gone = [part for part in old.nodes if part not in drawn.nodes] if old else []
        for part in gone:
            self._graph.drop(self._node(path, name, part))
        for part, made in drawn.nodes.items():
            self._graph.put(self._node(path, name, part), made)
        shapes[name] = drawn
        if uris := mesh_uris_of(drawn.shape):
            self._meshes[path, name] = uris
        else:
            self._meshes.pop((path, name), None)
        return len(gone)

    def _put_group(self, path: str) -> None:
        visible = self._groups[path].visible
        self._graph.put(live_node(self._id, path), node.group(visible=visible))

    def _drop_shapes_gone(self, drawing: Drawing) -> int:
        removed = 0
        for path, placed in drawing.items():
            shapes = self._groups[path].shapes
            if len(shapes) == len(placed.shapes) and not self._waiting:
                continue  # all of those of the drawing were put
            for name in [name for name in shapes if name not in placed.shapes]:
                removed += self._drop_shape(path, name)
        return removed

    def _drop_shape(self, path: str, name: str) -> int:
        drawn = self._groups[path].shapes.pop(name)
        self._meshes.pop((path, name), None)
        for part in drawn.nodes:
            self._graph.drop(self._node(path, name, part))
        return len(drawn.nodes)

    def _drop(self, path: str) -> int:
        removed = sum(self._drop_shape(path, name) for name in tuple(self._groups[path].shapes))
        del self._groups[path]
        self._graph.drop(live_node(self._id, path))
        return removed + 1

    def _node(self, path: str, name: str, part: str) -> str:
        return live_node(self._id, path, f"{name}.{part}")  # no part has a dot in it

    def _place(self, poses: Poses) -> None:
        rows = np.full((len(self._paths), 7), np.nan)
        for row, path in enumerate(self._paths):
            pose = poses.get(path)
            if pose is not None:
                rows[row, :4], rows[row, 4:] = pose
        known = _with_unit_quaternions(rows)
        self._writer.write(self._paths, rows, self._groups)
        for path, seen in zip(self._paths, known, strict=True):
            if path in poses and self._groups[path].visible is not seen:
                self._groups[path].visible = seen
                self._put_group(path)


def _pixels_of(picture: Picture) -> int:
    rows, columns = picture.pixels.shape[:2]
    return rows * columns


def _with_unit_quaternions(rows: NDArray[np.float64]) -> list[bool]:
    """Make the quaternions of (N, 7) rows length 1, in place; return which rows are poses."""
    lengths = np.linalg.norm(rows[:, :4], axis=1, keepdims=True)
    known = np.isfinite(rows).all(axis=1) & (lengths[:, 0] > _SHORTEST_QUATERNION)
    rows[~known] = np.nan
    rows[known, :4] /= lengths[known]
    return known.tolist()


class LiveScene:
    """Applies Drawings: compared by path and by identity, moved in atomic batches.

    Args:
        graph: Where the nodes go.
        known: Returns a mesh that the robot beside it has already.
        sweep: Lets viser forget what was removed.
    """

    def __init__(
        self,
        graph: Graph,
        known: Callable[[str], LoadedMesh | None],
        sweep: Callable[[], None],
    ) -> None:
        self._graph, self._known, self._sweep = graph, known, sweep
        self._shelves = Shelves()
        self._displays: dict[str, LiveDisplay] = {}
        self._hidden: set[str] = set()
        self._removed = 0
        self._has_encoded = False
        """Whether as many pictures were encoded since the last tick as one has time for."""

    def apply(self, display_id: str, drawing: Drawing, poses: Poses) -> None:
        """Draw another state of a display in one atomic batch; ask for missing meshes afterwards.

        Args:
            display_id: Any text; its first drawing makes the display.
            drawing: All that it draws now. A shape that is the same object is not sent again.
            poses: Of each path in the fixed frame; one that is not there or None is not seen.

        Raises:
            SceneError: It is more than a browser can draw; then all is as before.
        """
        _check_count(display_id, drawing)
        display = self._displays.get(display_id)
        with self._graph.atomic():
            if display is None:
                self._graph.put(LIVE, node.group())
                visible = display_id not in self._hidden
                display = LiveDisplay(self._graph, display_id, self._shelves, visible=visible)
                self._displays[display_id] = display
            self._forget(display.apply(drawing, poses))
        self._has_encoded |= display.has_waiting
        self._tidy_meshes()

    def place(self, display_id: str, poses: Poses) -> None:
        """Move groups of a display and nothing else; those that are not named stay."""
        if display := self._displays.get(display_id):
            display.place(poses)

    def draw_waiting(self) -> None:
        """Draw one more of the pictures that had to wait; call it every tick.

        Not in a tick in which others were drawn: to encode one takes 20 ms.
        """
        if not self._has_encoded:
            any(display.draw_waiting() for display in self._displays.values())
        self._has_encoded = False

    def drop(self, display_id: str) -> None:
        """Remove a display; it need not be there."""
        self._hidden.discard(display_id)
        if display := self._displays.pop(display_id, None):
            self._forget(display.drop())
            self._tidy_meshes()

    def show(self, display_id: str, *, visible: bool) -> None:
        """Show or hide a display, also one that has drawn nothing yet."""
        if visible:
            self._hidden.discard(display_id)
        else:
            self._hidden.add(display_id)
        if display := self._displays.get(display_id):
            display.show(visible=visible)

    def missing_meshes(self) -> set[str]:
        """URIs of meshes to load and `provide_mesh`."""
        return {uri for uri in self.mesh_uris() if uri not in self._shelves.meshes}

    def mesh_uris(self) -> set[str]:
        """URIs of all meshes that displays name."""
        return {uri for display in self._displays.values() for uri in display.mesh_uris()}

    def failed_meshes(self, display_id: str) -> list[str]:
        """URIs of meshes of a display that cannot be loaded."""
        display = self._displays.get(display_id)
        meshes = self._shelves.meshes
        uris = display.mesh_uris() if display else set[str]()
        return sorted(uri for uri in uris if uri in meshes and meshes.get(uri) is None)

    def provide_mesh(self, uri: str, mesh: LoadedMesh | None) -> None:
        """Draw a mesh wherever it is named, or a sign when it is None."""
        if uri not in self.mesh_uris() or not self._shelves.meshes.put(uri, mesh):
            return
        with self._graph.atomic():
            for display in self._displays.values():
                display.draw_mesh(uri)

    def mesh(self, uri: str) -> LoadedMesh | None:
        """Return a loaded mesh; None when it is not loaded yet, or failed."""
        return self._shelves.meshes.get(uri)

    def _tidy_meshes(self) -> None:
        """Forget meshes that no display names, and take those that the robot has."""
        uris = self.mesh_uris()
        self._shelves.meshes.keep_only(uris)
        for uri in uris:
            if uri not in self._shelves.meshes and (mesh := self._known(uri)) is not None:
                self.provide_mesh(uri, mesh)

    def _forget(self, removed: int) -> None:
        self._removed += removed
        if self._removed > _SWEEP_AFTER:
            self._removed = 0
            self._sweep()


def _check_count(display_id: str, drawing: Drawing) -> None:
    shapes = sum(len(placed.shapes) for placed in drawing.values())
    for count, most, what in (
        (len(drawing), GROUPS_MAX, "groups"),
        (shapes, SHAPES_MAX, "shapes"),
    ):
        if count > most:
            raise SceneError(
                f'The display "{display_id[:80]}" draws {count} {what}, and the 3D view takes '
                f"{most} of one display: let it show fewer, or its publisher send fewer."
            )
