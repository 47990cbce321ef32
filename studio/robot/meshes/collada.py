"""COLLADA documents to surfaces: `<unit>` applied, `up_axis` ignored, as RViz does."""

from __future__ import annotations

import codecs
import dataclasses
import math
from typing import TYPE_CHECKING

import numpy as np

from studio.errors import RobotError
from studio.robot.meshes.collada_geometry import ColladaGeometry
from studio.robot.meshes.files import parse_floats, read_texture
from studio.robot.meshes.surfaces import Appearance
from studio.robot.rotations import cross_matrices, unit_vectors
from studio.robot.xml_tree import parse_tree

if TYPE_CHECKING:
    from collections.abc import Callable
    from xml.etree.ElementTree import Element

    from studio.robot.meshes.files import MeshFiles
    from studio.robot.meshes.surfaces import Matrix, Rgba, Surface, Texture

_SHADERS = ("phong", "lambert", "blinn", "constant")
_GREY: Rgba = (0.8, 0.8, 0.8, 1.0)
_LEAST_ALPHA = 0.05
"""Some exporters have transparency upside down: what would be invisible is drawn opaque."""
_DEPTH_LIMIT = 200
_INSTANCE_LIMIT = 20_000


class ColladaAppearances:
    """Appearances by material id; each image is read once."""

    def __init__(self, root: Element, files: MeshFiles) -> None:
        self._files = files
        self._materials = _by_id(root, "library_materials/material")
        self._effects = _by_id(root, "library_effects/effect")
        self._images = _by_id(root, "library_images/image")
        self._appearances: dict[str, Appearance | None] = {}
        self._textures: dict[str, Texture | None] = {}

    def appearance(self, material: str) -> Appearance | None:
        """Return the appearance of a material by its id or name; None when it has none."""
        if material not in self._appearances:
            try:
                self._appearances[material] = self._read(material)
            except (ValueError, IndexError):
                self._files.warn("bad-material", f'its material "{material}" has broken numbers.')
                self._appearances[material] = None
        return self._appearances[material]

    def _read(self, material: str) -> Appearance | None:
        found = self._materials.get(material)
        if found is None:
            named = (one for one in self._materials.values() if one.get("name") == material)
            found = next(named, None)
        instance = None if found is None else found.find("instance_effect")
        effect = None if instance is None else self._effects.get(_target(instance, "url"))
        profile = None if effect is None else effect.find("profile_COMMON")
        if effect is None or profile is None:
            return None
        for shader in _SHADERS:
            element = profile.find(f"technique/{shader}")
            if element is not None:
                return self._appearance_of(element, [profile, effect])
        return None

    def _appearance_of(self, shader: Element, scopes: list[Element]) -> Appearance | None:
        diffuse = shader.find("emission" if shader.tag == "constant" else "diffuse")
        texture = None if diffuse is None else diffuse.find("texture")
        color = None if diffuse is None else diffuse.find("color")
        if texture is not None:
            image = self._texture(texture.get("texture", ""), scopes)
            return Appearance((1.0, 1.0, 1.0, 1.0) if image else _GREY, image)
        if color is None:
            return None
        red, green, blue, own_alpha = _rgba(color)
        alpha = own_alpha * _alpha(shader)
        return Appearance((red, green, blue, alpha if alpha >= _LEAST_ALPHA else 1.0))

    def _texture(self, sampler: str, scopes: list[Element]) -> Texture | None:
        """Follow sampler, surface and image to the file."""
        image = _image_of(sampler, scopes)
        if image not in self._textures:
            uri = _image_uri(self._images.get(image))
            if not uri:
                self._files.warn("missing-texture", f'its image "{image}" names no file.')
            self._textures[image] = read_texture(self._files, uri) if uri else None
        return self._textures[image]


def _by_id(root: Element, path: str) -> dict[str, Element]:
    return {one.get("id", ""): one for one in root.findall(path)}


def _target(element: Element, key: str) -> str:
    return element.get(key, "").removeprefix("#")


def _rgba(color: Element) -> Rgba:
    numbers = [min(1.0, max(0.0, float(one))) for one in parse_floats(color.text or "")]
    red, green, blue, alpha = [*numbers, 1.0, 1.0, 1.0, 1.0][:4] if numbers else _GREY
    return red, green, blue, alpha if len(numbers) > 3 else 1.0


def _alpha(shader: Element) -> float:
    """Return the opacity by the element `transparent` and its mode; 1 without one."""
    transparent = shader.find("transparent")
    factor = shader.find("transparency/float")
    amount = 1.0 if factor is None else float(parse_floats(factor.text or "1")[0])
    color = None if transparent is None else transparent.find("color")
    if transparent is None or color is None:
        return 1.0
    red, green, blue, alpha = _rgba(color)
    if transparent.get("opaque", "A_ONE") == "RGB_ZERO":
        return 1.0 - amount * (0.212671 * red + 0.715160 * green + 0.072169 * blue)
    return alpha * amount


def _image_of(sampler: str, scopes: list[Element]) -> str:
    """Return the id of the image behind a sampler; many writers name the image itself."""
    name = sampler
    for _ in range(4):
        parameter = _parameter(name, scopes)
        if parameter is None:
            return name
        instance = parameter.find("sampler2D/instance_image")
        if instance is not None:
            return _target(instance, "url")
        name = (
            parameter.findtext("sampler2D/source")
            or parameter.findtext("surface/init_from")
            or parameter.findtext("surface/init_from/ref")
            or ""
        ).strip()
    return name


def _parameter(sid: str, scopes: list[Element]) -> Element | None:
    candidates = (one for scope in scopes for one in scope.findall("newparam"))
    return next((one for one in candidates if one.get("sid") == sid), None)


def _image_uri(image: Element | None) -> str:
    if image is None:
        return ""
    return (image.findtext("init_from/ref") or image.findtext("init_from") or "").strip()


def read_collada(files: MeshFiles) -> list[Surface]:
    """Return all triangles of the scene, in metres.

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
        self._appearances = ColladaAppearances(root, files)
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
            appearance = self._appearances.appearance(
                materials.get(primitive.symbol, primitive.symbol)
            )
            surface = dataclasses.replace(primitive.surface, appearance=appearance)
            if appearance is None or appearance.texture is None:
                surface = dataclasses.replace(surface, uv=None)
            self._placed.append(surface.moved(world_from_node))

    def _parent_from_node(self, node: Element) -> Matrix:
        """Return the product of the node's transforms in document order."""
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
    """Read the eye, the point it is directed at (along -z), and up."""
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
