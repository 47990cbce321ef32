"""The DocumentScene: the 3D view of one open document, shared by all of its pages."""

from __future__ import annotations

from copy import deepcopy
from functools import partial
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.errors import SceneError
from studio.scene import node
from studio.scene.ghost import GhostDrawing
from studio.scene.graph import GRID, Graph, PoseWriter
from studio.scene.host import forget_removed, make_server
from studio.scene.live_scene import LiveScene
from studio.scene.pages import standalone_page
from studio.scene.robot_drawing import RobotDrawing
from studio.scene.seats import BAD_VERSION, SUBPROTOCOL
from studio.tf.rotations import turned

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from studio.robot.meshes.loaded_mesh import LoadedMesh
    from studio.robot.values import Robot, Vector3
    from studio.scene.node import Quaternion
    from studio.scene.seats import Connection

Value: TypeAlias = bool | float | str

DISPLAY_DEFAULTS: dict[str, dict[str, Value]] = {
    "robot": {
        "visual": True,
        "collision": False,
        "frames": False,
        "names": False,
        "axes": False,
        "inertia": False,
        "com": False,
        "opacity": 1.0,
    },
    "grid": {
        "visible": True,
        "cell_m": 0.25,
        "extent_m": 0.0,
        "shadow": True,
        "under_robot": True,
    },
    "ghost": {"visible": False, "beside": False, "opacity": 0.35},
}
"""By display, then setting. `axes` are the joint axes, `com` the centres of mass; a grid of extent
0 is infinite, and one that is not under the robot is at the height of the root link. The ghost is
the robot that this one is compared with; it may be drawn beside it."""

_RANGES: dict[tuple[str, str], tuple[float, float]] = {
    ("robot", "opacity"): (0.0, 1.0),
    ("ghost", "opacity"): (0.05, 1.0),
    ("grid", "cell_m"): (0.001, 1000.0),
    ("grid", "extent_m"): (0.0, 100_000.0),
}
_STEP_M = 1e-5


def checked(display: str, name: str, value: Value) -> Value:
    """Return the value as the display takes it: numbers within their range.

    Raises:
        SceneError: No such display or setting, or a value of another kind.
    """
    default = DISPLAY_DEFAULTS.get(display, {}).get(name)
    if default is None:
        raise SceneError(f'There is no setting "{name}" of a display "{display}".')
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise SceneError(f"{display} {name} is on or off, not {value!r}.")
        return value
    return _within(display, name, value)


def _within(display: str, name: str, value: Value) -> float:
    if isinstance(value, bool | str) or value != value:  # noqa: PLR0124 - NaN is not itself
        raise SceneError(f"{display} {name} is a number, not {value!r}.")
    low, high = _RANGES[display, name]
    return min(max(float(value), low), high)


class DocumentScene:
    """One viser engine, without a port; used on the thread of `loop` only.

    Nothing in it belongs to one person: camera, selection, hover and the visibility of single links
    are in the page.
    """

    def __init__(self, loop: asyncio.AbstractEventLoop) -> None:
        self.viser, self._server = make_server(loop)
        self._graph = Graph(self._server)
        self._poses = PoseWriter(self._graph)
        self._robot = RobotDrawing(self._graph, self._poses.forget)
        self.ghost = GhostDrawing(self._graph, self._robot.mesh)
        """A second robot, to compare; empty until its `show` is called."""
        self.live = LiveScene(self._graph, self._robot.mesh, partial(forget_removed, self.viser))
        """The drawings of the document's displays."""
        self._settings = deepcopy(DISPLAY_DEFAULTS)
        self._height_m = 0.0
        self._root: tuple[Quaternion, Vector3] = (node.NO_TURN, node.ORIGIN)
        self._shown_anew = self._must_settle = False
        self._casts_shadow: bool | None = None
        self._last_poses: tuple[Sequence[str], NDArray[np.floating]] = ((), np.empty((0, 7)))
        self._put_grid()

    def show(
        self, robot: Robot, changed_links: frozenset[str] | None, *, same_meshes: bool = False
    ) -> None:
        """Draw a new state of the robot in one atomic batch.

        Args:
            robot: The whole robot as it is now.
            changed_links: Links whose visuals, collisions, inertial or used materials differ from
                the robot shown before; None when it is not known, which compares all of them.
                Links that came or went and joints that changed are found by themselves. A link
                that came stands at the origin until `set_poses`.
            same_meshes: No link names another mesh than in the robot shown before.
        """
        self._robot.show(robot, changed_links, same_meshes=same_meshes)
        self._shown_anew = True

    def missing_meshes(self) -> set[str]:
        """URIs of meshes to load and `provide`; changes with `show` and `set_display`."""
        robots = self._robot.missing_meshes() | self.ghost.missing_meshes()
        return robots | self.live.missing_meshes()

    def mesh(self, uri: str) -> LoadedMesh | None:
        """Return a loaded mesh of the robot, the ghost or a display."""
        return self._robot.mesh(uri) or self.ghost.mesh(uri) or self.live.mesh(uri)

    def provide_mesh(self, uri: str, mesh: LoadedMesh | None) -> None:
        """Draw a loaded mesh; None marks one that cannot be loaded, drawn as a wire box."""
        self._robot.provide_mesh(uri, mesh)
        self.ghost.provide_mesh(uri, mesh)
        self.live.provide_mesh(uri, mesh)
        self._settle()

    def set_poses(self, link_names: Sequence[str], wxyz_xyz: NDArray[np.floating]) -> None:
        """Move the links that moved, in one atomic batch.

        Args:
            link_names: L names; those not shown are skipped.
            wxyz_xyz: Shape (L, 7): quaternion w, x, y, z, then x, y, z in m, in the root frame.
        """
        self._poses.write(link_names, wxyz_xyz, self._robot.links)
        self._last_poses = (link_names, wxyz_xyz)
        self._must_settle |= self._shown_anew  # a robot that only lifts a leg moves no ground
        self._shown_anew = False

    def place_robot(self, wxyz: Quaternion, position_m: Vector3) -> None:
        """Place the root link of the robot in the fixed frame, and all that is drawn of it.

        The ground stays where it was laid when the fixed frame became another than the root's, or
        it would follow a robot that climbs or flies.
        """
        still = (node.NO_TURN, node.ORIGIN)
        self._must_settle |= (self._root == still) is not ((wxyz, position_m) == still)
        self._root = (wxyz, position_m)
        with self._graph.atomic():
            self._robot.place(wxyz, position_m)
            self.ghost.place(wxyz, position_m)

    def set_display(self, display: str, name: str, value: Value) -> None:
        """Change a setting of a shared display; ask `missing_meshes` afterwards.

        Raises:
            SceneError: No such setting, or a value of the wrong kind.
        """
        value = checked(display, name, value)
        self._settings[display][name] = value
        if display == "grid":
            self._put_grid()
        elif display == "ghost":
            self.ghost.fade(float(self._settings[display]["opacity"]))
        elif name == "opacity":
            self._robot.fade(float(value))
        else:
            self._robot.switch(name, shown=bool(value))

    def displays(self) -> dict[str, dict[str, Value]]:
        """Return all present settings: by display, then name."""
        return deepcopy(self._settings)

    def flush(self) -> None:
        """Send what is queued now instead of with the next window of 1/60 s.

        The ground follows: to find it takes as long as to draw what an edit changed.
        """
        self._server.flush()
        if self._must_settle:
            self._must_settle = False
            self._settle()
            self._server.flush()

    async def serve(
        self,
        connection: Connection,
        allowed: Callable[[str], bool],
        subprotocol: str | None = SUBPROTOCOL,
    ) -> None:
        """Serve viser's page over one accepted websocket until it or the document closes.

        Args:
            connection: The websocket; its socket is closed by the caller.
            allowed: Whether the page may send a message of this type name; a read-only page needs
                VIEWER_MESSAGES.
            subprotocol: What the websocket was accepted with; closed at once when it is not
                SUBPROTOCOL, e.g. for an old page in a browser's cache.
        """
        if subprotocol != SUBPROTOCOL:
            connection.close(BAD_VERSION)
            return
        await self._server.serve(connection, allowed)

    def standalone_page(self, title: str, *, dark: bool) -> Callable[[], bytes]:
        """Record the view; return a function that makes a page of it, in any thread."""
        low, high = self._robot.ground.bounds_m(*self._last_poses)
        centre: list[float] = ((low + high) / 2).tolist()
        size_m = float(np.linalg.norm(high - low))
        wxyz, (x, y, z) = self._root
        dx, dy, dz = turned(wxyz, centre[0], centre[1], centre[2])
        at = (x + dx, y + dy, z + dz)
        return standalone_page(self.viser, title, at, size_m, dark=dark)

    def close(self) -> None:
        """Close all connections and forget everything."""
        self.viser.stop()

    def _settle(self) -> None:
        """Lay the grid under the robot in its pose."""
        height_m = self._robot.ground.height_m(*self._last_poses) + self._root[1][2]
        if abs(height_m - self._height_m) > _STEP_M:
            self._height_m = height_m
            self._put_grid()

    def _put_grid(self) -> None:
        grid = self._settings["grid"]
        shadow = bool(grid["shadow"])
        self._graph.put(
            GRID,
            node.grid(
                float(grid["cell_m"]),
                float(grid["extent_m"]),
                self._height_m if grid["under_robot"] else 0.0,
                shadow=shadow,
                visible=bool(grid["visible"]),
            ),
        )
        if shadow is not self._casts_shadow:
            self._casts_shadow = shadow
            self.viser.scene.configure_default_lights(enabled=True, cast_shadow=shadow)
