"""COLLADA documents to surfaces: `<unit>` applied, `up_axis` ignored, as RViz does."""

from __future__ import annotations

import codecs
import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np

from studio.errors import RobotError
from studio.robot.collada_geometry import ColladaGeometry
from studio.robot.collada_looks import ColladaLooks
from studio.robot.number_lists import parse_floats
from studio.robot.rotations import cross_matrices, unit_vectors
from studio.robot.xml_tree import parse_tree

if TYPE_CHECKING:
    from collections.abc import Callable
    from xml.etree.ElementTree import Element

    from studio.robot.mesh_files import MeshFiles
    from studio.robot.surfaces import Matrix, Surface

_DEPTH_LIMIT = 200
_INSTANCE_LIMIT = 20_000


def read_collada(files: MeshFiles) -> list[Surface]:
    """All triangles of the scene, in metres.

    Raises:
        MeshError: Not well-formed, or its lists do not fit each other.
    """
    try:
        root = parse_tree(_trimmed(files.data))
    except RobotError as error:
        raise files.fault(str(error)) from error
    if root.tag != "COLLADA":
        raise files.fault(f"its root is <{root.tag}>, not <COLLADA>.")
    return _Scene(root, files).surfaces()


def _trimmed(data: bytes) -> bytes:
    """Without blanks before `<?xml`, and NULs at the end: some exporters write them."""
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return data  # where NULs are half of every character
    return data.rstrip(b"\0 \t\r\n").removeprefix(codecs.BOM_UTF8).lstrip()


class _Scene:
    """Walks the nodes and places what they show."""

    def __init__(self, root: Element, files: MeshFiles) -> None:
        self._root, self._files = root, files
        self._geometry = ColladaGeometry(root, files)
        self._looks = ColladaLooks(root, files)
        self._nodes = {one.get("id", ""): one for one in root.iter("node")}
        self._controllers = {
            one.get("id", ""): one for one in root.findall("library_controllers/controller")
        }
        self._instances = 0
        self._placed: list[Surface] = []

    def surfaces(self) -> list[Surface]:
        world_from_scene = np.diag([*[self._metres_per_unit()] * 3, 1.0])
        scene = self._scene()
        if scene is None:  # some writers leave the scene out and mean everything
            for geometry in self._geometry.all():
                self._place(geometry, {}, world_from_scene)
        else:
            for node in scene.findall("node"):
                self._walk(node, world_from_scene, 0)
        return self._placed

    def _metres_per_unit(self) -> float:
        unit = self._root.find("asset/unit")
        written = "1" if unit is None else unit.get("meter", "1")
        try:
            metres = float(written)
        except ValueError as error:
            raise self._files.fault(f'its unit is "{written}" metres long.') from error
        if not (math.isfinite(metres) and metres > 0):
            raise self._files.fault(f'its unit is "{written}" metres long.')
        return metres

    def _scene(self) -> Element | None:
        scenes = self._root.findall("library_visual_scenes/visual_scene")
        instance = self._root.find("scene/instance_visual_scene")
        wanted = "" if instance is None else instance.get("url", "").removeprefix("#")
        return next((one for one in scenes if one.get("id") == wanted), next(iter(scenes), None))

    def _walk(self, node: Element, world_from_parent: Matrix, depth: int) -> None:
        self._instances += 1
        if depth > _DEPTH_LIMIT or self._instances > _INSTANCE_LIMIT:
            raise self._files.fault("its nodes use each other without end.")
        world_from_node = world_from_parent @ self._parent_from_node(node)
        for child in node:
            target = child.get("url", "").removeprefix("#")
            match child.tag:
                case "node":
                    self._walk(child, world_from_node, depth + 1)
                case "instance_node" if target in self._nodes:
                    self._walk(self._nodes[target], world_from_node, depth + 1)
                case "instance_geometry":
                    self._place(target, _bound_materials(child), world_from_node)
                case "instance_controller":
                    self._place_skin(child, target, world_from_node)
                case _:
                    pass

    def _place_skin(self, instance: Element, controller: str, world_from_node: Matrix) -> None:
        """A skinned mesh in its rest pose."""
        element = self._controllers.get(controller)
        skin = None if element is None else element.find("skin")
        if skin is None:
            return
        shape = skin.find("bind_shape_matrix")
        node_from_shape = np.eye(4) if shape is None else _matrix(self._numbers(shape, 16))
        geometry = skin.get("source", "").removeprefix("#")
        self._place(geometry, _bound_materials(instance), world_from_node @ node_from_shape)

    def _place(self, geometry: str, materials: dict[str, str], world_from_node: Matrix) -> None:
        for primitive in self._geometry.primitives(geometry):
            self._instances += 1
            if self._instances > _INSTANCE_LIMIT:
                raise self._files.fault("it shows more than 20,000 pieces.")
            self._files.count_triangles(primitive.surface.triangle_count)
            look = self._looks.look(materials.get(primitive.symbol, primitive.symbol))
            surface = dataclasses.replace(primitive.surface, look=look)
            if look is None or look.texture is None:
                surface = dataclasses.replace(surface, uv=None)
            self._placed.append(surface.moved(world_from_node))

    def _parent_from_node(self, node: Element) -> Matrix:
        """The product of the node's transforms in document order."""
        parent_from_node = np.eye(4)
        for child in node:
            known = _TRANSFORMS.get(child.tag)
            if known is not None:
                count, matrix = known
                parent_from_node = parent_from_node @ matrix(self._numbers(child, count))
        return parent_from_node

    def _numbers(self, element: Element, count: int) -> Matrix:
        try:
            numbers = parse_floats(element.text or "")
        except ValueError as error:
            raise self._files.fault(f"a <{element.tag}> of it holds what is no number.") from error
        if len(numbers) != count or not np.isfinite(numbers).all():
            raise self._files.fault(f"a <{element.tag}> of it has not {count} finite numbers.")
        return numbers


def _bound_materials(instance: Element) -> dict[str, str]:
    return {
        one.get("symbol", ""): one.get("target", "").removeprefix("#")
        for one in instance.findall("bind_material/technique_common/instance_material")
    }


def _matrix(numbers: Matrix) -> Matrix:
    return numbers.reshape(4, 4)


def _translate(numbers: Matrix) -> Matrix:
    moved = np.eye(4)
    moved[:3, 3] = numbers
    return moved


def _scale(numbers: Matrix) -> Matrix:
    return np.diag([*numbers, 1.0])


def _rotate(numbers: Matrix) -> Matrix:
    """Axis, then the angle in degrees."""
    cross = cross_matrices(unit_vectors(numbers[:3]))
    angle = math.radians(float(numbers[3]))
    turned = np.eye(4)
    turned[:3, :3] += math.sin(angle) * cross + (1 - math.cos(angle)) * cross @ cross
    return turned


def _look_at(numbers: Matrix) -> Matrix:
    """Eye, point looked at (along -z), up."""
    eye, at, up = numbers.reshape(3, 3)
    back = unit_vectors(eye - at)
    right = unit_vectors(np.cross(up, back))
    placed = np.eye(4)
    placed[:3, :4] = np.stack((right, np.cross(back, right), back, eye), axis=1)
    return placed


_TRANSFORMS: dict[str, tuple[int, Callable[[Matrix], Matrix]]] = {
    "matrix": (16, _matrix),
    "translate": (3, _translate),
    "scale": (3, _scale),
    "rotate": (4, _rotate),
    "lookat": (9, _look_at),
}
