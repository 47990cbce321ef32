"""Colours as screens are told them (sRGB) and as light adds up (linear, what glTF wants)."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


def linear_from_srgb(component: float) -> float:
    """One component in [0, 1]; formulas of IEC 61966-2-1."""
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
