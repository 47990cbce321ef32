"""Wavefront OBJ with its MTL libraries to surfaces."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from studio.errors import MeshError
from studio.robot.meshes.files import TRIANGLE_LIMIT, parse_floats, read_texture
from studio.robot.meshes.surfaces import Appearance, Surface
from studio.robot.meshes.triangulation import polygon_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.meshes.files import MeshFiles
    from studio.robot.meshes.surfaces import Floats

_LEAST_OPACITY = 0.05
"""Some exporters write `Tr` upside down: what would be invisible is drawn opaque."""


def read_materials(data: bytes, files: MeshFiles) -> dict[str, Appearance | None]:
    """Return appearances by material name; None for a material without a colour.

    Raises:
        ValueError: A number of it is none.
    """
    appearances: dict[str, Appearance | None] = {}
    name = ""
    for line in data.decode("utf-8", "replace").splitlines():
        key, _, rest = line.strip().partition(" ")
        if key == "newmtl":
            name = rest.strip()
            appearances[name] = None
        elif key.lower() in {"kd", "d", "tr", "map_kd"} and rest.strip():
            appearances[name] = _with(appearances.get(name), key.lower(), rest.strip(), files)
    return appearances


def _with(appearance: Appearance | None, key: str, rest: str, files: MeshFiles) -> Appearance:
    known = appearance or Appearance()
    red, green, blue, alpha = known.rgba
    match key:
        case "kd" if known.texture is None:
            red, green, blue = (min(1.0, max(0.0, float(one))) for one in _three(rest))
        case "d" | "tr":
            value = float(rest.rsplit(maxsplit=1)[-1])
            opacity = value if key == "d" else 1.0 - value
            alpha = min(1.0, opacity) if opacity >= _LEAST_OPACITY else 1.0
        case "map_kd":
            texture = read_texture(files, _file_name(rest))
            if texture is not None:  # readers agree that the texture replaces the colour
                return dataclasses.replace(known, rgba=(1.0, 1.0, 1.0, alpha), texture=texture)
        case _:
            pass
    return dataclasses.replace(known, rgba=(red, green, blue, alpha))


def _three(rest: str) -> list[str]:
    parts = rest.split()
    return parts[:3] if len(parts) >= 3 else [parts[0]] * 3


def _file_name(rest: str) -> str:
    """Return the name behind options such as `-s 1 1 1`; a name may have blanks."""
    if not rest.startswith("-"):
        return rest
    return rest.rsplit(maxsplit=1)[-1]


@dataclass(slots=True)
class _Lines:
    """The lines of an OBJ, sorted by what they are."""

    positions: list[str] = field(default_factory=list[str])
    uvs: list[str] = field(default_factory=list[str])
    normals: list[str] = field(default_factory=list[str])
    faces: dict[str, list[list[str]]] = field(default_factory=dict[str, list[list[str]]])
    """Corners of each face as written, by material."""
    libraries: list[str] = field(default_factory=list[str])


def read_obj(files: MeshFiles) -> list[Surface]:
    """Return one surface per material, in metres as written.

    Raises:
        MeshError: A number is not valid, or a face points beyond its vertices.
    """
    try:
        _refuse_floods(files)
        lines = _sort_lines(files.data.decode("utf-8", "replace"))
        appearances = _appearances(lines, files)
        tables = _Tables(lines, files)
        return [
            tables.surface(faces, appearances.get(material))
            for material, faces in lines.faces.items()
        ]
    except ValueError as error:
        raise files.fault(f"it is no OBJ that can be read ({error}).") from error


def _refuse_floods(files: MeshFiles) -> None:
    """Count faces before their lines are read: millions of them take seconds.

    Raises:
        MeshError: There are more than anyone can draw.
    """
    faces = files.data.count(b"\nf ") + files.data.count(b"\nf\t")
    if faces > TRIANGLE_LIMIT:
        files.count_triangles(faces)


def _sort_lines(text: str) -> _Lines:
    lines = _Lines()
    material = ""
    for line in text.replace("\\\n", " ").replace("\\\r\n", " ").splitlines():
        kind, _, rest = line.strip().partition(" ")
        match kind:
            case "v":
                lines.positions.append(rest)
            case "vt":
                lines.uvs.append(rest)
            case "vn":
                lines.normals.append(rest)
            case "f":
                lines.faces.setdefault(material, []).append(_corners(rest, lines))
            case "usemtl":
                material = rest.strip()
            case "mtllib":
                lines.libraries.append(rest.strip())
            case _:
                pass
    return lines


def _corners(rest: str, lines: _Lines) -> list[str]:
    """Return the corners of a face, all counted from the start."""
    parts = rest.partition("#")[0].split()
    if "-" not in rest:
        return parts
    counts = (len(lines.positions), len(lines.uvs), len(lines.normals))
    return ["/".join(map(_from_start, corner.split("/"), counts)) for corner in parts]


def _from_start(index: str, count: int) -> str:
    return str(count + 1 + int(index)) if index.startswith("-") else index


def _appearances(lines: _Lines, files: MeshFiles) -> dict[str, Appearance | None]:
    appearances: dict[str, Appearance | None] = {}
    for library in lines.libraries:
        try:
            appearances |= read_materials(files.read_beside(library), files)
        except MeshError as error:
            files.warn("missing-material", f"{error.reason} It is drawn without its colours.")
        except ValueError:
            files.warn("bad-material", f'its material library "{library}" has broken numbers.')
    return appearances


class _Tables:
    """The vertex lists as arrays, from which faces pick their corners."""

    def __init__(self, lines: _Lines, files: MeshFiles) -> None:
        self._files = files
        table = _table(lines.positions, 3)
        self._positions = table[:, :3]
        self._colors = _colors(table)
        self._uvs = _table(lines.uvs, 2)[:, :2]
        self._normals = _table(lines.normals, 3)[:, :3]

    def surface(self, faces: list[list[str]], appearance: Appearance | None) -> Surface:
        """Return the triangles of these faces."""
        numbers: dict[str, int] = {}
        distinct = [numbers.setdefault(corner, len(numbers)) for face in faces for corner in face]
        table = np.array([_indices(corner) for corner in numbers], dtype=np.int64).reshape(-1, 3)
        rows = table[np.array(distinct, dtype=np.int64)]
        points = self._pick(self._positions, rows[:, 0])
        if points is None:
            raise self._files.fault("a face of it points beyond its vertices.")
        sizes = np.array([len(face) for face in faces], dtype=np.int64)
        corners = polygon_corners(sizes, points)
        self._files.count_triangles(len(corners) // 3)
        rows = rows[corners]
        textured = appearance is not None and appearance.texture is not None
        return Surface(
            points[corners],
            self._pick(self._normals, rows[:, 2]),
            self._pick(self._uvs, rows[:, 1]) if textured else None,
            None if self._colors is None else self._colors[rows[:, 0]],
            appearance,
        )

    @staticmethod
    def _pick(table: Floats, rows: NDArray[np.int64]) -> Floats | None:
        """Return the rows; None when some are missing, as they may be for all but positions."""
        if len(rows) and (int(rows.min()) < 0 or int(rows.max()) >= len(table)):
            return None
        return table[rows]


def _table(rows: list[str], width: int) -> Floats:
    """Return numbers of equal lines; the first decides how many, at least `width`."""
    if not rows:
        return np.zeros((0, width), dtype=np.float32)
    columns = len(rows[0].split())
    numbers = parse_floats(" ".join(rows))
    if columns < width or len(numbers) != columns * len(rows):
        return _ragged_table(rows, width)
    with np.errstate(over="ignore"):  # beyond float32 is infinite, and not drawn
        return numbers.astype(np.float32).reshape(-1, columns)


def _ragged_table(rows: list[str], width: int) -> Floats:
    """Return the first numbers of lines that differ in length."""
    parts = [row.partition("#")[0].split()[:width] for row in rows]
    filled = [[*map(float, one), *[0.0] * (width - len(one))] for one in parts]
    with np.errstate(over="ignore"):
        return np.array(filled, dtype=np.float64).astype(np.float32)


def _colors(table: Floats) -> NDArray[np.uint8] | None:
    """Vertex colours, which many scanners write behind the position, as sRGB bytes."""
    if table.shape[1] not in {6, 7}:
        return None
    colors = np.ones((len(table), 4), dtype=np.float32)
    colors[:, :3] = np.nan_to_num(table[:, 3:6]).clip(0.0, 1.0)
    return np.round(colors * 255).astype(np.uint8)


def _indices(corner: str) -> tuple[int, int, int]:
    """Rows of position, texture and normal from 0; -1 where none is given."""
    position, uv, normal = [*corner.split("/"), "", ""][:3]
    return int(position) - 1, int(uv or 0) - 1, int(normal or 0) - 1
