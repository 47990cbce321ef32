"""What the mesh readers return: corners of triangles and their appearance, in metres, flat."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float32]"
Matrix: TypeAlias = "NDArray[np.float64]"
Rgba: TypeAlias = tuple[float, float, float, float]

COORDINATE_LIMIT_M = 1e9
"""Beyond it areas overflow in float32; no robot is that large."""


@dataclass(frozen=True, slots=True)
class Texture:
    """An image that browsers know; `mime` is image/png or image/jpeg."""

    data: bytes
    mime: str


@dataclass(frozen=True, slots=True)
class Appearance:
    """Material of a surface; colours in sRGB, each component in [0, 1]."""

    rgba: Rgba = (1.0, 1.0, 1.0, 1.0)
    texture: Texture | None = None
    metallic: float = 0.0
    roughness: float = 0.6


@dataclass(frozen=True, slots=True, eq=False)
class Surface:
    """Triangles as a list of corners, three rows for each; nothing is shared yet."""

    positions: Floats
    """Shape (3 M, 3), metres."""
    normals: Floats | None = None
    """Shape (3 M, 3); None: the file has none."""
    uv: Floats | None = None
    """Shape (3 M, 2), v upwards from the lower edge of the image, as in COLLADA and OBJ."""
    colors: NDArray[np.uint8] | None = None
    """Shape (3 M, 4), sRGB with alpha."""
    appearance: Appearance | None = None
    """None: the file gives no colour, the URDF material does."""

    @property
    def triangle_count(self) -> int:
        """The number of triangles, M."""
        return len(self.positions) // 3

    def moved(self, world_from_surface: Matrix) -> Surface:
        """Return the same triangles in another frame; a mirror image keeps its outside outside."""
        if np.array_equal(world_from_surface, np.eye(4)):
            return self
        linear = world_from_surface[:3, :3]
        with np.errstate(over="ignore", invalid="ignore"):  # too far away is not drawn
            positions = self.positions @ linear.T.astype(np.float32)
            positions += world_from_surface[:3, 3].astype(np.float32)
        moved = dataclasses.replace(
            self, positions=positions, normals=_moved_normals(self.normals, linear)
        )
        return moved.flipped() if np.linalg.det(linear) < 0 else moved

    def flipped(self) -> Surface:
        """Return it with the corners of each triangle in reverse order."""
        return self.chosen(np.arange(len(self.positions)).reshape(-1, 3)[:, ::-1].ravel())

    def drawable(self) -> Surface:
        """Without triangles that have corners at NaN, infinity or absurdly far away."""
        near = np.abs(self.positions) < COORDINATE_LIMIT_M  # False for NaN
        if near.all():
            return self
        keep = near.reshape(-1, 9).all(axis=1)
        return self.chosen(np.flatnonzero(np.repeat(keep, 3)))

    def chosen(self, corners: NDArray[np.intp]) -> Surface:
        """These corners, in this order."""
        return dataclasses.replace(
            self,
            positions=self.positions[corners],
            normals=None if self.normals is None else self.normals[corners],
            uv=None if self.uv is None else self.uv[corners],
            colors=None if self.colors is None else self.colors[corners],
        )


def bounds(points: Floats) -> tuple[list[float], list[float]]:
    """Least and greatest corner of points (N, 3), N > 0; by columns, as numpy is slow by rows."""
    return [float(one.min()) for one in points.T], [float(one.max()) for one in points.T]


def _moved_normals(normals: Floats | None, linear: Matrix) -> Floats | None:
    """Normals go by the inverse transpose; a flattening transform leaves none to keep."""
    if normals is None or abs(np.linalg.det(linear)) < 1e-30:
        return None
    turned: Floats = normals @ np.linalg.inv(linear).astype(np.float32)
    lengths = np.linalg.norm(turned, axis=1, keepdims=True)
    return (turned / np.where(lengths > 0, lengths, 1.0)).astype(np.float32)


def linear_from_srgb(component: float) -> float:
    """Return one component in [0, 1]; formulas of IEC 61966-2-1."""
    return component / 12.92 if component <= 0.04045 else ((component + 0.055) / 1.055) ** 2.4


def srgb_from_linear(component: float) -> float:
    """Undo `linear_from_srgb`; beyond [0, 1] it is cut off."""
    cut = min(1.0, max(0.0, component))
    return 12.92 * cut if cut <= 0.0031308 else 1.055 * cut ** (1 / 2.4) - 0.055


_LINEAR = np.array([round(65535 * linear_from_srgb(n / 255)) for n in range(256)], dtype=np.uint16)


def linear_shorts(rgba: NDArray[np.uint8]) -> NDArray[np.uint16]:
    """Linear colours of full range from sRGB bytes, (N, 4); alpha only widens."""
    shorts = _LINEAR[rgba]
    shorts[:, 3] = rgba[:, 3].astype(np.uint16) * 257
    return shorts


def srgb_bytes(linear_rgba: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Bytes (N, 4) from linear colours (N, 3 or 4) in [0, 1]; NaN is black."""
    cut = np.nan_to_num(linear_rgba[:, :3]).clip(0.0, 1.0).astype(np.float64)
    srgb = np.where(cut <= 0.0031308, 12.92 * cut, 1.055 * cut ** (1 / 2.4) - 0.055)
    alpha = linear_rgba[:, 3:4] if linear_rgba.shape[1] > 3 else np.ones((len(cut), 1))
    whole = np.concatenate((srgb, np.nan_to_num(alpha).clip(0.0, 1.0)), axis=1)
    return np.round(whole * 255).astype(np.uint8)
