"""The page's modules, joined: those needed together are served as one file.

A page, a worker or the 3D view begins with a module that nobody imports; one imported later, by
`import()`, is an entry point, too. Modules that only one entry point needs are in its file; those
that several need are in a file of their own, but a worker and the 3D view have copies. The address
of a module in another one's file serves a line that re-exports it.

A module becomes a function in that file, so its names stay its own; comments and indentation are
left out, and a wheel holds modules without them. Modules that are not written like the page's
(circles, `export *`) are served as written, with all that they import.
"""

from __future__ import annotations

import posixpath
import re
from graphlib import CycleError, TopologicalSorter
from typing import TYPE_CHECKING, Final, NamedTuple

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Mapping

_TOKEN: Final = re.compile(
    r"""(?P<comment>//[^\n]*|/\*.*?\*/)
    |(?P<string>"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])*')
    |(?P<pattern>(?:[(,=:\[!&|?;>]|\breturn)\s*/(?![/*])(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\\n\[])+/)
    |(?P<quote>`)|(?P<open>\{)|(?P<close>\})|(?P<line>\s*\n\s*)""",
    re.DOTALL | re.VERBOSE,
)
_TEMPLATE: Final = re.compile(r"(?:\\.|\$(?!\{)|[^`\\$])*(?P<end>`|\$\{)", re.DOTALL)
_IMPORT: Final = re.compile(
    r'^import\s+(?:(?:(?P<one>\w+)|\{(?P<names>[^}]*)\})\s+from\s+)?"(?P<source>[^"]+)";\n?',
    re.MULTILINE,
)
_ANY_IMPORT: Final = re.compile(
    r'^(?:import|export)\s+(?:[\w*{][^;"]*?\sfrom\s+)?"([^"]+)"', re.MULTILINE
)
_LATER: Final = re.compile(r'(?<![\w.])import\((["`])(\.[^"`]+)\1\)(?!\.[A-Z])')
"""An import made later; in a comment a type would follow."""
_FILLED: Final = re.compile(r"\$\{(\w+)\}")
_EXPORT: Final = re.compile(
    r"^export (?=(?:async )?(?:function\*?|class|const) (\w+))", re.MULTILINE
)
_UNKNOWN: Final = re.compile(r"^(?:import\b(?!\()|export\b)(?!:)", re.MULTILINE)
_AWAITS: Final = re.compile(r"^(?:const [^=\n]+ = )?await ", re.MULTILINE)
_OWN_ADDRESS: Final = "import.meta.url"


class _Import(NamedTuple):
    """An import of another module: `names` as in a pattern, which may be empty."""

    path: str
    address: str
    names: str


class _Module:
    """One module as it is written."""

    def __init__(self, path: str, text: str) -> None:
        self.path, self._text = path, text
        self.imports = [_imported(path, match) for match in _IMPORT.finditer(text)]
        self.wants = [_beside(path, address) for address in _ANY_IMPORT.findall(text)]
        self.later = [_pattern(_beside(path, name)) for _, name in _LATER.findall(text)]
        self.exports: list[str] = _EXPORT.findall(text)
        self.is_like_others = not _UNKNOWN.search(_EXPORT.sub("", _IMPORT.sub("", text)))

    def body(self, file: str) -> str:
        """Return its code without imports, for that file."""
        text = _IMPORT.sub("", bare(self._text))
        if file == self.path:
            return text
        text = _LATER.sub(
            lambda one: f"import({one[1]}{_address(_beside(self.path, one[2]), file)}{one[1]})",
            text,
        )
        own = f'new URL("{_address(self.path, file)}", {_OWN_ADDRESS}).href'
        return text.replace(_OWN_ADDRESS, own)


class Modules:
    """The modules of one state of the page; a file of them is made when it is asked for."""

    def __init__(self, sources: Mapping[str, bytes]) -> None:
        """Take the page's own modules by their paths."""
        self._written = {path: _Module(path, text.decode()) for path, text in sources.items()}
        self._modules = _joinable(self._written)
        later = {pattern for module in self._written.values() for pattern in module.later}
        self._later = {path for path in sources if any(one.fullmatch(path) for one in later)}
        self._members: dict[str, list[str]] = {}
        """The modules in a file in the order in which they run, by the path of the file."""
        self._file_of: dict[str, str] = {}
        """The file of each module, except of those that are only copied."""
        self._divide()

    def text(self, path: str) -> str | None:
        """Return what is served under this path; None: the module as written."""
        if path in self._members:
            return self._joined(path)
        if path not in self._file_of:
            return None
        taken = _Import(path, "", ", ".join(self._modules[path].exports))
        return self._line(taken, path) + f"export {_taken(taken)}"

    def imported(self, roots: Iterable[str]) -> list[str]:
        """Return all files that these import before they run, without these."""
        named = list(roots)
        found = dict.fromkeys(named)
        waiting = named.copy()
        while waiting:
            for file in self._files_for(waiting.pop()):
                if file not in found:
                    found[file] = None
                    waiting.append(file)
        return [path for path in found if path not in named]

    def _divide(self) -> None:
        """Put each module into the file of the doors that lead to it."""
        wanted = {name for module in self._modules.values() for name in module.wants}
        leading: dict[str, list[str]] = {}
        for door in self._modules:
            if door in wanted and door not in self._later:
                continue
            needed = self._needed(door)
            if door not in self._later and not any(self._modules[one].later for one in needed):
                self._members[door] = needed  # a worker, or the 3D view
                continue
            for path in needed:
                leading.setdefault(path, []).append(door)
        together: dict[tuple[str, ...], list[str]] = {}
        for path, doors in leading.items():
            first = [door for door in doors if door not in self._later]
            together.setdefault(tuple(first or doors), []).append(path)
        for doors, members in together.items():
            file = next((door for door in doors if door in members), members[-1])
            self._members[file] = members
            self._file_of |= dict.fromkeys(members, file)

    def _needed(self, path: str) -> list[str]:
        """Return the module behind all that it imports."""
        found: dict[str, None] = {}

        def add(path: str) -> None:
            for name in self._modules[path].wants:
                if name in self._modules and name not in found:
                    add(name)
            found[path] = None

        add(path)
        return list(found)

    def _files_for(self, path: str) -> list[str]:
        members = self._members.get(path, [path] if path in self._written else [])
        wanted = [name for member in members for name in self._written[member].wants]
        return [self._file_of.get(name, name) for name in wanted if name not in members]

    def _joined(self, file: str) -> str:
        members = self._members[file]
        lines: dict[str, None] = {}
        bodies: list[str] = []
        for path in members:
            module = self._modules[path]
            body = "".join(_taken(one) for one in module.imports if one.names) + module.body(file)
            others = [one for one in module.imports if one.path not in members]
            lines |= dict.fromkeys(self._line(one, file) for one in others)
            bodies.append(body if len(members) == 1 else _function(module, body))
        if len(members) > 1:
            bodies.append(f"export {{ {', '.join(map(_name, members))} }};\n")
            whole = _Import(file, "", ", ".join(self._modules[file].exports))
            bodies.append(f"export {_taken(whole)}" if whole.names else "")
        return "".join(lines) + "".join(bodies)

    def _line(self, one: _Import, file: str) -> str:
        """Return the line by which a file takes a module from elsewhere."""
        home = self._file_of.get(one.path)
        if home is None:  # a library, or served as written
            address = _address(one.path, file) if one.address[0] == "." else one.address
        else:
            address = _address(home, file)
        is_alone = home is None or len(self._members[home]) == 1
        name = _name(one.path)
        return f'import {f"* as {name}" if is_alone else f"{{ {name} }}"} from "{address}";\n'


def _imported(path: str, match: re.Match[str]) -> _Import:
    address = match["source"]
    names = f"default as {match['one']}" if match["one"] else match["names"] or ""
    parts = [name.strip().replace(" as ", ": ") for name in names.split(",")]
    return _Import(_beside(path, address), address, ", ".join(filter(None, parts)))


def _beside(path: str, address: str) -> str:
    """Return the path that an address in this module means; of a library it is the address."""
    if address[0] != ".":
        return address
    return posixpath.normpath(posixpath.join(posixpath.dirname(path), address))


def _pattern(path: str) -> re.Pattern[str]:
    """Return a pattern of all paths that a template such as `${id}/${id}.js` may mean."""
    found: list[str] = []
    parts = _FILLED.split(path)
    for text, name in zip(parts[::2], [*parts[1::2], ""], strict=True):
        found.append(re.escape(text))
        if name:
            found.append(f"(?P={name})" if f"(?P<{name}>[^/]+)" in found else f"(?P<{name}>[^/]+)")
    return re.compile("".join(found))


def _address(path: str, file: str) -> str:
    """Return the address of a path as a file imports it."""
    address = posixpath.relpath(path, posixpath.dirname(file) or ".")
    return address if address[0] == "." else f"./{address}"


def _name(path: str) -> str:
    """Return the name of a module inside a file."""
    return "$" + re.sub(r"\W", "_", path.removesuffix(".js"))


def _taken(one: _Import) -> str:
    return f"const {{ {one.names} }} = {_name(one.path)};\n"


def _function(module: _Module, body: str) -> str:
    """Return the module as a function that is called at once, and answers what it exports."""
    body = _EXPORT.sub("", body)
    waits = _AWAITS.search(body)
    begin = "await (async () => {" if waits else "(() => {"
    exported = ", ".join(module.exports)
    return f"const {_name(module.path)} = {begin}\n{body}return {{ {exported} }};\n}})();\n"


def _joinable(modules: dict[str, _Module]) -> dict[str, _Module]:
    """Return modules that can be joined: no circles, and imported by joinable modules only."""
    names = {path: module.wants for path, module in modules.items()}
    others = [path for path, module in modules.items() if not module.is_like_others]
    others += _in_circles(names)
    left_out: set[str] = set()
    while others:
        path = others.pop()
        if path not in left_out:
            left_out.add(path)
            others += names.get(path, ())
    return {path: module for path, module in modules.items() if path not in left_out}


def _in_circles(names: Mapping[str, list[str]]) -> set[str]:
    found: set[str] = set()
    while True:
        left = {path: set(names[path]) - found for path in names.keys() - found}
        try:
            TopologicalSorter(left).prepare()
        except CycleError as error:
            found.update(error.args[1])
        else:
            return found


def bare(text: str) -> str:
    """Return a module without its comments, its indentation and its empty lines."""
    pieces: list[str] = []
    for piece in _bare(text):
        if piece and (piece != "\n" or (pieces and pieces[-1][-1] != "\n")):
            pieces.append(piece)
    return "".join(pieces)


def _bare(text: str) -> Iterator[str]:
    at, depth = 0, 0
    templates: list[int] = []  # of each that is open, how deep its `${` stands
    end = len(text)
    while at < end:
        token = _TOKEN.search(text, at)
        if token is None:
            break
        yield text[at : token.start()]
        at = token.end()
        kind = token.lastgroup
        if kind == "comment":
            continue
        if kind == "line":
            yield "\n"
            continue
        yield token[0]
        if kind == "open":
            depth += 1
        in_template = kind == "quote"
        if kind == "close":
            in_template = bool(templates) and templates[-1] == depth
            if in_template:
                templates.pop()
            else:
                depth -= 1
        if in_template and (rest := _TEMPLATE.match(text, at)):
            yield rest[0]
            at = rest.end()
            if rest["end"] == "${":
                templates.append(depth)
    yield text[at:]
