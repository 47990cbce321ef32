"""A Drawing with a shape of every kind, each in a place of its own."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from studio.displays.drawing import (
    Arrows,
    Axes,
    Frustum,
    GridLines,
    Lines,
    MeshFile,
    Picture,
    Placed,
    Points,
    Shape,
    Solids,
    Text,
    Triangles,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.scene.live_scene import Pose

RED, GREEN, BLUE = (np.array(rgb, np.uint8) for rgb in ((255, 0, 0), (0, 255, 0), (0, 0, 255)))
UPRIGHT: Pose = ((1.0, 0.0, 0.0, 0.0), (0.0, 0.0, 0.0))
MESH_URI = "package://parts/wheel.stl"


def at(x: float, y: float, z: float = 0.0) -> Pose:
    """A pose that is not turned."""
    return UPRIGHT[0], (x, y, z)


def upright(count: int) -> NDArray[np.float32]:
    wxyz = np.zeros((count, 4), np.float32)
    wxyz[:, 0] = 1
    return wxyz


def origin() -> NDArray[np.float32]:
    return np.zeros((1, 3), np.float32)


def solids(kind: str, rgb: NDArray[np.uint8], opacity: float = 1.0) -> Solids:
    """One, 0.6 m in size."""
    scales = np.full((1, 3), 0.6, np.float32)
    return Solids(kind, origin(), upright(1), scales, rgb, opacity)  # pyright: ignore[reportArgumentType]


def segment(a: tuple[float, float, float], b: tuple[float, float, float]) -> NDArray[np.float32]:
    return np.array([[a, b]], np.float32)


def chequered(size: int = 4) -> NDArray[np.uint8]:
    """Red and blue squares; the one at the least x and y is green."""
    pixels = np.zeros((size, size, 4), np.uint8)
    odd = np.indices((size, size)).sum(axis=0) % 2 == 1
    pixels[odd] = (255, 0, 0, 255)
    pixels[~odd] = (0, 0, 255, 255)
    pixels[0, 0] = (0, 255, 0, 255)
    return pixels


def indexed(picture: Picture) -> Picture:
    """The same of a palette, as maps are."""
    rows = picture.pixels.reshape(-1, 4)
    colours, numbers = np.unique(rows, axis=0, return_inverse=True)
    palette = np.zeros((256, 4), np.uint8)
    palette[: len(colours)] = colours
    cells = numbers.reshape(picture.pixels.shape[:2]).astype(np.uint8)
    return replace(picture, pixels=cells, palette=palette)


def every_shape() -> dict[str, Shape]:
    """By name."""
    corners = np.array([[-0.3, -0.3, 0], [0.3, -0.3, 0], [0.3, 0.3, 0], [-0.3, 0.3, 0]])
    corners = corners.astype(np.float32)
    faces = np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
    image = np.zeros((30, 40, 3), np.uint8)
    image[:15], image[15:] = (255, 0, 0), (0, 0, 255)
    across = segment((-0.4, 0, 0), (0.4, 0, 0))
    return {
        "squares": Points(origin(), GREEN, 0.6),
        "faint": Points(origin(), RED, 0.6, opacity=0.5),
        "spheres": Points(origin(), RED, 0.6, "spheres"),
        "boxes": Points(origin(), GREEN, 0.6, "boxes"),
        "hair": Lines(across, RED),
        "wide": Lines(across, GREEN, 0.1),
        "faint-wide": Lines(across, GREEN, 0.2, 0.5),
        "two": Lines(across, np.array([[[255, 0, 0], [0, 0, 255]]], np.uint8), 0.1),
        "arrow": Arrows(across, RED, 0.08, 0.2, 0.3),
        "faint-arrow": Arrows(across, RED, 0.08, 0.2, 0.3, 0.4),
        "short": Arrows(segment((-0.1, 0, 0), (0.1, 0, 0)), BLUE, 0.2, 0.6, 0.4),
        "axes": Axes(origin(), upright(1), 0.4, 0.04),
        "faint-axes": Axes(origin(), upright(1), 0.4, 0.04, 0.3),
        "box": solids("box", RED),
        "sphere": solids("sphere", GREEN),
        "cylinder": solids("cylinder", BLUE, 0.5),
        "cone": solids("cone", RED),
        "triangles": Triangles(corners, faces, GREEN),
        "coloured": Triangles(corners, faces, np.array([RED, RED, BLUE, BLUE])),
        "mesh": MeshFile(MESH_URI, (0.5, 0.5, 0.5), (255, 0, 255)),
        "plate": Text("base_link"),
        "words": Text("Hello", height_m=0.25, rgb=(255, 160, 0)),
        "screen-words": Text("constant", rgb=(0, 200, 255)),
        "picture": Picture(chequered(), (0.8, 0.8), (-0.4, -0.4, 0)),
        "behind": indexed(Picture(chequered(), (0.8, 0.8), (-0.4, -0.4, 0), behind=True)),
        "frustum": Frustum(1.0, 4 / 3, 0.6, image),
        "faint-frustum": Frustum(1.0, 4 / 3, 0.6, image, opacity=0.4),
        "grid": GridLines("xy", 8, 0.1, rgb=(255, 0, 255)),
        "pixels": Points(origin(), BLUE, 0.9, "points", size_px=40),
        "tiles": Points(origin(), GREEN, 0.6, "tiles"),
    }


def places() -> dict[str, Pose]:
    """A field of places, one for each shape, a metre apart in rows of six."""
    return {name: at(index % 6, -(index // 6)) for index, name in enumerate(every_shape())}


def drawing_of(shapes: dict[str, Shape]) -> dict[str, Placed]:
    """Each shape at a path of its own."""
    return {name: Placed("map", 0, {name: shape}) for name, shape in shapes.items()}
