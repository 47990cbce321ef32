"""COLLADA effects to looks: one colour or texture per material, as RViz shows them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.robot.number_lists import parse_floats
from studio.robot.surfaces import Look
from studio.robot.textures import read_texture

if TYPE_CHECKING:
    from xml.etree.ElementTree import Element

    from studio.robot.mesh_files import MeshFiles
    from studio.robot.surfaces import Rgba, Texture

_SHADERS = ("phong", "lambert", "blinn", "constant")
_GREY: Rgba = (0.8, 0.8, 0.8, 1.0)
_LEAST_ALPHA = 0.05
"""Some exporters have transparency upside down: what would be invisible is drawn opaque."""


class ColladaLooks:
    """Looks by material id; each image is read once."""

    def __init__(self, root: Element, files: MeshFiles) -> None:
        self._files = files
        self._materials = _by_id(root, "library_materials/material")
        self._effects = _by_id(root, "library_effects/effect")
        self._images = _by_id(root, "library_images/image")
        self._looks: dict[str, Look | None] = {}
        self._textures: dict[str, Texture | None] = {}

    def look(self, material: str) -> Look | None:
        """The look of a material by its id or name; None when it says nothing."""
        if material not in self._looks:
            try:
                self._looks[material] = self._read(material)
            except (ValueError, IndexError):
                self._files.warn("bad-material", f'its material "{material}" has broken numbers.')
                self._looks[material] = None
        return self._looks[material]

    def _read(self, material: str) -> Look | None:
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
                return self._look_of(element, [profile, effect])
        return None

    def _look_of(self, shader: Element, scopes: list[Element]) -> Look | None:
        diffuse = shader.find("emission" if shader.tag == "constant" else "diffuse")
        texture = None if diffuse is None else diffuse.find("texture")
        color = None if diffuse is None else diffuse.find("color")
        if texture is not None:
            image = self._texture(texture.get("texture", ""), scopes)
            return Look((1.0, 1.0, 1.0, 1.0) if image else _GREY, image)
        if color is None:
            return None
        red, green, blue, own_alpha = _rgba(color)
        alpha = own_alpha * _alpha(shader)
        return Look((red, green, blue, alpha if alpha >= _LEAST_ALPHA else 1.0))

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
    """Opacity by the element `transparent` and its mode; 1 where nothing is said."""
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
    """The id of the image behind a sampler; many writers name the image itself."""
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
