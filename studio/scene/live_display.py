"""A LiveDisplay: what one display draws, as it stands in the scene."""

from __future__ import annotations

import itertools
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, TypeAlias

import numpy as np

from studio.displays.drawing import Picture
from studio.scene import node
from studio.scene.naming import live_node
from studio.scene.pose_writer import PoseWriter
from studio.scene.shapes import Shelves, mesh_uris_of, nodes_of, same_arrays

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from studio.displays.drawing import Drawing, Shape
    from studio.robot.values import Vector3
    from studio.scene.graph import Graph
    from studio.scene.node import Node, Quaternion

Pose: TypeAlias = "tuple[Quaternion, Vector3]"
"""w, x, y, z and x, y, z in m, in the fixed frame."""
Poses: TypeAlias = "Mapping[str, Pose | None]"
"""By path of the drawing; None: not connected to the fixed frame, so it is not seen."""

_Waiting: TypeAlias = "dict[tuple[str, str], Picture]"
"""By path and name: pictures that are to be encoded."""

_STREAMS: Final = itertools.count(1)
"""Each set of arrays that was ever shown has a number of its own."""
_SHORTEST_QUATERNION: Final = 1e-6
PIXELS_AT_ONCE: Final = 1 << 20
"""Of pictures that are encoded in one go: of a large map one tile after the other comes."""


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
    """Draws the groups of one display flat below its root; only what is another object is sent."""

    def __init__(self, graph: Graph, display_id: str, shelves: Shelves, *, visible: bool) -> None:
        self._graph, self._id, self._shelves = graph, display_id, shelves
        self._groups: dict[str, _Group] = {}
        self._meshes: dict[tuple[str, str], frozenset[str]] = {}
        """By path and name of a shape, what it is drawn with."""
        self._waiting: _Waiting = {}
        self._paths: tuple[str, ...] = ()
        self._writer = PoseWriter(graph, lambda path: live_node(display_id, path))
        self.show(visible=visible)

    def show(self, *, visible: bool) -> None:
        """Show or hide all of it."""
        self._graph.put(live_node(self._id), node.group(visible=visible))

    def apply(self, drawing: Drawing, poses: Poses) -> int:
        """Draw another state of it; answers how many nodes were removed.

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
        """Remove all of it; answers how many nodes that were."""
        with self._graph.atomic():
            removed = sum(self._drop(path) for path in tuple(self._groups))
            self._graph.drop(live_node(self._id))
        return removed + 1

    def mesh_uris(self) -> set[str]:
        """Of the meshes that it draws or waits for."""
        return {uri for wanted in self._meshes.values() for uri in wanted}

    def draw_mesh(self, uri: str) -> None:
        """Draw a mesh anew that came or that failed."""
        for (path, name), wanted in tuple(self._meshes.items()):
            if uri in wanted:
                drawn = self._groups[path].shapes[name]
                nodes = nodes_of(drawn.shape, drawn.stream, self._shelves)
                self._put(path, name, replace(drawn, nodes=nodes))

    def draw_waiting(self) -> bool:
        """Draw the next of the pictures that were too many to be drawn at once; False: none."""
        if not self._waiting:
            return False
        path, name = next(iter(self._waiting))
        shape = self._waiting.pop((path, name))
        with self._graph.atomic():
            self._put(path, name, self._draw(self._groups[path].shapes.get(name), shape))
        return True

    def _changed(self, drawing: Drawing) -> tuple[dict[str, dict[str, _Drawn]], _Waiting]:
        """What is to be put now, by path and name, and what has to wait: nothing is touched yet."""
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
    """Make the quaternions of (N, 7) rows length 1, in place; answers which rows are poses."""
    lengths = np.linalg.norm(rows[:, :4], axis=1, keepdims=True)
    known = np.isfinite(rows).all(axis=1) & (lengths[:, 0] > _SHORTEST_QUATERNION)
    rows[~known] = np.nan
    rows[known, :4] /= lengths[known]
    return known.tolist()
