"""STL, binary and text, by numpy alone."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING

import numpy as np

from studio.robot.meshes.surfaces import Surface

if TYPE_CHECKING:
    from studio.robot.meshes.files import MeshFiles

_HEADER_BYTES = 84
_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
_VERTEX = re.compile(rb"\bvertex\s+(\S+)\s+(\S+)\s+(\S+)", re.IGNORECASE)


def read_stl(files: MeshFiles) -> list[Surface]:
    """Return one surface without an appearance: STL has no colours that readers agree on.

    Normals of the file are not used, for many exporters write zeros; the corners' order is.

    Raises:
        MeshError: Neither binary nor text, or shorter than its header promises.
    """
    data = files.data
    if len(data) >= _HEADER_BYTES and len(data) >= _HEADER_BYTES + 50 * _declared_count(data):
        if not _is_text(data):
            return [_read_binary(files)]
    elif not _is_text(data):
        declared = _declared_count(data) if len(data) >= _HEADER_BYTES else 0
        raise files.fault(
            f"its header promises {declared} triangles, which its {len(data)} bytes cannot hold: "
            "it is cut off or no STL."
        )
    return [_read_text(files)]


def _declared_count(data: bytes) -> int:
    return int.from_bytes(data[80:84], "little")


def _is_text(data: bytes) -> bool:
    """Binary headers may start with "solid" too, but hold no facets right after."""
    head = data[:4096].lstrip().lower()
    return head.startswith(b"solid") and (b"facet" in head or b"endsolid" in head)


def _read_binary(files: MeshFiles) -> Surface:
    count = _declared_count(files.data)
    files.count_triangles(count)
    records = np.frombuffer(files.data, dtype=_RECORD, count=count, offset=_HEADER_BYTES)
    return Surface(np.ascontiguousarray(records["corners"]).reshape(-1, 3))


def _read_text(files: MeshFiles) -> Surface:
    numbers = _VERTEX.findall(files.data)
    if len(numbers) % 3:
        raise files.fault("a facet of it has not three corners: it is cut off or no STL.")
    files.count_triangles(len(numbers) // 3)
    try:
        with np.errstate(over="ignore"):  # beyond float32 is infinite, and not drawn
            positions = np.array(numbers, dtype=np.float64).astype(np.float32).reshape(-1, 3)
    except ValueError as error:
        raise files.fault("a vertex of it is not three numbers.") from error
    return Surface(positions)
