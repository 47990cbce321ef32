"""COLLADA geometry to triangle corners: triangles, polylists, polygons, strips and fans."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, TypeAlias

import numpy as np

from studio.robot.meshes.files import parse_floats, parse_integers
from studio.robot.meshes.surfaces import Surface
from studio.robot.meshes.triangulation import fan_corners, polygon_corners, strip_corners

if TYPE_CHECKING:
    from collections.abc import Callable
    from xml.etree.ElementTree import Element

    from numpy.typing import NDArray

    from studio.robot.meshes.files import MeshFiles

    Integers: TypeAlias = NDArray[np.int64]

_MOST_OFFSETS = 64
_WIDTHS = {"POSITION": 3, "NORMAL": 3, "TEXCOORD": 2, "COLOR": 4}


@dataclass(frozen=True, slots=True, eq=False)
class Primitive:
    """Triangles of one material; `symbol` is bound to a material where the geometry is used."""

    surface: Surface
    symbol: str


class ColladaGeometry:
    """Reads each `<geometry>` once, when it is first used."""

    def __init__(self, root: Element, files: MeshFiles) -> None:
        self._files = files
        self._elements = {
            one.get("id", ""): one for one in root.findall("library_geometries/geometry")
        }
        self._read: dict[str, list[Primitive]] = {}

    def all(self) -> list[str]:
        """Ids in document order."""
        return list(self._elements)

    def primitives(self, geometry: str) -> list[Primitive]:
        """Return the triangles of a geometry; empty for splines, lines and what does not exist."""
        if geometry not in self._read:
            element = self._elements.get(geometry)
            mesh = None if element is None else element.find("mesh")
            self._read[geometry] = [] if mesh is None else self._read_mesh(mesh)
        return self._read[geometry]

    def _read_mesh(self, mesh: Element) -> list[Primitive]:
        sources = _Sources(mesh, self._files)
        found: list[Primitive] = []
        for element in mesh:
            triangulate = _TRIANGULATIONS.get(element.tag)
            if triangulate is not None:
                found += self._read_primitive(element, sources, triangulate)
        return found

    def _read_primitive(
        self, element: Element, sources: _Sources, triangulate: Triangulation
    ) -> list[Primitive]:
        inputs = sources.inputs(element)
        stride = 1 + max((one.offset for one in inputs), default=0)
        rows, sizes, split = triangulate(element, stride, self._files)
        places = next((one for one in inputs if one.semantic == "POSITION"), None)
        if places is None:
            raise self._files.fault("a primitive of it has no positions.")
        listed = rows[: int(sizes.sum())]
        corners = split(sizes, self._pick(sources.rows(places), listed[:, places.offset]))
        if not len(corners):
            return []
        picked = rows[corners]
        streams = {
            one.semantic: self._pick(sources.rows(one), picked[:, one.offset])
            for one in reversed(inputs)  # of several texture coordinates the first set is drawn
        }
        return [Primitive(_surface(streams), element.get("material", ""))]

    def _pick(self, rows: NDArray[np.float32], index: Integers) -> NDArray[np.float32]:
        if len(index) and (int(index.max()) >= len(rows) or int(index.min()) < 0):
            raise self._files.fault(
                f"it points at row {int(index.max())} of a list with {len(rows)} rows."
            )
        return rows[index]


@dataclass(frozen=True, slots=True)
class _Input:
    semantic: str
    source: str
    offset: int


class _Sources:
    """The lists of numbers of one `<mesh>`, parsed when first used."""

    def __init__(self, mesh: Element, files: MeshFiles) -> None:
        self._files = files
        self._elements = {one.get("id", ""): one for one in mesh.findall("source")}
        self._vertices = {one.get("id", ""): one for one in mesh.findall("vertices")}
        self._rows: dict[str, NDArray[np.float32]] = {}

    def inputs(self, primitive: Element) -> list[_Input]:
        """Return the inputs of a primitive that are drawn, those of `<vertices>` too."""
        found: list[_Input] = []
        for one in primitive.findall("input"):
            offset = self._integer(one, "offset", 0)
            if not 0 <= offset < _MOST_OFFSETS:
                raise self._files.fault(f"an input of it has the offset {offset}.")
            source = one.get("source", "").removeprefix("#")
            vertices = self._vertices.get(source)
            inner = [one] if vertices is None else vertices.findall("input")
            found += [
                _Input(each.get("semantic", ""), each.get("source", "").removeprefix("#"), offset)
                for each in inner
            ]
        return [one for one in found if one.semantic in _WIDTHS]

    def rows(self, used: _Input) -> NDArray[np.float32]:
        """Return shape (N, 3) for positions and normals, (N, 2) for texture, (N, 4) for colours."""
        if used.source not in self._rows:
            self._rows[used.source] = self._parse(used.source)
        rows, width = self._rows[used.source], _WIDTHS[used.semantic]
        if rows.shape[1] == 3 and width == 4:
            return np.concatenate((rows, np.ones((len(rows), 1), dtype=np.float32)), axis=1)
        if rows.shape[1] < width:
            raise self._files.fault(f"its {used.semantic} list has rows of {rows.shape[1]}.")
        return rows[:, :width]

    def _parse(self, source: str) -> NDArray[np.float32]:
        element = self._elements.get(source)
        array = None if element is None else element.find("float_array")
        if element is None or array is None:
            raise self._files.fault(f'its list "{source}" does not exist.')
        accessor = element.find("technique_common/accessor")
        stride = 3 if accessor is None else self._integer(accessor, "stride", 1)
        start = 0 if accessor is None else self._integer(accessor, "offset", 0)
        if stride < 1 or start < 0:
            raise self._files.fault(f'its list "{source}" has the stride {stride}.')
        try:
            numbers = parse_floats(array.text or "")[start:]
        except ValueError as error:
            raise self._files.fault(f'its list "{source}" holds what is no number.') from error
        whole = len(numbers) // stride * stride
        with np.errstate(over="ignore"):  # beyond float32 is infinite, and not drawn
            return numbers[:whole].astype(np.float32).reshape(-1, stride)

    def _integer(self, element: Element, key: str, default: int) -> int:
        written = element.get(key)
        try:
            return default if written is None else int(written)
        except ValueError as error:
            raise self._files.fault(f'{key} of a <{element.tag}> is "{written}".') from error


def _surface(streams: dict[str, NDArray[np.float32]]) -> Surface:
    colors = streams.get("COLOR")
    if colors is not None:
        colors = np.nan_to_num(colors).clip(0.0, 1.0)
    return Surface(
        streams["POSITION"],
        streams.get("NORMAL"),
        streams.get("TEXCOORD"),
        None if colors is None else np.round(colors * 255).astype(np.uint8),
    )


if TYPE_CHECKING:
    Split: TypeAlias = Callable[[Integers, NDArray[np.float32]], Integers]
    """Sizes of polygons and the points of their corners to the rows of triangle corners."""
    Polygons: TypeAlias = tuple[Integers, Integers, Split]
    """Index rows (N, stride), how many of them each polygon takes, and how it is split."""
    Triangulation: TypeAlias = Callable[[Element, int, MeshFiles], Polygons]


def _index_rows(element: Element, stride: int, files: MeshFiles) -> Integers:
    try:
        numbers = parse_integers(element.text or "")
    except ValueError as error:
        raise files.fault("an index of it is no whole number.") from error
    return numbers[: len(numbers) // stride * stride].reshape(-1, stride)


def _triangles(element: Element, stride: int, files: MeshFiles) -> Polygons:
    rows = _joined([_index_rows(p, stride, files) for p in element.findall("p")], stride)
    return rows, np.full(len(rows) // 3, 3), polygon_corners


def _polylist(element: Element, stride: int, files: MeshFiles) -> Polygons:
    rows = _joined([_index_rows(p, stride, files) for p in element.findall("p")], stride)
    counts = element.find("vcount")
    sizes = np.zeros(0, dtype=np.int64) if counts is None else _index_rows(counts, 1, files)[:, 0]
    most = int(sizes.max(initial=0))  # checked first: a sum of huge ones may wrap round
    if int(sizes.min(initial=0)) < 0 or most > len(rows) or int(sizes.sum()) > len(rows):
        raise files.fault(f"its polygons need more than the {len(rows)} corners that it lists.")
    return rows, sizes, polygon_corners


def _polygons(element: Element, stride: int, files: MeshFiles) -> Polygons:
    """Read each `<p>` as a polygon; of one with holes only the outline, as most readers do."""
    return _runs([*element.findall("p"), *element.findall("ph/p")], stride, files, polygon_corners)


def _trifans(element: Element, stride: int, files: MeshFiles) -> Polygons:
    return _runs(element.findall("p"), stride, files, lambda sizes, _: fan_corners(sizes))


def _tristrips(element: Element, stride: int, files: MeshFiles) -> Polygons:
    return _runs(element.findall("p"), stride, files, lambda sizes, _: strip_corners(sizes))


def _runs(elements: list[Element], stride: int, files: MeshFiles, split: Split) -> Polygons:
    runs = [_index_rows(one, stride, files) for one in elements]
    return _joined(runs, stride), np.array([len(run) for run in runs], dtype=np.int64), split


def _joined(runs: list[Integers], stride: int) -> Integers:
    return np.concatenate(runs) if runs else np.zeros((0, stride), dtype=np.int64)


_TRIANGULATIONS: dict[str, Triangulation] = {
    "triangles": _triangles,
    "polylist": _polylist,
    "polygons": _polygons,
    "trifans": _trifans,
    "tristrips": _tristrips,
}
