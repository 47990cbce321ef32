"""glTF 2.0, .gltf and .glb, to surfaces; axes as in the file, as RViz shows it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Final

import numpy as np

from studio.errors import MeshError
from studio.robot.kinematics import floating_motion
from studio.robot.meshes.files import encode_texture
from studio.robot.meshes.gltf_document import GltfBuffers, read_document
from studio.robot.meshes.surfaces import Appearance, Surface, srgb_bytes, srgb_from_linear
from studio.robot.meshes.triangulation import fan_corners, strip_corners

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.meshes.files import MeshFiles
    from studio.robot.meshes.gltf_document import GltfDocument, GltfMaterial, Image, Node, Primitive
    from studio.robot.meshes.surfaces import Floats, Matrix, Texture

_COMPRESSIONS: Final = {
    "KHR_draco_mesh_compression": "Draco",
    "EXT_meshopt_compression": "meshopt",
    "KHR_meshopt_compression": "meshopt",
}
_KNOWN_EXTENSIONS: Final = {
    "KHR_mesh_quantization",
    "KHR_materials_unlit",
    "KHR_texture_transform",
}
_NODE_LIMIT: Final = 20_000
_DEPTH_LIMIT: Final = 200


def read_gltf(files: MeshFiles) -> list[Surface]:
    """Return all triangles of the scene, in metres.

    Raises:
        MeshError: Not glTF 2.0, compressed, or its parts do not fit each other.
    """
    document, binary = read_document(files)
    _refuse_extensions(document, files)
    return _Scene(document, GltfBuffers(document, binary, files), files).surfaces()


def _refuse_extensions(document: GltfDocument, files: MeshFiles) -> None:
    used = {*document.extensionsUsed, *document.extensionsRequired}
    used.update(*(one.extensions for mesh in document.meshes for one in mesh.primitives))
    for extension, compression in _COMPRESSIONS.items():
        if extension in used:
            raise files.fault(
                f"it is compressed with {compression}, which is not read: "
                "export it without compression."
            )
    unknown = [one for one in document.extensionsRequired if one not in _KNOWN_EXTENSIONS]
    if unknown and not all(one.startswith("KHR_materials_") for one in unknown):
        raise files.fault(f"it needs {', '.join(unknown)}, which is not read: export it without.")


class _Scene:
    """Walks the nodes and places what they show; each mesh is read once."""

    def __init__(self, document: GltfDocument, buffers: GltfBuffers, files: MeshFiles) -> None:
        self._document, self._buffers, self._files = document, buffers, files
        self._meshes: dict[int, list[Surface]] = {}
        self._appearances: dict[int, Appearance] = {}
        self._images: dict[int, Texture | None] = {}
        self._placed: list[Surface] = []
        self._visits = 0

    def surfaces(self) -> list[Surface]:
        scenes = self._document.scenes
        if scenes:
            roots = scenes[self._document.scene if self._document.scene < len(scenes) else 0].nodes
        else:
            below = {child for node in self._document.nodes for child in node.children}
            roots = [n for n in range(len(self._document.nodes)) if n not in below]
        for root in roots:
            self._walk(root, np.eye(4), 0)
        return self._placed

    def _walk(self, index: int, world_from_parent: Matrix, depth: int) -> None:
        self._visits += 1
        if depth > _DEPTH_LIMIT or self._visits > _NODE_LIMIT:
            raise self._files.fault("its nodes hold each other without end.")
        if not 0 <= index < len(self._document.nodes):
            raise self._files.fault(f"it names node {index}, which it does not have.")
        node = self._document.nodes[index]
        world_from_node = world_from_parent @ self._parent_from_node(node)
        if node.mesh is not None:
            for surface in self._mesh(node.mesh):
                self._files.count_triangles(surface.triangle_count)
                self._placed.append(surface.moved(world_from_node))
        for child in node.children:
            self._walk(child, world_from_node, depth + 1)

    def _parent_from_node(self, node: Node) -> Matrix:
        numbers = node.matrix or [*node.translation, *node.rotation, *node.scale]
        wanted = 16 if node.matrix else 10
        if len(numbers) != wanted or not np.isfinite(numbers).all():
            raise self._files.fault("a node of it is not placed by finite numbers.")
        if node.matrix:
            return np.array(node.matrix, dtype=np.float64).reshape(4, 4).T
        x, y, z, w = node.rotation
        quaternion = np.array([w, x, y, z]) if any(node.rotation) else np.array([1.0, 0, 0, 0])
        placed = floating_motion(np.array(node.translation), quaternion)
        placed[:3, :3] *= np.array(node.scale)
        return placed

    def _mesh(self, index: int) -> list[Surface]:
        if index not in self._meshes:
            if not 0 <= index < len(self._document.meshes):
                raise self._files.fault(f"it names mesh {index}, which it does not have.")
            primitives = self._document.meshes[index].primitives
            read = [self._surface(one) for one in primitives]
            self._meshes[index] = [one for one in read if one is not None]
        return self._meshes[index]

    def _surface(self, primitive: Primitive) -> Surface | None:
        """Return the triangles of a primitive; None for points and lines."""
        positions = self._stream(primitive, "POSITION", 3)
        if positions is None or primitive.mode not in {4, 5, 6}:
            return None
        appearance, uv = self._appearance_and_uv(primitive)
        colors = self._stream(primitive, "COLOR_0", 3)
        surface = Surface(
            positions,
            self._stream(primitive, "NORMAL", 3),
            uv,
            None if colors is None else srgb_bytes(colors),
            appearance,
        )
        streams = (surface.normals, surface.uv, surface.colors)
        if any(one is not None and len(one) != len(positions) for one in streams):
            raise self._files.fault("the lists of a primitive of it differ in length.")
        return surface.chosen(self._corners(primitive, len(positions)))

    def _appearance_and_uv(self, primitive: Primitive) -> tuple[Appearance | None, Floats | None]:
        if primitive.material is None:
            return None, None
        if not 0 <= primitive.material < len(self._document.materials):
            raise self._files.fault(f"it names material {primitive.material}, which it lacks.")
        surfacing = self._document.materials[primitive.material].pbrMetallicRoughness
        appearance = self._appearance(primitive.material)
        if appearance.texture is None or surfacing.baseColorTexture is None:
            return appearance, None
        uv = self._stream(primitive, f"TEXCOORD_{surfacing.baseColorTexture.texCoord}", 2)
        if uv is None:
            return dataclasses.replace(appearance, texture=None), None
        upwards = uv[:, :2].copy()  # glTF counts v downwards
        upwards[:, 1] = 1 - upwards[:, 1]
        return appearance, upwards

    def _stream(self, primitive: Primitive, name: str, width: int) -> Floats | None:
        """Return the rows of an attribute, at least `width` wide; None without it."""
        accessor = primitive.attributes.get(name)
        if accessor is None:
            return None
        rows = self._buffers.rows(accessor)
        if rows.shape[1] < width:
            raise self._files.fault(f"its {name} has rows of {rows.shape[1]} numbers.")
        return rows

    def _corners(self, primitive: Primitive, count: int) -> NDArray[np.int64]:
        """Return the row at each corner of each triangle."""
        rows = np.arange(count)
        if primitive.indices is not None:
            rows = self._buffers.indices(primitive.indices)
            if len(rows) and int(rows.max()) >= count:
                raise self._files.fault("its triangles point beyond their vertices.")
        match primitive.mode:
            case 5:
                return rows[strip_corners(np.array([len(rows)]))]
            case 6:
                return rows[fan_corners(np.array([len(rows)]))]
            case _:
                return rows[: len(rows) // 3 * 3]

    def _appearance(self, index: int) -> Appearance:
        if index not in self._appearances:
            self._appearances[index] = self._read_appearance(self._document.materials[index])
        return self._appearances[index]

    def _read_appearance(self, material: GltfMaterial) -> Appearance:
        surfacing = material.pbrMetallicRoughness
        red, green, blue, alpha = surfacing.baseColorFactor
        used = surfacing.baseColorTexture
        return Appearance(
            (
                srgb_from_linear(red),
                srgb_from_linear(green),
                srgb_from_linear(blue),
                1.0 if material.alphaMode == "OPAQUE" else min(1.0, max(0.0, alpha)),
            ),
            None if used is None else self._texture(used.index),
            min(1.0, max(0.0, surfacing.metallicFactor)),
            min(1.0, max(0.0, surfacing.roughnessFactor)),
        )

    def _texture(self, index: int) -> Texture | None:
        textures, images = self._document.textures, self._document.images
        source = textures[index].source if 0 <= index < len(textures) else None
        if source is None or not 0 <= source < len(images):
            self._files.warn("missing-texture", f"it names texture {index}, which it lacks.")
            return None
        if source not in self._images:
            self._images[source] = self._read_image(images[source], source)
        return self._images[source]

    def _read_image(self, image: Image, index: int) -> Texture | None:
        try:
            if image.uri is not None:
                data = self._buffers.uri(image.uri)
            else:
                data = self._buffers.view(-1 if image.bufferView is None else image.bufferView)
        except MeshError as error:
            self._files.warn("missing-texture", f"{error.reason} The mesh is drawn without it.")
            return None
        return encode_texture(self._files, f"image {index}", data)
