"""Closed solids as triangles, and the three mesh formats they are written in.

A solid is an array of shape (N, 3, 3): N triangles, three corners, x y z in metres, corners
counter-clockwise seen from outside. What is written depends on the input alone, to the byte.
"""

from __future__ import annotations

import json
import math
import struct
from collections import defaultdict
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

Solid: TypeAlias = "NDArray[np.float64]"
Colour: TypeAlias = tuple[float, float, float]

_CREASE_COSINE = math.cos(math.radians(40.0))


def loft(rings: Sequence[NDArray[np.float64]]) -> Solid:
    """Skin rings of equally many points, each counter-clockwise seen from +z, from low to high."""
    triangles: list[NDArray[np.float64]] = []
    for low, high in pairwise(rings):
        for here in range(len(low)):
            there = (here + 1) % len(low)
            triangles.append(np.array([low[here], low[there], high[there]]))
            triangles.append(np.array([low[here], high[there], high[here]]))
    return np.concatenate([_lid(rings[0][::-1]), np.array(triangles), _lid(rings[-1])])


def _lid(ring: NDArray[np.float64]) -> Solid:
    """Close a convex ring by a fan about its first corner."""
    return np.array([[ring[0], ring[n], ring[n + 1]] for n in range(1, len(ring) - 1)])


def ring(radius: float, z: float, corners: int) -> NDArray[np.float64]:
    """A circle about z as a polygon."""
    turns = np.arange(corners) * (2 * math.pi / corners)
    return np.column_stack([radius * np.cos(turns), radius * np.sin(turns), np.full(corners, z)])


def turned(profile: Sequence[tuple[float, float]], corners: int = 36) -> Solid:
    """Turn a profile of (radius, z) points, z rising, about z."""
    return loft([ring(radius, z, corners) for radius, z in profile])


def rounded_rectangle(size: tuple[float, float], cut: float, z: float) -> NDArray[np.float64]:
    """A rectangle about z whose four corners are cut off by `cut`."""
    x, y = size[0] / 2, size[1] / 2
    corners = [
        (x, -y + cut),
        (x, y - cut),
        (x - cut, y),
        (-x + cut, y),
        (-x, y - cut),
        (-x, -y + cut),
        (-x + cut, -y),
        (x - cut, -y),
    ]
    return np.array([(a, b, z) for a, b in corners])


def box(low: tuple[float, float, float], high: tuple[float, float, float]) -> Solid:
    """An upright box between two corners."""
    (x0, y0, z0), (x1, y1, z1) = low, high
    base = np.array([(x0, y0, z0), (x1, y0, z0), (x1, y1, z0), (x0, y1, z0)])
    return loft([base, base + np.array([0, 0, z1 - z0])])


def placed(
    solid: Solid,
    xyz: tuple[float, float, float] = (0, 0, 0),
    rpy: tuple[float, float, float] = (0, 0, 0),
) -> Solid:
    """Turn a solid by fixed-axis roll, pitch, yaw, then move it."""
    (cr, cp, cy), (sr, sp, sy) = np.cos(rpy), np.sin(rpy)
    about_x = np.array([[1, 0, 0], [0, cr, -sr], [0, sr, cr]])
    about_y = np.array([[cp, 0, sp], [0, 1, 0], [-sp, 0, cp]])
    about_z = np.array([[cy, -sy, 0], [sy, cy, 0], [0, 0, 1]])
    return solid @ (about_z @ about_y @ about_x).T + np.array(xyz)


@dataclass(frozen=True, slots=True)
class Painted:
    """A solid in one colour, RGB in [0, 1]."""

    name: str
    solid: Solid
    colour: Colour


def write_stl(path: Path, solid: Solid) -> None:
    """Binary STL with facet normals."""
    corners = solid.astype("<f4")
    records = np.zeros(
        len(corners), dtype=[("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("rest", "<u2")]
    )
    records["normal"] = np.round(_facet_normals(solid), 6)
    records["corners"] = corners
    header = b"written by tests/support/model_meshes.py".ljust(80)
    path.write_bytes(header + struct.pack("<I", len(corners)) + records.tobytes())


def write_dae(path: Path, parts: Sequence[Painted]) -> None:
    """COLLADA 1.4.1 in metres, z up, one geometry and one Phong material per part."""
    body = "\n".join(
        [
            '<?xml version="1.0" encoding="utf-8"?>',
            '<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">',
            "<asset><created>2026-01-01T00:00:00Z</created><modified>2026-01-01T00:00:00Z</modified>"
            '<unit name="meter" meter="1"/><up_axis>Z_UP</up_axis></asset>',
            "<library_effects>",
            *(_dae_effect(part) for part in parts),
            "</library_effects>",
            "<library_materials>",
            *(
                f'<material id="{part.name}-material">'
                f'<instance_effect url="#{part.name}-effect"/></material>'
                for part in parts
            ),
            "</library_materials>",
            "<library_geometries>",
            *(_dae_geometry(part) for part in parts),
            "</library_geometries>",
            '<library_visual_scenes><visual_scene id="scene">',
            *(_dae_node(part) for part in parts),
            "</visual_scene></library_visual_scenes>",
            '<scene><instance_visual_scene url="#scene"/></scene>',
            "</COLLADA>\n",
        ]
    )
    path.write_text(body, encoding="utf-8", newline="\n")


def write_glb(path: Path, parts: Sequence[Painted]) -> None:
    """Binary glTF 2.0, one primitive and one material per part, axes as given (URDF's)."""
    buffer = bytearray()
    accessors: list[dict[str, object]] = []
    views: list[dict[str, object]] = []
    primitives: list[dict[str, object]] = []
    for number, part in enumerate(parts):
        points, normals, indices = _indexed(part.solid)
        for array, kind, target in (
            (points, "VEC3", 34962),
            (normals, "VEC3", 34962),
            (indices, "SCALAR", 34963),
        ):
            views.append(
                {
                    "buffer": 0,
                    "byteOffset": len(buffer),
                    "byteLength": array.nbytes,
                    "target": target,
                }
            )
            accessors.append(
                {
                    "bufferView": len(views) - 1,
                    "componentType": 5125 if kind == "SCALAR" else 5126,
                    "count": len(array),
                    "type": kind,
                }
            )
            buffer += array.tobytes()
        accessors[-3] |= {"min": points.min(0).tolist(), "max": points.max(0).tolist()}
        first = len(accessors) - 3
        primitives.append(
            {
                "attributes": {"POSITION": first, "NORMAL": first + 1},
                "indices": first + 2,
                "material": number,
            }
        )
    document = {
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": primitives}],
        "materials": [_gltf_material(part) for part in parts],
        "accessors": accessors,
        "bufferViews": views,
        "buffers": [{"byteLength": len(buffer)}],
    }
    path.write_bytes(_glb_container(json.dumps(document, separators=(",", ":")), bytes(buffer)))


def _gltf_material(part: Painted) -> dict[str, object]:
    return {
        "name": part.name,
        "pbrMetallicRoughness": {
            "baseColorFactor": [*part.colour, 1.0],
            "metallicFactor": 0.0,
            "roughnessFactor": 0.6,
        },
    }


def _glb_container(text: str, buffer: bytes) -> bytes:
    """Header and two chunks, each padded to 4 bytes (spaces for JSON, zeros for the buffer)."""
    head = text.encode()
    head += b" " * (-len(head) % 4)
    buffer += bytes(-len(buffer) % 4)
    chunks = struct.pack("<I4s", len(head), b"JSON") + head
    chunks += struct.pack("<I4s", len(buffer), b"BIN\0") + buffer
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


def _facet_normals(solid: Solid) -> NDArray[np.float64]:
    """Unit normals of shape (N, 3)."""
    crossed = np.cross(solid[:, 1] - solid[:, 0], solid[:, 2] - solid[:, 0])
    return crossed / np.maximum(np.linalg.norm(crossed, axis=1, keepdims=True), 1e-12)


def _corner_normals(solid: Solid) -> NDArray[np.float64]:
    """Normals of shape (N, 3, 3): facets that meet at less than the crease angle are smoothed."""
    facets = _facet_normals(solid)
    around: defaultdict[tuple[float, ...], list[int]] = defaultdict(list)
    keys = [[tuple(point) for point in triangle] for triangle in np.round(solid, 6).tolist()]
    for index, triangle in enumerate(keys):
        for key in triangle:
            around[key].append(index)
    normals = np.empty_like(solid)
    for index, triangle in enumerate(keys):
        for corner, key in enumerate(triangle):
            near = facets[around[key]]
            normals[index, corner] = near[near @ facets[index] > _CREASE_COSINE].sum(axis=0)
    return normals / np.linalg.norm(normals, axis=2, keepdims=True)


def _indexed(
    solid: Solid,
) -> tuple[NDArray[np.float32], NDArray[np.float32], NDArray[np.uint32]]:
    """Points, normals and indices, equal corners shared; in the order of first use."""
    rows = np.round(np.concatenate([solid, _corner_normals(solid)], axis=2).reshape(-1, 6), 5) + 0.0
    numbers: dict[tuple[float, ...], int] = {}
    indices = [numbers.setdefault(tuple(row), len(numbers)) for row in rows.tolist()]
    unique = np.array(list(numbers), dtype="<f4")
    return (
        np.ascontiguousarray(unique[:, :3]),
        np.ascontiguousarray(unique[:, 3:]),
        np.array(indices, dtype="<u4"),
    )


def _dae_effect(part: Painted) -> str:
    colour = " ".join(f"{channel:g}" for channel in part.colour)
    return (
        f'<effect id="{part.name}-effect"><profile_COMMON><technique sid="common"><phong>'
        f"<diffuse><color>{colour} 1</color></diffuse>"
        "<specular><color>0.1 0.1 0.1 1</color></specular><shininess><float>20</float></shininess>"
        "</phong></technique></profile_COMMON></effect>"
    )


def _dae_geometry(part: Painted) -> str:
    points, normals, indices = _indexed(part.solid)
    name = part.name
    return "\n".join(
        [
            f'<geometry id="{name}-mesh"><mesh>',
            _dae_source(f"{name}-points", points),
            _dae_source(f"{name}-normals", normals),
            f'<vertices id="{name}-vertices">'
            f'<input semantic="POSITION" source="#{name}-points"/></vertices>',
            f'<triangles count="{len(indices) // 3}" material="paint">'
            f'<input semantic="VERTEX" source="#{name}-vertices" offset="0"/>'
            f'<input semantic="NORMAL" source="#{name}-normals" offset="0"/>',
            f"<p>{' '.join(str(index) for index in indices.tolist())}</p></triangles>",
            "</mesh></geometry>",
        ]
    )


def _dae_source(name: str, rows: NDArray[np.float32]) -> str:
    numbers = " ".join(f"{value:.5g}" for value in rows.ravel().tolist())
    axes = "".join(f'<param name="{axis}" type="float"/>' for axis in "XYZ")
    return (
        f'<source id="{name}"><float_array id="{name}-array" count="{rows.size}">{numbers}'
        f'</float_array><technique_common><accessor source="#{name}-array" count="{len(rows)}" '
        f'stride="3">{axes}</accessor></technique_common></source>'
    )


def _dae_node(part: Painted) -> str:
    return (
        f'<node id="{part.name}"><instance_geometry url="#{part.name}-mesh"><bind_material>'
        f'<technique_common><instance_material symbol="paint" target="#{part.name}-material"/>'
        "</technique_common></bind_material></instance_geometry></node>"
    )
