"""Drawings: what a display shows, as plain values in the frames of its messages.

A drawing maps paths to `Placed` groups, and a group maps names to shapes. The scene compares by
identity: it sends a shape only if it is another object than before, so a display keeps the objects
that did not change. Nobody writes into the arrays of a shape once it is drawn.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, Literal, TypeAlias

from studio.robot.meshes.textured import mesh_uris

if TYPE_CHECKING:
    from collections.abc import Mapping

    import numpy as np
    from numpy.typing import NDArray

    from studio.robot.values import Link, Robot

Rgb: TypeAlias = tuple[int, int, int]
"""sRGB, 0 to 255."""
Xyz: TypeAlias = tuple[float, float, float]
"""m."""
Wxyz: TypeAlias = tuple[float, float, float, float]
"""A quaternion of length 1."""
Pose: TypeAlias = tuple[Wxyz, Xyz]
"""Pose of an object in another frame, most often the fixed one."""
NO_TURN: Wxyz = (1.0, 0.0, 0.0, 0.0)
ORIGIN: Xyz = (0.0, 0.0, 0.0)
BODIES_MAX: Final = 20_000
"""More points than this are no boxes or tiles: one costs a hundred times as much as a square."""
Items: TypeAlias = "NDArray[np.intp]"
PointStyle: TypeAlias = Literal["points", "squares", "flat squares", "spheres", "boxes", "tiles"]
"""RViz's names."""
SolidKind: TypeAlias = Literal["box", "sphere", "cylinder", "cone"]
GridPlane: TypeAlias = Literal["xy", "xz", "yz"]
Drawing: TypeAlias = "Mapping[str, Placed]"
"""By path: names with slashes between, unique within the display."""
NOTHING: Drawing = {}


@dataclass(frozen=True, slots=True, eq=False)
class LinkParts:
    """A link of a robot: its visuals, collision shapes, mass and inertia.

    Attributes:
        link: What it is made of.
        robot: Whose link it is: materials are named there.
        visual: Whether its visuals are shown.
        collision: Whether its collision shapes are.
        mass: Whether its mass is, as a ball of lead.
        inertia: Whether its inertia is, as a box.
        opacity: 1 is opaque.
        rgb: Colour of its visuals; None: their own.
    """

    link: Link
    robot: Robot
    visual: bool = True
    collision: bool = False
    mass: bool = False
    inertia: bool = False
    opacity: float = 1.0
    rgb: Rgb | None = None

    def mesh_uris(self) -> frozenset[str]:
        """URIs of the meshes that it is drawn with."""
        drawn = self.link if self.visual else replace(self.link, visuals=())
        return frozenset(mesh_uris(drawn, collisions=self.collision))


def link_frame(link: str, tf_prefix: str) -> str:
    """Return the frame of a link on /tf; as in RViz, a slash separates it from the prefix."""
    prefix = tf_prefix.strip("/")
    return f"{prefix}/{link}" if prefix else link


@dataclass(frozen=True, slots=True, eq=False)
class Points:
    """A cloud.

    Attributes:
        positions: Shape (N, 3), float32, m.
        colors: Shape (N, 3), uint8; or (3,) when all have one.
        size_m: Edge of a square or diameter of a ball.
        style: How each is drawn: squares face the eye, tiles lie in the xy plane.
        opacity: 1 is opaque.
        precise: Whether half precision would be seen: 8 mm at 8 m and more, 62 mm at 64 m.
        size_px: Of "points", on the screen; 0: `size_m` counts.
        size_by_z: Whether the size of each is `size_m` for each metre of its z, as a pixel of a
            depth camera grows with its distance.
        items: Shape (N,): the number by which its display knows what each belongs to; None: its
            row. The same for the other shapes with `items`.
    """

    positions: NDArray[np.float32]
    colors: NDArray[np.uint8]
    size_m: float = 0.01
    style: PointStyle = "flat squares"
    opacity: float = 1.0
    precise: bool = False
    size_px: float = 0.0
    size_by_z: bool = False
    items: Items | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """Straight pieces.

    Attributes:
        ends: Shape (N, 2, 3), float32, m.
        colors: Shape (N, 2, 3), uint8; or (3,) when all have one.
        width_m: Thickness in the scene; 0 is a hair line on the screen.
        opacity: 1 is opaque.
        items: Shape (N,), as those of `Points`.
    """

    ends: NDArray[np.float32]
    colors: NDArray[np.uint8]
    width_m: float = 0.0
    opacity: float = 1.0
    items: Items | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Arrows:
    """Arrows of one thickness.

    Attributes:
        ends: Shape (N, 2, 3), float32, m: tail and tip.
        colors: Shape (N, 3), uint8; or (3,) when all have one.
        shaft_diameter_m: Of the shaft.
        head_diameter_m: Of the head.
        head_length_m: Of the head, which is a part of the whole length.
        opacity: 1 is opaque.
    """

    ends: NDArray[np.float32]
    colors: NDArray[np.uint8]
    shaft_diameter_m: float
    head_diameter_m: float
    head_length_m: float
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Axes:
    """Crosses of red, green and blue along x, y and z.

    Attributes:
        positions: Shape (N, 3), float32, m.
        wxyz: Shape (N, 4), float32.
        length_m: Of each axis.
        radius_m: Of each axis.
        opacity: 1 is opaque.
    """

    positions: NDArray[np.float32]
    wxyz: NDArray[np.float32]
    length_m: float = 1.0
    radius_m: float = 0.1
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Solids:
    """Many of one kind: boxes, balls, cylinders along z, or cones along z that stand on their tip.

    Attributes:
        kind: Each fits into a cube with edges of 1 m around the origin; a cone reaches from its tip
            at the origin to its base, 1 m across, at z = 1.
        positions: Shape (N, 3), float32, m.
        wxyz: Shape (N, 4), float32.
        scales: Shape (N, 3), float32: edges or diameters, m.
        colors: Shape (N, 3), uint8; or (3,) when all have one.
        opacities: Shape (N,), float32; or one for all.
        items: Shape (N,), as those of `Points`.
    """

    kind: SolidKind
    positions: NDArray[np.float32]
    wxyz: NDArray[np.float32]
    scales: NDArray[np.float32]
    colors: NDArray[np.uint8]
    opacities: NDArray[np.float32] | float = 1.0
    items: Items | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """A surface, seen from both sides.

    Attributes:
        vertices: Shape (V, 3), float32, m.
        faces: Shape (F, 3), uint32.
        colors: Shape (V, 3), uint8; or (3,) when all have one.
        opacity: 1 is opaque.
        items: Shape (F,), as those of `Points`.
    """

    vertices: NDArray[np.float32]
    faces: NDArray[np.uint32]
    colors: NDArray[np.uint8]
    opacity: float = 1.0
    items: Items | None = None


@dataclass(frozen=True, slots=True)
class MeshFile:
    """A mesh by its address, `package://` or `file://`; `rgb` None: in its own colours."""

    uri: str
    scale: Xyz = (1.0, 1.0, 1.0)
    rgb: Rgb | None = None
    opacity: float = 1.0
    position: Xyz = ORIGIN
    wxyz: Wxyz = NO_TURN


@dataclass(frozen=True, slots=True)
class Text:
    """Words that always face the camera; `height_m` 0: of constant size on the screen."""

    text: str
    position: Xyz = ORIGIN
    height_m: float = 0.0
    rgb: Rgb = (255, 255, 255)
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class Picture:
    """A flat picture with sharp pixels in the xy plane; its least x and y are at the origin.

    Attributes:
        pixels: Shape (H, W, 4), uint8, RGBA; or (H, W), each the row of its colour in `palette`.
            Row 0 is that of the smallest y, column 0 that of the smallest x.
        size_m: Along x and y.
        position: Of the corner.
        wxyz: How it is turned about the corner.
        behind: Whether everything else is drawn over it.
        palette: Shape (256, 4), uint8, RGBA.
    """

    pixels: NDArray[np.uint8]
    size_m: tuple[float, float]
    position: Xyz = ORIGIN
    wxyz: Wxyz = NO_TURN
    behind: bool = False
    palette: NDArray[np.uint8] | None = None

    @property
    def rgba(self) -> NDArray[np.uint8]:
        """The colours of all pixels, shape (H, W, 4)."""
        return self.pixels if self.palette is None else self.palette[self.pixels]


@dataclass(frozen=True, slots=True, eq=False)
class Frustum:
    """A camera's field of view, along z with x to the right and y down, with its picture.

    Attributes:
        fov_y_rad: Angle of view from top to bottom.
        aspect: Width by height.
        far_m: Distance of the far end, which has the picture.
        image: Shape (H, W, 3), uint8, row 0 on top; None draws the edges alone.
        rgb: Colour of the edges.
        opacity: Opacity of the picture.
    """

    fov_y_rad: float
    aspect: float
    far_m: float
    image: NDArray[np.uint8] | None = None
    rgb: Rgb = (200, 200, 200)
    opacity: float = 1.0


@dataclass(frozen=True, slots=True, eq=False)
class CameraView:
    """The scene as a camera sees it, over its picture; nothing of it is in the scene itself.

    Attributes:
        image: Shape (H, W, 3), uint8, row 0 on top.
        lens: Focal lengths and principal point along x and y as shares of the width and the
            height, and where the eye is beside the frame along its x and y, m; None: unknown.
        rendering: Where the picture is: `background`, `overlay`, or `background and overlay`.
        overlay_alpha: Opacity of the picture in front of the scene.
        zoom: 1 shows all of the picture.
        near_m: What is nearer is not drawn.
        far_m: What is farther away is not drawn.
        hidden: Ids of displays that are not seen in it, and `robot` and `grid`.
    """

    image: NDArray[np.uint8]
    lens: tuple[float, float, float, float, float, float] | None
    rendering: str
    overlay_alpha: float
    zoom: float
    near_m: float
    far_m: float
    hidden: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class GridLines:
    """A grid of lines centred on the origin; `plane` names the two axes that it spans."""

    plane: GridPlane
    cells: int
    cell_m: float
    width_m: float = 0.0
    rgb: Rgb = (160, 160, 164)
    opacity: float = 0.5
    position: Xyz = ORIGIN


Shape: TypeAlias = (
    Points | Lines | Arrows | Axes | Solids | Triangles | MeshFile | Text | Picture | Frustum
    | CameraView | GridLines | LinkParts
)  # fmt: skip


@dataclass(frozen=True, slots=True, eq=False)
class Sweep:
    """When points were measured, if not all at once.

    Attributes:
        until_ns: Time of the last beam, since the epoch; the first was at the stamp.
        shares: Shape (N,), float32: each point's share of that time; 0 at the stamp.
    """

    until_ns: int
    shares: NDArray[np.float32]


@dataclass(frozen=True, slots=True, eq=False)
class Placed:
    """Shapes in one frame at one moment.

    Attributes:
        frame: Its name on /tf, or `properties.FIXED_FRAME`.
        stamp_ns: Time of the pose, since the epoch; 0: the newest known.
        shapes: By name, which has no slashes.
        follows: Whether the shapes move with the frame from now on, as `frame_locked` markers do;
            else they stay in the fixed frame where they were at the stamp.
        turns: Whether the shapes turn with the frame; else they are at its origin, in the axes of
            the fixed frame.
        sweep: For points not all measured at the stamp: each is placed where the frame was at its
            own time.
        offset: Pose of the shapes in the frame; None: they are in its own axes. What only moves
            in its frame is another offset of the same shapes.
    """

    frame: str
    stamp_ns: int
    shapes: Mapping[str, Shape] = field(default_factory=dict[str, Shape])
    follows: bool = False
    turns: bool = True
    sweep: Sweep | None = None
    offset: Pose | None = None
