"""A glTF 2.0 file: its JSON with the names of the specification, and its bounds-checked buffers."""

# ruff: noqa: N815

from __future__ import annotations

import base64
import binascii
import struct
from typing import TYPE_CHECKING, Any, Final, TypeVar
from urllib.parse import unquote_to_bytes

import msgspec
import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.robot.meshes.files import MeshFiles

_MOST_ROWS: Final = 1 << 24
_GLB_MAGIC: Final = b"glTF"
_JSON, _BINARY = 0x4E4F534A, 0x004E4942
_DTYPES: Final = {5120: "<i1", 5121: "<u1", 5122: "<i2", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
_WIDTHS: Final = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
Item = TypeVar("Item")


class Asset(msgspec.Struct):
    """The version of glTF."""

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
    """The indices or the values of a sparse accessor."""

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
    """The primitives of a node."""

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
    """The root nodes of a scene."""

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


_DOCUMENTS: Final = msgspec.json.Decoder(GltfDocument)


def read_document(files: MeshFiles) -> tuple[GltfDocument, bytes]:
    """Return the JSON of a .gltf or .glb, and the binary chunk of a .glb.

    Raises:
        MeshError: Not glTF 2.0, or its JSON does not fit the specification.
    """
    text, binary = files.data, b""
    if text[:4] == _GLB_MAGIC:
        text, binary = _glb_chunks(files)
    try:
        document = _DOCUMENTS.decode(text)
    except (msgspec.DecodeError, UnicodeError) as error:
        raise files.fault(f"its JSON is not that of a glTF ({error}).") from error
    if not document.asset.version.startswith("2."):
        raise files.fault(f'it is glTF "{document.asset.version}": export it as glTF 2.0.')
    return document, binary


def _glb_chunks(files: MeshFiles) -> tuple[bytes, bytes]:
    data, chunks, at = files.data, dict[int, bytes](), 12
    while at + 8 <= len(data):
        length, kind = struct.unpack_from("<II", data, at)
        if at + 8 + length > len(data):
            raise files.fault("it is cut off: a chunk of it is longer than the file.")
        chunks.setdefault(kind, data[at + 8 : at + 8 + length])
        at += 8 + length
    if _JSON not in chunks:
        raise files.fault("it has no JSON chunk: it is cut off or glTF 1.0.")
    return chunks[_JSON], chunks.get(_BINARY, b"")


class GltfBuffers:
    """Reads accessors and images; each buffer is fetched once."""

    def __init__(self, document: GltfDocument, binary: bytes, files: MeshFiles) -> None:
        self._document, self._binary, self._files = document, binary, files
        self._buffers: dict[int, bytes] = {}

    def rows(self, accessor: int) -> NDArray[np.float32]:
        """Return the values of an accessor, (count, width), as numbers; normalised ones in [-1, 1].

        Raises:
            MeshError: It does not fit its buffer.
        """
        one = self._accessor(accessor)
        values = self._raw(one)
        if one.sparse is not None:
            values = self._with_sparse(one, values)
        if not one.normalized or values.dtype == np.float32:
            return values.astype(np.float32)
        top = float(np.iinfo(values.dtype).max)
        return np.maximum(values.astype(np.float32) / top, -1.0).astype(np.float32)

    def indices(self, accessor: int) -> NDArray[np.int64]:
        """Return the values of an index accessor, (count,)."""
        one = self._accessor(accessor)
        if one.componentType not in {5121, 5123, 5125} or one.type != "SCALAR":
            raise self._files.fault("its triangle indices are no whole numbers.")
        return self._raw(one)[:, 0].astype(np.int64)

    def view(self, index: int) -> bytes:
        """Return the bytes of a buffer view."""
        data, start, length, _ = self._view(index)
        return data[start : start + length]

    def uri(self, uri: str) -> bytes:
        """Return the content of a URI: inline data, or a file beside the mesh.

        Raises:
            MeshError: It is neither.
        """
        if not uri.startswith("data:"):
            return self._files.read_beside(uri)
        head, _, body = uri.partition(",")
        try:
            if head.endswith(";base64"):
                return base64.b64decode(body, validate=True)
        except binascii.Error as error:
            raise self._files.fault(f"its inline data is no base64 ({error}).") from error
        return unquote_to_bytes(body)

    def _accessor(self, index: int) -> Accessor:
        one = self._item(self._document.accessors, index, "accessor")
        if one.componentType not in _DTYPES or one.type not in _WIDTHS or one.count < 0:
            raise self._files.fault(f"its accessor {index} is of no known type.")
        return one

    def _raw(self, one: Accessor) -> NDArray[Any]:
        dtype, width = np.dtype(_DTYPES[one.componentType]), _WIDTHS[one.type]
        row_bytes = dtype.itemsize * width
        if one.bufferView is None:
            if one.count > _MOST_ROWS:
                raise self._files.fault("it promises more values than it holds.")
            return np.zeros((one.count, width), dtype=dtype)
        data, start, length, stride = self._view(one.bufferView)
        stride = stride or row_bytes
        needed = one.byteOffset + stride * (one.count - 1) + row_bytes if one.count else 0
        if one.byteOffset < 0 or stride < row_bytes or needed > length:
            raise self._files.fault("its accessors reach beyond their buffer: it is cut off.")
        return np.ndarray(
            (one.count, width), dtype, data, start + one.byteOffset, (stride, dtype.itemsize)
        )

    def _with_sparse(self, one: Accessor, values: NDArray[Any]) -> NDArray[Any]:
        assert one.sparse is not None
        sparse, changed = one.sparse, values.copy()
        at = self._raw(
            Accessor(
                sparse.indices.componentType,
                sparse.count,
                "SCALAR",
                sparse.indices.bufferView,
                sparse.indices.byteOffset,
            )
        )[:, 0].astype(np.int64)
        new = self._raw(
            Accessor(
                one.componentType,
                sparse.count,
                one.type,
                sparse.values.bufferView,
                sparse.values.byteOffset,
            )
        )
        if len(at) and int(at.max()) >= len(changed):
            raise self._files.fault("its sparse values point beyond their list.")
        changed[at] = new
        return changed

    def _view(self, index: int) -> tuple[bytes, int, int, int]:
        view = self._item(self._document.bufferViews, index, "buffer view")
        data = self._buffer(view.buffer)
        if view.byteOffset < 0 or view.byteLength < 0 or view.byteStride < 0:
            raise self._files.fault(f"its buffer view {index} has a negative size.")
        if view.byteOffset + view.byteLength > len(data):
            raise self._files.fault("a buffer of it is shorter than it promises: it is cut off.")
        return data, view.byteOffset, view.byteLength, view.byteStride

    def _buffer(self, index: int) -> bytes:
        if index not in self._buffers:
            buffer = self._item(self._document.buffers, index, "buffer")
            self._buffers[index] = self._binary if buffer.uri is None else self.uri(buffer.uri)
        return self._buffers[index]

    def _item(self, items: list[Item], index: int, what: str) -> Item:
        if not 0 <= index < len(items):
            raise self._files.fault(f"it names {what} {index}, which it does not have.")
        return items[index]
