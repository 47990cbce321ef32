"""The GhostDrawing: another robot, see-through and in one colour, over the one that is edited."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.robot.meshes.textured import mesh_uris
from studio.robot.values import Mesh, Robot
from studio.scene import node
from studio.scene.graph import GHOST, PoseWriter, ghost_node
from studio.scene.link_nodes import MeshShelf, geometry_node
from studio.scene.node import Style
from studio.tf.rotations import turned

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence, Set

    import numpy as np
    from numpy.typing import NDArray

    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import Link, Vector3
    from studio.scene.graph import Graph
    from studio.scene.link_nodes import Nodes
    from studio.scene.node import Node, Quaternion, Rgb

GHOST_RGB: Rgb = (178, 108, 255)


class GhostDrawing:
    """Draws the visuals of a robot below `/ghost`; they cannot be clicked and throw no shadow.

    Args:
        graph: Where the nodes go.
        known: Returns a mesh that the robot beside it has already.
    """

    def __init__(self, graph: Graph, known: Callable[[str], LoadedMesh | None]) -> None:
        self._graph, self._known = graph, known
        self._robot = Robot("")
        self._shelf = MeshShelf()
        self._drawn: dict[str, Nodes] = {}
        self._hidden: frozenset[str] = frozenset()
        self._poses = PoseWriter(graph, ghost_node)
        self._opacity = 0.35
        self._offset_m: Vector3 = node.ORIGIN
        self._root_pose: tuple[Quaternion, Vector3] = (node.NO_TURN, node.ORIGIN)

    @property
    def links(self) -> Set[str]:
        """Links that are in the scene."""
        return self._drawn.keys()

    def show(self, robot: Robot) -> None:
        """Draw another state of the ghost; a robot without links takes it away."""
        before, self._robot = self._robot, robot
        uris = self._mesh_uris()
        self._shelf.keep_only(uris)
        for uri in uris:
            if uri not in self._shelf and (mesh := self._known(uri)) is not None:
                self._shelf.put(uri, mesh)
        with self._graph.atomic():
            for link in tuple(self._drawn):
                if link not in robot.links:
                    self._remove(link)
            if not robot.links:
                self._graph.drop(GHOST)
                return
            self._put_root()
            for name, link in robot.links.items():
                if before.links.get(name) is not link or name not in self._drawn:
                    self._draw(link)

    def set_poses(self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]) -> None:
        """Move the links, as `DocumentScene.set_poses`, in the frame of the ghost's root."""
        self._poses.write(link_names, wxyz_xyz, self._drawn)

    def hide(self, links: Set[str]) -> None:
        """Do not show these links, and all others."""
        changed = (links ^ self._hidden) & self._drawn.keys()
        self._hidden = frozenset(links)
        with self._graph.atomic():
            for name in changed:
                self._put_link(name)

    def shift(self, offset_m: Vector3) -> None:
        """Stand that far from the robot, in its root frame."""
        self._offset_m = offset_m
        if self._drawn:
            self._put_root()

    def place(self, wxyz: Quaternion, position_m: Vector3) -> None:
        """Stand beside a robot whose root link is there in the fixed frame."""
        self._root_pose = (wxyz, position_m)
        if self._drawn:
            self._put_root()

    def fade(self, opacity: float) -> None:
        """Set the opacity."""
        self._opacity = opacity
        with self._graph.atomic():
            for link in self._robot.links.values():
                self._draw(link)

    def mesh(self, uri: str) -> LoadedMesh | None:
        """Return a loaded mesh; None when it is not loaded yet, or failed."""
        return self._shelf.get(uri)

    def missing_meshes(self) -> set[str]:
        """Return the URIs of meshes that it needs and that are not loaded."""
        return {uri for uri in self._mesh_uris() if uri not in self._shelf}

    def provide_mesh(self, uri: str, mesh: LoadedMesh | None) -> None:
        """Draw a mesh wherever it is named."""
        if uri not in self._mesh_uris() or not self._shelf.put(uri, mesh):
            return
        with self._graph.atomic():
            for link in self._robot.links.values():
                if uri in mesh_uris(link):
                    self._draw(link)

    def _put_root(self) -> None:
        wxyz, (x, y, z) = self._root_pose
        dx, dy, dz = turned(wxyz, *self._offset_m)
        self._graph.put(GHOST, node.group(wxyz, (x + dx, y + dy, z + dz)))

    def _put_link(self, name: str) -> None:
        self._graph.put(ghost_node(name), node.group(visible=name not in self._hidden))

    def _draw(self, link: Link) -> None:
        root = ghost_node(link.name)
        old, new = self._drawn.get(link.name), self._nodes(link)
        for below in old or {}:
            if below not in new:
                self._graph.drop(f"{root}/{below}")
        if old is None:
            self._put_link(link.name)
            self._poses.forget(link.name)
        for below, drawn in new.items():
            self._graph.put(f"{root}/{below}", drawn)
        self._drawn[link.name] = new

    def _remove(self, link: str) -> None:
        root = ghost_node(link)
        for below in self._drawn.pop(link):
            self._graph.drop(f"{root}/{below}")
        self._graph.drop(root)
        self._poses.forget(link)

    def _nodes(self, link: Link) -> Nodes:
        style = Style(GHOST_RGB, self._opacity, shadow=False)
        nodes: Nodes = {}
        for index, visual in enumerate(link.visuals):
            geometry = visual.geometry
            if isinstance(geometry, Mesh) and self._shelf.get(geometry.uri) is None:
                continue  # the robot beside it has the sign for a missing one
            drawn = geometry_node(geometry, visual.origin, style, self._shelf, own_colors=False)
            if drawn is not None:
                nodes[str(index)] = _one_sided(drawn)
        return nodes

    def _mesh_uris(self) -> set[str]:
        return {
            visual.geometry.uri
            for link in self._robot.links.values()
            for visual in link.visuals
            if isinstance(visual.geometry, Mesh)
        }


def _one_sided(drawn: Node) -> Node:
    """Return the node without back faces, which would show through like a second surface."""
    return replace(drawn, props={**drawn.props, "side": "front"})
