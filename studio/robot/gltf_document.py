"""The JSON of a glTF 2.0 as far as it is drawn; field names are those of the specification."""
# ruff: noqa: N815

from __future__ import annotations

from typing import Any

import msgspec


class Asset(msgspec.Struct):
    """Which glTF this is."""

    version: str = "2.0"


class Buffer(msgspec.Struct):
    """Bytes, in the binary chunk when there is no URI."""

    uri: str | None = None


class BufferView(msgspec.Struct):
    """A stretch of a buffer."""

    buffer: int
    byteLength: int
    byteOffset: int = 0
    byteStride: int = 0


class SparsePart(msgspec.Struct):
    """Where the indices or the values of a sparse accessor lie."""

    bufferView: int
    byteOffset: int = 0
    componentType: int = 5126


class Sparse(msgspec.Struct):
    """Values that differ from those of the accessor's view."""

    count: int
    indices: SparsePart
    values: SparsePart


class Accessor(msgspec.Struct):
    """Typed rows in a buffer view; zeros when there is no view."""

    componentType: int
    count: int
    type: str
    bufferView: int | None = None
    byteOffset: int = 0
    normalized: bool = False
    sparse: Sparse | None = None


class Primitive(msgspec.Struct):
    """Triangles of one material; mode 4, 5, 6 are triangles, strip, fan."""

    attributes: dict[str, int]
    indices: int | None = None
    material: int | None = None
    mode: int = 4
    extensions: dict[str, Any] = {}


class Mesh(msgspec.Struct):
    """What a node shows."""

    primitives: list[Primitive]


class Node(msgspec.Struct):
    """A place in the scene; either `matrix` (by columns) or the three others."""

    children: list[int] = []
    mesh: int | None = None
    matrix: list[float] | None = None
    translation: tuple[float, float, float] = (0.0, 0.0, 0.0)
    rotation: tuple[float, float, float, float] = (0.0, 0.0, 0.0, 1.0)
    scale: tuple[float, float, float] = (1.0, 1.0, 1.0)


class Scene(msgspec.Struct):
    """Root nodes."""

    nodes: list[int] = []


class TextureUse(msgspec.Struct):
    """A texture in a material."""

    index: int
    texCoord: int = 0


class Surfacing(msgspec.Struct):
    """Metallic-roughness material; the colour is linear."""

    baseColorFactor: tuple[float, float, float, float] = (1.0, 1.0, 1.0, 1.0)
    baseColorTexture: TextureUse | None = None
    metallicFactor: float = 1.0
    roughnessFactor: float = 1.0


class GltfMaterial(msgspec.Struct):
    """A material; OPAQUE ignores alpha."""

    pbrMetallicRoughness: Surfacing = msgspec.field(default_factory=Surfacing)
    alphaMode: str = "OPAQUE"


class GltfTexture(msgspec.Struct):
    """An image with a sampler, which is not kept."""

    source: int | None = None


class Image(msgspec.Struct):
    """An image in a view, inline, or in a file."""

    uri: str | None = None
    bufferView: int | None = None


class GltfDocument(msgspec.Struct):
    """The whole."""

    asset: Asset
    scene: int = 0
    scenes: list[Scene] = []
    nodes: list[Node] = []
    meshes: list[Mesh] = []
    materials: list[GltfMaterial] = []
    accessors: list[Accessor] = []
    bufferViews: list[BufferView] = []
    buffers: list[Buffer] = []
    textures: list[GltfTexture] = []
    images: list[Image] = []
    extensionsUsed: list[str] = []
    extensionsRequired: list[str] = []
