"""FrameLook: frames as RViz draws them: crosses, arrows to their parents, names; old ones fade."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from studio.displays.drawing import Axes, Rgb, Solids, Text
from studio.displays.turning import turned

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.turning import Floats

# At a scale of 1, m.
_AXIS_LENGTH_M: Final = 0.2
_AXIS_RADIUS_M: Final = 0.01
_SHAFT_M: Final = 0.01
_HEAD_M: Final = 0.04
_HEAD_LENGTH_M: Final = 0.1
_NEAR_M: Final = 0.001
"""Parents that are nearer have no arrow."""

_RED_GREEN_BLUE: Final = np.array([[255, 0, 0], [0, 255, 0], [0, 0, 255]], np.float64)
_SHAFT: Final = np.array([204, 204, 76], np.float64)
_HEAD: Final = np.array([255, 26, 153], np.float64)
_WHITE: Final = np.array([255, 255, 255], np.float64)
_GREY: Final = np.array([179, 179, 179], np.float64)
_HALF: Final = 0.5**0.5
_ALONG_AXES: Final = np.array(
    [[_HALF, 0.0, _HALF, 0.0], [_HALF, -_HALF, 0.0, 0.0], [1.0, 0.0, 0.0, 0.0]]
)
"""Turns of z onto x, y and z."""


class Shades(NamedTuple):
    """How far N frames have faded.

    Attributes:
        grey: Shape (N,): 0 has its colours, 1 is grey.
        opacity: Shape (N,).
    """

    grey: Floats
    opacity: Floats

    @property
    def fresh(self) -> NDArray[np.bool_]:
        """Which have not faded at all."""
        return self.grey == 0.0

    def of(self, chosen: NDArray[np.bool_]) -> Shades:
        """Those of some."""
        return Shades(self.grey[chosen], self.opacity[chosen])


def shades_of(ages_s: Floats, timeout_s: float, steps: int = 32) -> Shades:
    """RViz's fading: a third of the time as they are, a third to grey, and a third to nothing.

    It goes in steps, so that what fades slowly is not drawn anew all the time.
    """
    thirds = ages_s * 3.0 / timeout_s
    grey = np.round((thirds - 1.0).clip(0.0, 1.0) * steps) / steps
    opacity = np.round((3.0 - thirds).clip(0.0, 1.0) * steps) / steps
    return Shades(grey, opacity)


def fresh_axes(poses: Floats, scale: float, alpha: float) -> Axes:
    """Crosses at poses (N, 7) of frames that have not faded."""
    return Axes(
        poses[:, 4:].astype(np.float32),
        poses[:, :4].astype(np.float32),
        _AXIS_LENGTH_M * scale,
        _AXIS_RADIUS_M * scale,
        alpha,
    )


def faded_axes(poses: Floats, shades: Shades, scale: float, alpha: float) -> Solids:
    """Crosses at poses (N, 7), each axis a cylinder with a colour of its own."""
    count = len(poses)
    turns = np.repeat(poses[:, :4], 3, axis=0)
    wxyz = _products(turns, np.tile(_ALONG_AXES, (count, 1)))
    middles = turned(wxyz, np.array([0.0, 0.0, _AXIS_LENGTH_M * scale / 2]))
    thick, long = 2 * _AXIS_RADIUS_M * scale, _AXIS_LENGTH_M * scale
    grey = np.repeat(shades.grey, 3)
    return Solids(
        "cylinder",
        (np.repeat(poses[:, 4:], 3, axis=0) + middles).astype(np.float32),
        wxyz.astype(np.float32),
        np.tile(np.array([thick, thick, long], np.float32), (3 * count, 1)),
        _greyed(np.tile(_RED_GREEN_BLUE, (count, 1)), grey),
        _opacities(np.repeat(shades.opacity, 3), alpha),
    )


def arrows_to_parents(
    children: Floats, parents: Floats, shades: Shades, scale: float, alpha: float
) -> dict[str, Solids]:
    """Shafts and heads of arrows from places (N, 3) of children to those of their parents."""
    ways = parents - children
    lengths = np.sqrt(np.einsum("ij,ij->i", ways, ways))
    far = lengths > _NEAR_M
    if not far.any():
        return {}
    shades, children, lengths = shades.of(far), children[far], lengths[far]
    along = ways[far] / lengths[:, None]
    heads, shafts = _parts_of_arrows(lengths, _HEAD_LENGTH_M * scale)
    opacities = _opacities(shades.opacity, alpha)
    shaft = Solids(
        "cylinder",
        (children + along * (shafts / 2)[:, None]).astype(np.float32),
        _turns_of_z(along),
        _sizes(_SHAFT_M * scale, shafts),
        _greyed(np.tile(_SHAFT, (len(along), 1)), shades.grey),
        opacities,
    )
    # A cone stands on its tip, so it opens from the parent back to the child.
    head = Solids(
        "cone",
        (children + along * lengths[:, None]).astype(np.float32),
        _turns_of_z(-along),
        _sizes(_HEAD_M * scale, heads),
        _greyed(np.tile(_HEAD, (len(along), 1)), shades.grey),
        opacities,
    )
    return {"shafts": shaft, "heads": head}


def _parts_of_arrows(lengths_m: Floats, head_m: float) -> tuple[Floats, Floats]:
    """Lengths of heads and shafts: short arrows have shorter heads, as RViz draws them."""
    heads_m: Floats = np.where(lengths_m < head_m, head_m * lengths_m, head_m)
    heads_m = np.minimum(heads_m, lengths_m)
    return heads_m, lengths_m - heads_m


def name_of(name: str, grey: float, opacity: float, height_m: float) -> Text:
    """The name of a frame, at its origin; of height 0 it has one size on the screen."""
    red, green, blue = (_WHITE + grey * (_GREY - _WHITE)).astype(int).tolist()
    rgb: Rgb = (red, green, blue)
    return Text(name, height_m=height_m, rgb=rgb, opacity=opacity)


def _greyed(colors: Floats, grey: Floats) -> NDArray[np.uint8]:
    return (colors + grey[:, None] * (_GREY - colors)).astype(np.uint8)


def _opacities(opacities: Floats, alpha: float) -> NDArray[np.float32] | float:
    return alpha if (opacities == 1.0).all() else (opacities * alpha).astype(np.float32)


def _sizes(thick_m: float, lengths_m: Floats) -> NDArray[np.float32]:
    sizes = np.full((len(lengths_m), 3), thick_m, np.float32)
    sizes[:, 2] = lengths_m
    return sizes


def _turns_of_z(directions: Floats) -> NDArray[np.float32]:
    """Unit quaternions (N, 4) that turn z onto directions (N, 3) on the shortest way."""
    x, y, z = directions.T
    turns = np.stack([1.0 + z, -y, x, np.zeros_like(z)], axis=1)
    turns[z < -1.0 + 1e-9] = (0.0, 1.0, 0.0, 0.0)
    return (turns / np.linalg.norm(turns, axis=1)[:, None]).astype(np.float32)


def _products(first: Floats, second: Floats) -> Floats:
    """Quaternions (N, 4): the turn `second`, then `first`."""
    w, v = first[:, :1], first[:, 1:]
    ow, ov = second[:, :1], second[:, 1:]
    real = w * ow - np.einsum("ij,ij->i", v, ov)[:, None]
    return np.concatenate([real, w * ov + ow * v + np.cross(v, ov)], axis=1)
