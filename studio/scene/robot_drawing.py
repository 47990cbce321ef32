"""The RobotDrawing: a robot link by link, of which only what changed is sent."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from studio.robot.meshes.textured import mesh_uris
from studio.robot.values import Robot
from studio.scene import node
from studio.scene.geometry_drawing import MeshShelf
from studio.scene.ground import Ground
from studio.scene.layers import LAYERS, LinkContext
from studio.scene.naming import ROBOT, link_node

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Set

    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import Joint, Link, Vector3
    from studio.scene.graph import Graph
    from studio.scene.layers import Nodes
    from studio.scene.node import Quaternion


class RobotDrawing:
    """Draws the links flat below `/robot`; their poses are not its business.

    A layer is made when it is first switched on and hidden, not removed, when switched off.

    Args:
        graph: Where the nodes go.
        moved: Told of each link whose node was made or removed, so that its pose is sent again.
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
        """Links that stand in the scene."""
        return self._drawn.keys()

    def show(self, robot: Robot, changed_links: frozenset[str] | None) -> None:
        """Draw a new state of the robot; see `DocumentScene.show`."""
        joint_of = {joint.child: joint for joint in robot.joints.values()}
        changed = self._changed(robot, joint_of, changed_links)
        self._robot, self._joint_of = robot, joint_of
        self._shelf.keep_only(self._mesh_uris())
        with self._graph.atomic():
            for link in tuple(self._drawn):
                if link not in robot.links:
                    self._remove(link)
            for link in changed:
                self._draw(robot.links[link])

    def missing_meshes(self) -> set[str]:
        """URIs that the layers made so far need and that have not come."""
        return {uri for uri in self._mesh_uris() if uri not in self._shelf}

    def mesh(self, uri: str) -> LoadedMesh | None:
        """A mesh that came; None when it has not, or failed."""
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
        """The links to draw, in the robot's order: asked for, new, or moved by another joint."""
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
