"""The files of the page: read once, hashed as a tree, compressed once.

They are served as written, except for what shortens the first load: modules and stylesheets contain
those that they import, modules have no comments; the texts of a language contain those of panels
and checks; and the page names the panels that have a folder, and preloads what its first modules
import.
"""

from __future__ import annotations

import gzip
import hashlib
import json
import os
import posixpath
import re
from dataclasses import dataclass, replace
from functools import lru_cache
from html import escape
from pathlib import Path
from typing import TYPE_CHECKING, Final, Literal

import zstandard

from studio.server.modules import Modules

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

Coding = Literal["zstd", "gzip"]

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
    ".zst": "application/zstd",
}
"""The suffixes that are served, and as what; of others the page needs none."""
_COMPRESSED: Final = frozenset({".png", ".webp", ".woff2", ".zst"})
_NOT_SERVED: Final = frozenset({"tools", "screenshots", "node_modules"})
"""Folders beside the page; a folder of it may be named so, too."""
_INDEX: Final = "index.html"
_WITHOUT_INDEX: Final = (
    "<!doctype html><html lang=en><title>Robot description studio</title>"
    "<p>The page's files are missing from this installation: install it again."
)
_PRELOADS: Final = "{{preloads}}"
_PANELS: Final = "{{panels}}"
_MODULE_OF_INDEX: Final = re.compile(r'\{\{base\}\}([^"]+\.js)"')
_OWN_MODULE: Final = re.compile(r"(?!vendor/).*\.js$")
_CSS_IMPORT: Final = re.compile(r'^@import "([^"]+)";\n?', re.MULTILINE)
_LANGUAGE: Final = re.compile(r"i18n/(\w+)\.json")
CHECK_TEXTS: Final = "checks/words.json"
"""A file that is made in memory, by `check_texts`."""
_PANEL: Final = re.compile(r"panels/(\w+)/panel\.json")
_PANEL_TEXTS: Final = "words"
_FALLBACK: Final = "en"
_GZIP_LEVEL, _ZSTD_LEVEL = 6, 15

Stamp = tuple[tuple[str, int, int], ...]
"""(path, mtime ns, size) of every file of the tree."""


class Asset:
    """One file as it is sent."""

    def __init__(
        self, content: bytes | Callable[[], bytes], media_type: str, *, compressible: bool = True
    ) -> None:
        """Take the content, or a function that makes it at the first request."""
        self._content, self.type = content, media_type
        self._compressible = compressible
        self._packed: dict[Coding, bytes | None] = {}

    @property
    def content(self) -> bytes:
        """The whole of it."""
        if not isinstance(self._content, bytes):
            self._content = self._content()
        return self._content

    def packed(self, coding: Coding) -> bytes | None:
        """Return the content in that coding, made when it is first asked for; None: not smaller."""
        if not self._compressible:
            return None
        if coding not in self._packed:
            smaller = _PACK[coding](self.content)
            self._packed[coding] = smaller if len(smaller) < len(self.content) else None
        return self._packed[coding]


_PACK: Final[Mapping[Coding, Callable[[bytes], bytes]]] = {
    "zstd": lambda content: zstandard.compress(content, _ZSTD_LEVEL),
    "gzip": lambda content: gzip.compress(content, _GZIP_LEVEL, mtime=0),
}


def accepted_coding(accept_encoding: str) -> Coding | None:
    """Return the best coding that the header of a request names; None: none that we have."""
    named = {one.partition(";")[0].strip() for one in accept_encoding.split(",")}
    return "zstd" if "zstd" in named else "gzip" if "gzip" in named else None


@dataclass(frozen=True, eq=False)
class Tree:
    """All files of one state of the folder; `digest` names the state."""

    digest: str
    files: dict[str, Asset]
    index: str
    modules: Modules

    @property
    def base(self) -> str:
        """Prefix of every address of a file, with the slash at its end."""
        return f"/a/{self.digest}/"

    def preloads(self, roots: Iterable[str], base: str) -> str:
        """Markup for what these modules import before they run, and what that imports.

        The largest is the first: asked for last, it would keep all others waiting.
        """
        wanted = [path for path in self.modules.imported(roots) if path in self.files]
        wanted.sort(key=lambda path: -len(self.files[path].content))
        return "".join(f'<link rel="modulepreload" href="{escape(base + one)}">' for one in wanted)


class Assets:
    """The folder of the page; `current` notices when a developer has changed a file."""

    def __init__(self, folder: Path, more: Mapping[str, Callable[[], bytes]] | None = None) -> None:
        """Read `folder` at the first request; `more` makes files in memory, by their paths."""
        self._folder, self._more = folder, more or {}
        self._stamp: Stamp | None = None
        self._tree = Tree("none", {}, _WITHOUT_INDEX, Modules({}))

    def current(self) -> Tree:
        """Return the tree as the folder is now; read again only when a stamp changed."""
        stamp = _stamp(self._folder)
        if stamp != self._stamp:
            self._tree, self._stamp = _read(self._folder, stamp, self._more), stamp
        return self._tree

    def words(self, language: str) -> dict[str, str]:
        """Return the page's texts in a language; none if there are none."""
        if self._stamp is None:
            self.current()
        return _words(self._tree, language)

    def find(self, digest: str, path: str) -> tuple[Asset, bool] | None:
        """Return the file, and whether it is of that very tree (then it never changes)."""
        if self._stamp is None:  # the first to ask may be a tab from before a restart
            self.current()
        asset = self._tree.files.get(path)
        if asset is None:
            return None
        return asset, digest == self._tree.digest


@lru_cache(maxsize=8)
def _words(tree: Tree, language: str) -> dict[str, str]:
    asset = tree.files.get(f"i18n/{language}.json")
    return {} if asset is None else json.loads(asset.content)


def _stamp(folder: Path) -> Stamp:
    found: list[tuple[str, int, int]] = []
    for directory, names, files in os.walk(folder):
        hidden = _NOT_SERVED if Path(directory) == folder else frozenset[str]()
        names[:] = sorted(name for name in names if name not in hidden and name[0] != ".")
        for name in sorted(files):
            path = Path(directory, name)
            if path.suffix in _TYPES and name[0] != "." and path.is_file():
                status = path.stat()
                relative = path.relative_to(folder).as_posix()
                found.append((relative, status.st_mtime_ns, status.st_size))
    return tuple(found)


def _read(folder: Path, stamp: Stamp, more: Mapping[str, Callable[[], bytes]]) -> Tree:
    contents = {relative: (folder / relative).read_bytes() for relative, _, _ in stamp}
    contents |= {path: make() for path, make in more.items()}
    digest = hashlib.sha256()
    for relative, content in contents.items():
        digest.update(f"{relative}\0{len(content)}\0".encode() + content)
    index = contents.pop(_INDEX, b"").decode()
    modules = Modules({path: text for path, text in contents.items() if _OWN_MODULE.match(path)})
    files = {path: _asset(path, contents, modules) for path in contents}
    tree = Tree(digest.hexdigest()[:16], files, index or _WITHOUT_INDEX, modules)
    preloads = tree.preloads(_MODULE_OF_INDEX.findall(index), "{{base}}")
    filled = tree.index.replace(_PRELOADS, preloads).replace(_PANELS, panel_rows(contents))
    return replace(tree, index=filled)


def _asset(path: str, contents: Mapping[str, bytes], modules: Modules) -> Asset:
    suffix = Path(path).suffix

    def content() -> bytes:
        if suffix == ".css":
            return _with_imports(path, contents).encode()
        if language := _LANGUAGE.fullmatch(path):
            return _all_texts(language[1], contents)
        joined = modules.text(path)
        return contents[path] if joined is None else joined.encode()

    return Asset(content, _TYPES[suffix], compressible=suffix not in _COMPRESSED)


def _with_imports(path: str, contents: Mapping[str, bytes]) -> str:
    """Return a stylesheet with its imports in place; `**` names several."""

    def imported(match: re.Match[str]) -> str:
        wanted = posixpath.normpath(posixpath.join(posixpath.dirname(path), match[1]))
        folder, several, suffix = wanted.partition("**/*")
        named = [one for one in contents if one.startswith(folder) and one.endswith(suffix)]
        others = sorted(named) if several else [one for one in contents if one == wanted]
        return "".join(_with_imports(one, contents) for one in others) or match[0]

    return _CSS_IMPORT.sub(imported, contents[path].decode())


def panel_rows(contents: Mapping[str, bytes]) -> str:
    """Return each `panel.json` by the name of its folder, without its texts, as JSON.

    It can stand in a script element: it holds no `<`.
    """
    rows: dict[str, object] = {}
    for path, content in contents.items():
        if panel := _PANEL.fullmatch(path):
            row: dict[str, object] = json.loads(content)
            rows[panel[1]] = {key: one for key, one in row.items() if key != _PANEL_TEXTS}
    return json.dumps(rows, ensure_ascii=False, separators=(",", ":")).replace("<", "\\u003c")


def check_texts(whys: Mapping[str, Mapping[str, str]]) -> bytes:
    """Return a file of texts why findings matter, given by code and language."""
    by_language: dict[str, dict[str, str]] = {}
    for code, texts in whys.items():
        for language, text in texts.items():
            by_language.setdefault(language, {})[f"why.{code}"] = text
    return json.dumps(by_language, ensure_ascii=False).encode()


def _all_texts(language: str, contents: Mapping[str, bytes]) -> bytes:
    """Return the texts of page, panels and checks; in English what the language lacks."""
    texts: dict[str, str] = {}
    for spoken in dict.fromkeys((_FALLBACK, language)):
        texts |= json.loads(contents.get(f"i18n/{spoken}.json", b"{}"))
        for path, content in contents.items():
            if path == CHECK_TEXTS:
                texts |= json.loads(content).get(spoken, {})
            elif _PANEL.fullmatch(path):
                texts |= json.loads(content).get(_PANEL_TEXTS, {}).get(spoken, {})
    return json.dumps(texts, ensure_ascii=False, separators=(",", ":")).encode()
