"""Wavefront OBJ with its MTL libraries to surfaces."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from studio.errors import MeshError
from studio.robot.mesh_files import TRIANGLE_LIMIT
from studio.robot.number_lists import parse_floats
from studio.robot.obj_materials import read_materials
from studio.robot.surfaces import Surface
from studio.robot.triangulation import polygon_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.mesh_files import MeshFiles
    from studio.robot.surfaces import Floats, Look


@dataclass(slots=True)
class _Lines:
    """The lines of an OBJ, sorted by what they are."""

    positions: list[str] = field(default_factory=list[str])
    uvs: list[str] = field(default_factory=list[str])
    normals: list[str] = field(default_factory=list[str])
    faces: dict[str, list[list[str]]] = field(default_factory=dict[str, list[list[str]]])
    """Corner words of each face, by material."""
    libraries: list[str] = field(default_factory=list[str])


def read_obj(files: MeshFiles) -> list[Surface]:
    """One surface per material, in metres as written.

    Raises:
        MeshError: A number of it is none, or a face points beyond its vertices.
    """
    try:
        _refuse_floods(files)
        lines = _sort_lines(files.data.decode("utf-8", "replace"))
        looks = _looks(lines, files)
        tables = _Tables(lines, files)
        return [
            tables.surface(faces, looks.get(material)) for material, faces in lines.faces.items()
        ]
    except ValueError as error:
        raise files.fault(f"it is no OBJ that can be read ({error}).") from error


def _refuse_floods(files: MeshFiles) -> None:
    """Count faces before their lines are looked at: millions of them take seconds.

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
                lines.faces.setdefault(material, []).append(_corner_words(rest, lines))
            case "usemtl":
                material = rest.strip()
            case "mtllib":
                lines.libraries.append(rest.strip())
            case _:
                pass
    return lines


def _corner_words(rest: str, lines: _Lines) -> list[str]:
    """The corners of a face; those counted from the end are counted from the start instead."""
    words = rest.partition("#")[0].split()
    if "-" not in rest:
        return words
    counts = (len(lines.positions), len(lines.uvs), len(lines.normals))
    return ["/".join(map(_from_start, word.split("/"), counts)) for word in words]


def _from_start(index: str, count: int) -> str:
    return str(count + 1 + int(index)) if index.startswith("-") else index


def _looks(lines: _Lines, files: MeshFiles) -> dict[str, Look | None]:
    looks: dict[str, Look | None] = {}
    for library in lines.libraries:
        try:
            looks |= read_materials(files.read_beside(library), files)
        except MeshError as error:
            files.warn("missing-material", f"{error.reason} It is drawn without its colours.")
        except ValueError:
            files.warn("bad-material", f'its material library "{library}" has broken numbers.')
    return looks


class _Tables:
    """The vertex lists as arrays, from which faces pick their corners."""

    def __init__(self, lines: _Lines, files: MeshFiles) -> None:
        self._files = files
        table = _table(lines.positions, 3)
        self._positions = table[:, :3]
        self._colors = _colors(table)
        self._uvs = _table(lines.uvs, 2)[:, :2]
        self._normals = _table(lines.normals, 3)[:, :3]

    def surface(self, faces: list[list[str]], look: Look | None) -> Surface:
        """The triangles of these faces."""
        numbers: dict[str, int] = {}
        distinct = [numbers.setdefault(word, len(numbers)) for face in faces for word in face]
        table = np.array([_indices(word) for word in numbers], dtype=np.int64).reshape(-1, 3)
        rows = table[np.array(distinct, dtype=np.int64)]
        points = self._pick(self._positions, rows[:, 0])
        if points is None:
            raise self._files.fault("a face of it points beyond its vertices.")
        sizes = np.array([len(face) for face in faces], dtype=np.int64)
        corners = polygon_corners(sizes, points)
        self._files.count_triangles(len(corners) // 3)
        rows = rows[corners]
        textured = look is not None and look.texture is not None
        return Surface(
            points[corners],
            self._pick(self._normals, rows[:, 2]),
            self._pick(self._uvs, rows[:, 1]) if textured else None,
            None if self._colors is None else self._colors[rows[:, 0]],
            look,
        )

    @staticmethod
    def _pick(table: Floats, rows: NDArray[np.int64]) -> Floats | None:
        """The rows asked for; None when some are missing, as they may be for all but positions."""
        if len(rows) and (int(rows.min()) < 0 or int(rows.max()) >= len(table)):
            return None
        return table[rows]


def _table(rows: list[str], width: int) -> Floats:
    """Numbers of equal lines; the first says how many, at least `width`."""
    if not rows:
        return np.zeros((0, width), dtype=np.float32)
    columns = len(rows[0].split())
    numbers = parse_floats(" ".join(rows))
    if columns < width or len(numbers) != columns * len(rows):
        return _ragged_table(rows, width)
    with np.errstate(over="ignore"):  # beyond float32 is infinite, and not drawn
        return numbers.astype(np.float32).reshape(-1, columns)


def _ragged_table(rows: list[str], width: int) -> Floats:
    """The first numbers of lines that differ in length."""
    words = [row.partition("#")[0].split()[:width] for row in rows]
    filled = [[*map(float, one), *[0.0] * (width - len(one))] for one in words]
    with np.errstate(over="ignore"):
        return np.array(filled, dtype=np.float64).astype(np.float32)


def _colors(table: Floats) -> NDArray[np.uint8] | None:
    """Vertex colours, which many scanners write behind the position, as sRGB bytes."""
    if table.shape[1] not in {6, 7}:
        return None
    colors = np.ones((len(table), 4), dtype=np.float32)
    colors[:, :3] = np.nan_to_num(table[:, 3:6]).clip(0.0, 1.0)
    return np.round(colors * 255).astype(np.uint8)


def _indices(word: str) -> tuple[int, int, int]:
    """Rows of position, texture and normal from 0; -1 where none is given."""
    position, uv, normal = [*word.split("/"), "", ""][:3]
    return int(position) - 1, int(uv or 0) - 1, int(normal or 0) - 1
