"""The LiveScene: what the displays of a document draw, each below a root of its own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.errors import SceneError
from studio.scene import node
from studio.scene.live_display import LiveDisplay
from studio.scene.naming import LIVE
from studio.scene.shapes import Shelves

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.displays.drawing import Drawing
    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.scene.graph import Graph
    from studio.scene.live_display import Poses

GROUPS_MAX: Final = 10_000
SHAPES_MAX: Final = 20_000
_SWEEP_AFTER: Final = 2000
"""Nodes removed: viser keeps a note of each until it is told to look."""


class LiveScene:
    """Applies Drawings: compared by path and by identity, moved in atomic batches.

    Args:
        graph: Where the nodes go.
        known: Gives a mesh that the robot beside it has already.
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
        self._tidy_meshes()

    def place(self, display_id: str, poses: Poses) -> None:
        """Move groups of a display and nothing else; those that are not named stay."""
        if display := self._displays.get(display_id):
            display.place(poses)

    def draw_waiting(self) -> None:
        """Draw one more of the pictures that were too many to be drawn at once; ask every tick."""
        any(display.draw_waiting() for display in self._displays.values())

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
        """A mesh that came; None when it has not, or failed."""
        return self._shelves.meshes.get(uri)

    def _tidy_meshes(self) -> None:
        """Forget meshes that nobody names, and take those that the robot has."""
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
