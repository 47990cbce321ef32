"""Shared by the readers of mesh files: bounded access to files, textures, numbers in text."""

from __future__ import annotations

import contextlib
import hashlib
import io
import re
import warnings
from typing import TYPE_CHECKING, Final
from urllib.parse import unquote

import msgspec
import numpy as np

from studio.errors import MeshError, PackageError
from studio.files import LFS_REASON, is_lfs_pointer
from studio.packages.roots import ServedRoots
from studio.problems import Place, Problem, Severity
from studio.robot.meshes.surfaces import Texture
from studio.settings import MESH_SIZE_LIMIT_BYTES

if TYPE_CHECKING:
    from collections.abc import Generator, Iterable
    from pathlib import Path

    from numpy.typing import NDArray
    from PIL import Image

TRIANGLE_LIMIT = 4_000_000
"""Most that a browser can draw; a mesh beyond it needs simplifying, not loading."""
_REFERENCE_LIMIT = 256
_REFERENCES_LIMIT_BYTES = 1 << 30
_SCHEME = re.compile(r"^([a-z][a-z0-9+.-]+):", re.IGNORECASE)
_PASSED: Final = {"PNG": "image/png", "JPEG": "image/jpeg"}
_FORMATS: Final = ("PNG", "JPEG", "BMP", "TGA", "TIFF", "GIF", "WEBP", "PPM")
_SIDE_LIMIT: Final = 8192
_PIXEL_LIMIT: Final = 64 << 20
_FLOATS = msgspec.json.Decoder(list[float])


class MeshFiles:
    """Reads a mesh file and the files beside it, and keeps their digests and faults.

    Args:
        path: The mesh, already resolved below the served roots.
        roots: Folders that may be read; without any, the mesh's own folder.

    Raises:
        MeshError: It is a Git LFS pointer.
        PackageError: The mesh cannot be read.
    """

    def __init__(self, path: Path, roots: Iterable[Path] = ()) -> None:
        self.path = path
        self._roots = ServedRoots(tuple(roots) or (path.parent,))
        self.data = self._roots.read(path, MESH_SIZE_LIMIT_BYTES)
        if is_lfs_pointer(self.data):
            raise self.fault(f"it {LFS_REASON}")
        self.digest = content_digest(self.data)
        self.references: dict[str, str] = {}
        """Digest of each file that was read, by absolute path; empty when it is missing."""
        self.problems: list[Problem] = []
        self._left_bytes = _REFERENCES_LIMIT_BYTES
        self._left_triangles = TRIANGLE_LIMIT

    def fault(self, reason: str) -> MeshError:
        """Return the error for this mesh."""
        return MeshError(str(self.path), reason)

    def warn(self, code: str, reason: str) -> None:
        """Note what the mesh is drawn without."""
        sentence = f"{self.path.name}: {reason}"
        problem = Problem(Severity.WARNING, code, sentence, Place(str(self.path)))
        if problem not in self.problems:
            self.problems.append(problem)

    def count_triangles(self, count: int) -> None:
        """Take `count` more triangles, before any memory is spent on them.

        Raises:
            MeshError: There are more than anyone can draw.
        """
        self._left_triangles -= count
        if self._left_triangles < 0:
            raise self.fault(
                f"it has more than {TRIANGLE_LIMIT:,} triangles, which no browser draws: "
                "simplify it."
            )

    def read_beside(self, uri: str) -> bytes:
        """Read a file that the mesh refers to.

        An absolute path of another machine, as many exporters write it, stands for its name in
        the mesh's own folder.

        Raises:
            MeshError: It is on the network, outside the served roots, missing, or too much.
        """
        path = self._beside(uri)
        try:
            return self._read(path)
        except MeshError as error:
            fallback = self.path.parent / path.name
            if fallback == path or not path.name:
                raise
            try:
                return self._read(fallback)
            except MeshError:
                raise error from None  # what was written is what must be mended

    def _beside(self, uri: str) -> Path:
        scheme = _SCHEME.match(uri)
        if scheme and scheme[1].lower() != "file" and len(scheme[1]) > 1:
            raise self.fault(f'it refers to "{_short(uri)}", which is not read over the network.')
        local = unquote(re.sub(r"^file:(//(localhost)?(?=/))?", "", uri)).replace("\\", "/")
        if "\0" in local:
            raise self.fault("it refers to a file whose name holds a NUL.")
        return self.path.parent / local

    def _read(self, path: Path) -> bytes:
        if len(self.references) >= _REFERENCE_LIMIT:
            raise self.fault(f"it refers to more than {_REFERENCE_LIMIT} files.")
        try:
            data = self._roots.read(path, min(MESH_SIZE_LIMIT_BYTES, self._left_bytes))
        except PackageError as error:
            self.references[str(path)] = ""
            raise MeshError(str(self.path), f'it refers to "{path.name}": {error}') from error
        if is_lfs_pointer(data):
            raise self.fault(f'it refers to "{path.name}", which {LFS_REASON}')
        self._left_bytes -= len(data)
        self.references[str(path)] = content_digest(data)
        return data


def content_digest(data: bytes) -> str:
    """Hex digest that names a content."""
    return hashlib.sha256(data).hexdigest()


def _short(text: str) -> str:
    return text if len(text) <= 80 else f"{text[:77]}..."


# pyright: reportUnknownMemberType=false


def read_texture(files: MeshFiles, uri: str) -> Texture | None:
    """Return the image that a mesh refers to; None, and a warning, when it cannot be had."""
    try:
        return encode_texture(files, uri, files.read_beside(uri))
    except MeshError as error:
        files.warn("missing-texture", f"{error.reason} The mesh is drawn without it.")
        return None


def encode_texture(files: MeshFiles, name: str, data: bytes) -> Texture | None:
    """Return an image for browsers; None, and a warning, when it is broken or too large.

    Of PNG and JPEG only the header is read: its size decides what unpacking would cost.
    """
    from PIL import Image  # noqa: PLC0415 - many meshes have no texture

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(io.BytesIO(data), formats=_FORMATS) as image:
                width, height = image.size
                if max(width, height) > _SIDE_LIMIT or width * height > _PIXEL_LIMIT:
                    files.warn("bad-texture", _too_large(name, width, height))
                    return None
                return _encode(image, data)
    except (OSError, ValueError, SyntaxError, Image.DecompressionBombError, Warning) as error:
        files.warn("bad-texture", f'its texture "{name}" is no image that can be read ({error}).')
        return None


def _encode(image: Image.Image, data: bytes) -> Texture:
    mime = _PASSED.get(image.format or "")
    if mime is not None and image.mode != "CMYK":
        return Texture(data, mime)
    buffer = io.BytesIO()
    image.convert("RGBA").save(buffer, "PNG", compress_level=1)
    return Texture(buffer.getvalue(), "image/png")


def _too_large(name: str, width: int, height: int) -> str:
    return (
        f'its texture "{name}" is {width} x {height} pixels, more than {_SIDE_LIMIT} a side: '
        "scale it down. The mesh is drawn without it."
    )


def parse_floats(text: str) -> NDArray[np.float64]:
    """Return numbers separated by blanks of any kind.

    Most writers put one blank between numbers and write them as JSON does: its decoder takes half
    the time of numpy's.

    Raises:
        ValueError: A part is no number.
    """
    try:
        return np.array(_FLOATS.decode(f"[{text.strip().replace(' ', ',')}]"), dtype=np.float64)
    except (msgspec.DecodeError, UnicodeError):
        with _no_text_skipped():
            return np.fromstring(text, dtype=np.float64, sep=" ")


def parse_integers(text: str) -> NDArray[np.int64]:
    """Return whole numbers separated by blanks of any kind.

    Raises:
        ValueError: A part is no whole number.
    """
    with _no_text_skipped():
        return np.fromstring(text, dtype=np.int64, sep=" ")


@contextlib.contextmanager
def _no_text_skipped() -> Generator[None]:
    """Raise where numpy only warns: it stops at the first part that is no number."""
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)
        try:
            yield
        except DeprecationWarning as error:
            raise ValueError("a word of it is no number") from error
