"""The PoseWriter: poses of all links at once, of which only those that moved are sent."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from studio.scene.naming import link_node

if TYPE_CHECKING:
    from collections.abc import Callable, Container, Sequence

    from numpy.typing import NDArray

    from studio.scene.graph import Graph

STEP = 1e-6
"""Absolute: metres, and parts of a unit quaternion; a smaller move is none."""


class PoseWriter:
    """Remembers what was sent last for each link; `forget` what was removed or made anew."""

    def __init__(self, graph: Graph, node_of: Callable[[str], str] = link_node) -> None:
        self._graph, self._node_of = graph, node_of
        self._names: tuple[str, ...] = ()
        self._nodes: tuple[str, ...] = ()
        self._sent = np.full((0, 7), np.nan)

    def write(
        self,
        link_names: Sequence[str],
        wxyz_xyz: NDArray[np.floating],
        drawn: Container[str],
    ) -> None:
        """Send one atomic batch with the links that moved.

        Args:
            link_names: L names.
            wxyz_xyz: Shape (L, 7): quaternion w, x, y, z, then x, y, z in metres, in the root
                frame. Rows that are not finite are left where they were.
            drawn: The links that stand in the scene; others are skipped.
        """
        poses = np.asarray(wxyz_xyz, dtype=np.float64)
        if self._names != link_names:
            self._rename(tuple(link_names))
        near: NDArray[np.bool_] = np.abs(poses - self._sent) <= STEP  # NaN, never sent, is not
        far = np.logical_not(near) & np.isfinite(poses).all(axis=1, keepdims=True)
        rows: list[int] = np.flatnonzero(far.any(axis=1)).tolist()
        if not rows:
            return
        turned: NDArray[np.bool_] = np.logical_or.reduce(far[:, :4], axis=1)
        shifted: NDArray[np.bool_] = np.logical_or.reduce(far[:, 4:], axis=1)
        how = zip(turned[rows].tolist(), shifted[rows].tolist(), strict=True)
        with self._graph.atomic():
            for row, pose, (turns, shifts) in zip(rows, poses[rows].tolist(), how, strict=True):
                if self._names[row] in drawn:
                    self._send(self._nodes[row], pose, turns=turns, shifts=shifts)
                    # What was not sent is not forgotten, or many small moves would be lost.
                    part = slice(0 if turns else 4, 7 if shifts else 4)
                    self._sent[row, part] = pose[part]

    def _send(self, node: str, pose: list[float], *, turns: bool, shifts: bool) -> None:
        w, qx, qy, qz, x, y, z = pose
        if turns:
            self._graph.turn(node, (w, qx, qy, qz))
        if shifts:
            self._graph.shift(node, (x, y, z))

    def forget(self, link: str) -> None:
        """Send the pose of this link again next time."""
        if link in self._names:
            self._sent[self._names.index(link)] = np.nan

    def _rename(self, names: tuple[str, ...]) -> None:
        """Keep what was sent for the links that stay."""
        last = dict(zip(self._names, self._sent, strict=True))
        unknown = np.full(7, np.nan)
        self._names = names
        self._nodes = tuple(self._node_of(name) for name in names)
        self._sent = np.array([last.get(name, unknown) for name in names]).reshape(-1, 7)
