"""What stands where in the 3D view of a page: poses of nodes, and points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray
    from playwright.sync_api import Page

_POSES = """(root) => {
  const { nodeRefFromName } = document.querySelector("iframe").contentWindow.__viserMutable;
  const found = {};
  for (const [name, node] of Object.entries(nodeRefFromName)) {
    const below = name.slice(root.length);
    if (!node?.visible || !name.startsWith(root) || below.includes("/")) continue;
    const { x, y, z, w } = node.quaternion;
    found[below] = [...node.position.toArray(), w, x, y, z];
  }
  return found;
}"""
"""Position and quaternion of all that is seen right below a node, at one moment."""
_POINTS = """(root) => {
  const { nodeRefFromName } = document.querySelector("iframe").contentWindow.__viserMutable;
  const found = [];
  nodeRefFromName["/live"].updateWorldMatrix(true, true);
  const fixed = nodeRefFromName["/live"].matrixWorld.clone().invert();
  nodeRefFromName[root]?.traverse((object) => {
    if (!object.isPoints) return;
    const { position } = object.geometry.attributes;
    const place = object.position.clone();
    for (let at = 0; at < position.count; at += 1) {
      place.set(position.getX(at), position.getY(at), position.getZ(at));
      found.push(place.applyMatrix4(object.matrixWorld).applyMatrix4(fixed).toArray());
    }
  });
  return found;
}"""
"""All points below a node, in the fixed frame."""


def poses_below(page: Page, root: str) -> dict[str, NDArray[np.float64]]:
    """x, y, z in m and w, x, y, z of each node that is seen there, by its name."""
    found: dict[str, list[float]] = page.evaluate(_POSES, f"{root}/")
    return {name: np.array(pose) for name, pose in found.items()}


def points_below(page: Page, root: str) -> NDArray[np.float64]:
    """Shape (N, 3), m."""
    return np.array(page.evaluate(_POINTS, root), np.float64).reshape(-1, 3)
