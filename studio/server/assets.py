"""The files of the page: read once, hashed as a tree, compressed once, served as written."""

from __future__ import annotations

import gzip
import hashlib
import os
from dataclasses import dataclass
from pathlib import Path
from typing import Final

_TYPES: Final = {
    ".css": "text/css; charset=utf-8",
    ".html": "text/html; charset=utf-8",
    ".ico": "image/x-icon",
    ".js": "text/javascript; charset=utf-8",
    ".json": "application/json",
    ".map": "application/json",
    ".md": "text/markdown; charset=utf-8",
    ".mjs": "text/javascript; charset=utf-8",
    ".png": "image/png",
    ".svg": "image/svg+xml",
    ".txt": "text/plain; charset=utf-8",
    ".wasm": "application/wasm",
    ".webp": "image/webp",
    ".woff2": "font/woff2",
}
"""The suffixes that are served, and as what; of others the page needs none."""
_COMPRESSED: Final = frozenset({".png", ".webp", ".woff2"})
_NOT_SERVED: Final = frozenset({"tools", "screenshots", "node_modules"})
_INDEX: Final = "index.html"
_WITHOUT_INDEX: Final = (
    "<!doctype html><html lang=en><title>Robot description studio</title>"
    "<p>The page's files are missing from this installation: install it again."
)

Stamp = tuple[tuple[str, int, int], ...]
"""(path, mtime ns, size) of every file of the tree."""


@dataclass(frozen=True, slots=True)
class Asset:
    """One file as it is sent."""

    content: bytes
    compressed: bytes | None
    """gzip, where it is smaller."""
    type: str


@dataclass(frozen=True, slots=True)
class Tree:
    """All files of one state of the folder; `digest` names the state."""

    digest: str
    files: dict[str, Asset]
    index: str

    @property
    def base(self) -> str:
        """Prefix of every address of a file, with the slash at its end."""
        return f"/a/{self.digest}/"


class Assets:
    """The folder of the page; `current` notices when a developer has changed a file."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._stamp: Stamp | None = None
        self._tree = Tree("none", {}, _WITHOUT_INDEX)

    def current(self) -> Tree:
        """The tree as the folder is now; read anew only when a stamp changed."""
        stamp = _stamp(self._folder)
        if stamp != self._stamp:
            self._tree, self._stamp = _read(self._folder, stamp), stamp
        return self._tree

    def find(self, digest: str, path: str) -> tuple[Asset, bool] | None:
        """The file, and whether it is of that very tree (then it never changes)."""
        if self._stamp is None:  # the first to ask may be a tab from before a restart
            self.current()
        asset = self._tree.files.get(path)
        if asset is None:
            return None
        return asset, digest == self._tree.digest


def _stamp(folder: Path) -> Stamp:
    found: list[tuple[str, int, int]] = []
    for directory, names, files in os.walk(folder):
        names[:] = sorted(name for name in names if name not in _NOT_SERVED and name[0] != ".")
        for name in sorted(files):
            path = Path(directory, name)
            if path.suffix in _TYPES and name[0] != "." and path.is_file():
                status = path.stat()
                relative = path.relative_to(folder).as_posix()
                found.append((relative, status.st_mtime_ns, status.st_size))
    return tuple(found)


def _read(folder: Path, stamp: Stamp) -> Tree:
    digest = hashlib.sha256()
    files: dict[str, Asset] = {}
    for relative, _, _ in stamp:
        content = (folder / relative).read_bytes()
        digest.update(f"{relative}\0{len(content)}\0".encode() + content)
        files[relative] = _asset(content, Path(relative).suffix)
    index = files.pop(_INDEX, None)
    text = index.content.decode() if index else _WITHOUT_INDEX
    return Tree(digest.hexdigest()[:16], files, text)


def _asset(content: bytes, suffix: str) -> Asset:
    compressed = None if suffix in _COMPRESSED else gzip.compress(content, 6, mtime=0)
    if compressed is not None and len(compressed) >= len(content):
        compressed = None
    return Asset(content, compressed, _TYPES[suffix])
