"""The RobotDrawing: a robot link by link, of which only changes are sent; and its ground."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.meshes.textured import mesh_uris
from studio.robot.values import Box, Cylinder, Mesh, Robot, Sphere
from studio.scene import node
from studio.scene.graph import ROBOT, link_node
from studio.scene.link_nodes import LAYERS, LinkContext, MeshShelf, wxyz_from_rpy

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Sequence, Set

    from numpy.typing import NDArray

    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.rotations import Floats
    from studio.robot.values import Geometry, Joint, Link, Vector3, Visual
    from studio.scene.graph import Graph
    from studio.scene.link_nodes import Nodes
    from studio.scene.node import Quaternion

_Boxes: TypeAlias = "tuple[Floats, Floats]"


class Ground:
    """The boxes around the visuals of each link.

    Of one link with n visuals: their centres, (n, 3), and half their edges as vectors, (n, 3, 3),
    in the link's frame, m.
    """

    def __init__(self) -> None:
        self._boxes: dict[str, _Boxes] = {}
        self._noted: dict[str, tuple[Link, MeshShelf]] = {}
        """Links whose boxes are not made yet."""

    def note(self, link: Link, shelf: MeshShelf) -> None:
        """Note a new state of a link; meshes that are not loaded when it matters are left out."""
        self._noted[link.name] = link, shelf

    def forget(self, link: str) -> None:
        """Forget a removed link."""
        self._boxes.pop(link, None)
        self._noted.pop(link, None)

    def height_m(self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]) -> float:
        """Lowest corner in the root frame, at most 0: a robot above its origin hovers on purpose.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7), as for `DocumentScene.set_poses`.
        """
        self._update()
        lowest = 0.0
        for name, pose in zip(link_names, np.asarray(wxyz_xyz, dtype=np.float64), strict=True):
            boxes = self._boxes.get(name)
            if boxes is not None:
                centres, edges = boxes
                up = _up_in_link(pose)
                heights = centres @ up - np.abs(edges @ up).sum(axis=1) + pose[6]
                lowest = min(lowest, float(heights.min()))
        return lowest if math.isfinite(lowest) else 0.0

    def bounds_m(
        self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]
    ) -> tuple[Floats, Floats]:
        """Lowest and highest corner of all boxes in the root frame, each (3,); zeros for none.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7), as for `DocumentScene.set_poses`.
        """
        self._update()
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for name, pose in zip(link_names, np.asarray(wxyz_xyz, dtype=np.float64), strict=True):
            boxes = self._boxes.get(name)
            if boxes is not None:
                rotation = np.array(_rows_of_turn(pose[:4].tolist()))
                centres = boxes[0] @ rotation.T + pose[4:]
                halves = np.abs(boxes[1] @ rotation.T).sum(axis=1)
                low = np.minimum(low, (centres - halves).min(axis=0))
                high = np.maximum(high, (centres + halves).max(axis=0))
        is_there = bool(np.isfinite(low).all() and np.isfinite(high).all())
        return (low, high) if is_there else (np.zeros(3), np.zeros(3))

    def _update(self) -> None:
        noted, self._noted = self._noted, {}
        for name, (link, shelf) in noted.items():
            found = [box for visual in link.visuals if (box := _box_of(visual, shelf))]
            self._boxes.pop(name, None)
            if found:
                self._boxes[name] = (
                    np.array([centre for centre, _ in found]),
                    np.array([edges for _, edges in found]),
                )


def _up_in_link(pose: Floats) -> Floats:
    """Return the third row of the rotation: how much each axis of the link points up."""
    w, x, y, z = pose[:4].tolist()
    return np.array([2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)])


def _rows_of_turn(wxyz: Iterable[float]) -> tuple[Vector3, Vector3, Vector3]:
    """Return the rotation matrix of a unit quaternion, row by row."""
    w, x, y, z = wxyz
    return (
        (1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)),
        (2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)),
        (2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)),
    )


def _box_of(visual: Visual, shelf: MeshShelf) -> tuple[Vector3, tuple[Vector3, ...]] | None:
    """Centre, and half of each edge as a vector; None for a visual without extent."""
    found = _extent(visual.geometry, shelf)
    if found is None:
        return None
    (mx, my, mz), half = found
    rows = _rows_of_turn(wxyz_from_rpy(visual.origin.rpy))
    x, y, z = (
        row[0] * mx + row[1] * my + row[2] * mz + at
        for row, at in zip(rows, visual.origin.xyz, strict=True)
    )
    edges = tuple(
        (rows[0][i] * half[i], rows[1][i] * half[i], rows[2][i] * half[i]) for i in range(3)
    )
    finite = all(map(math.isfinite, (x, y, z, *edges[0], *edges[1], *edges[2])))
    return ((x, y, z), edges) if finite else None


def _extent(geometry: Geometry, shelf: MeshShelf) -> tuple[Vector3, Vector3] | None:
    """Middle and half of the size, in the frame of the geometry."""
    middle = (0.0, 0.0, 0.0)
    match geometry:
        case Box((x, y, z)):
            return middle, (x / 2, y / 2, z / 2)
        case Cylinder(radius_m, length_m):
            return middle, (radius_m, radius_m, length_m / 2)
        case Sphere(radius_m):
            return middle, (radius_m, radius_m, radius_m)
        case Mesh():
            loaded = shelf.get(geometry.uri)
            if loaded is None:
                return None
            low, high = np.array(loaded.bounds_m) * np.array(geometry.scale)
            (mx, my, mz), (hx, hy, hz) = ((low + high) / 2).tolist(), ((high - low) / 2).tolist()
            return (mx, my, mz), (abs(hx), abs(hy), abs(hz))


class RobotDrawing:
    """Draws the links flat below `/robot`; their poses are not its business.

    A layer is made when it is first switched on and hidden, not removed, when switched off.

    Args:
        graph: Where the nodes go.
        moved: Called with each link whose node was made or removed, so that its pose is sent again.
    """

    def __init__(self, graph: Graph, moved: Callable[[str], None]) -> None:
        self._graph, self._moved = graph, moved
        self._robot = Robot("")
        self._shelf = MeshShelf()
        self._drawn: dict[str, Nodes] = {}
        self._joint_of: dict[str, Joint] = {}
        self._made: dict[str, bool] = {"visual": True}  # layer to whether it is shown
        self._opacity = 1.0
        self._root_pose: tuple[Quaternion, Vector3] = (node.NO_TURN, node.ORIGIN)
        self.ground = Ground()
        self._put_root()

    @property
    def links(self) -> Set[str]:
        """Links that are in the scene."""
        return self._drawn.keys()

    def show(
        self, robot: Robot, changed_links: frozenset[str] | None, *, same_meshes: bool = False
    ) -> None:
        """Draw a new state of the robot; see `DocumentScene.show`."""
        joint_of = {joint.child: joint for joint in robot.joints.values()}
        changed = self._changed(robot, joint_of, changed_links)
        self._robot, self._joint_of = robot, joint_of
        if not same_meshes:
            self._shelf.keep_only(self._mesh_uris())
        with self._graph.atomic():
            for link in tuple(self._drawn):
                if link not in robot.links:
                    self._remove(link)
            for link in changed:
                self._draw(robot.links[link])

    def missing_meshes(self) -> set[str]:
        """Return the URIs of meshes that the layers so far need and that are not loaded."""
        return {uri for uri in self._mesh_uris() if uri not in self._shelf}

    def mesh(self, uri: str) -> LoadedMesh | None:
        """Return a loaded mesh; None when it is not loaded yet, or failed."""
        return self._shelf.get(uri)

    def provide_mesh(self, uri: str, mesh: LoadedMesh | None) -> None:
        """Draw a mesh wherever it is named, or a sign when it is None."""
        if uri not in self._mesh_uris() or not self._shelf.put(uri, mesh):
            return
        with self._graph.atomic():
            for link in self._robot.links.values():
                if uri in mesh_uris(link):
                    self._draw(link)

    def switch(self, layer: str, *, shown: bool) -> None:
        """Show or hide a layer."""
        if layer in self._made or shown:
            self._made[layer] = shown
            with self._graph.atomic():
                for link in self._robot.links.values():
                    self._draw(link)

    def fade(self, opacity: float) -> None:
        """Let the whole robot be see-through."""
        self._opacity = opacity
        self._put_root()

    def place(self, wxyz: Quaternion, position_m: Vector3) -> None:
        """Put the root link there in the fixed frame."""
        self._root_pose = (wxyz, position_m)
        self._put_root()

    def _put_root(self) -> None:
        # The page reads the robot's opacity from a size that is never drawn: viser has no opacity
        # for meshes with materials of their own, and a value there costs one message, not one
        # for each node.
        root = node.group(*self._root_pose)
        self._graph.put(ROBOT, replace(root, props={**root.props, "origin_radius": self._opacity}))

    def _changed(
        self, robot: Robot, joint_of: dict[str, Joint], changed_links: frozenset[str] | None
    ) -> Iterable[str]:
        """Return the links to draw, changed, new, or moved by another joint."""
        if changed_links is None:
            return robot.links
        return [
            link
            for link in robot.links
            if link in changed_links
            or link not in self._drawn
            or ("axes" in self._made and self._joint_of.get(link) != joint_of.get(link))
        ]

    def _draw(self, link: Link) -> None:
        root = link_node(link.name)
        old, new = self._drawn.get(link.name), self._nodes(link)
        for below in reversed(old or {}):
            if below not in new:
                self._graph.drop(f"{root}/{below}")
        if old is None:
            self._graph.put(root, node.group())
            self._moved(link.name)
        for below, drawn in new.items():
            self._graph.put(f"{root}/{below}", drawn)
        self._drawn[link.name] = new
        self.ground.note(link, self._shelf)

    def _remove(self, link: str) -> None:
        root = link_node(link)
        for below in reversed(self._drawn.pop(link)):
            self._graph.drop(f"{root}/{below}")
        self._graph.drop(root)
        self.ground.forget(link)
        self._moved(link)

    def _nodes(self, link: Link) -> Nodes:
        context = LinkContext(link, self._joint_of.get(link.name), self._robot, self._shelf)
        nodes: Nodes = {}
        for layer, shown in self._made.items():
            for below, drawn in LAYERS[layer](context).items():
                hidden = not shown and "/" not in below
                nodes[below] = replace(drawn, visible=False) if hidden else drawn
        return nodes

    def _mesh_uris(self) -> set[str]:
        made = self._made
        return {
            uri
            for link in self._robot.links.values()
            for uri in mesh_uris(link, collisions="collision" in made)
        }
