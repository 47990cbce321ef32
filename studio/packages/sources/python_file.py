"""A Python file, parsed and never run: its tree with bytes and lines, or why it has none."""

from __future__ import annotations

import ast
import warnings
from functools import cached_property
from itertools import islice
from typing import TYPE_CHECKING, Final

from studio.packages.sources.spans import SourceText

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

SIZE_LIMIT_BYTES: Final = 1 << 20
NODES_MAX: Final = 200_000
"""A file with more is generated: it is left alone."""


class PythonFile:
    """One file; `tree` is None when Python could not compile it, and `fault` says why."""

    def __init__(self, file: str, data: bytes) -> None:
        self.source = SourceText(file, data)
        self.tree: ast.Module | None = None
        self.nodes: tuple[ast.AST, ...] = ()
        """Every node of the tree."""
        self.fault = ""
        """As the end of a sentence."""
        self.fault_line = 0
        self._parse(data)

    def _parse(self, data: bytes) -> None:
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")  # of invalid escapes: they are the user's
                tree = ast.parse(data)
        except SyntaxError as error:
            self.fault, self.fault_line = error.msg or "invalid syntax", error.lineno or 0
        except (ValueError, RecursionError, MemoryError) as error:
            reason = "is nested too deeply" if isinstance(error, RecursionError) else str(error)
            self.fault, self.fault_line = reason or "cannot be read", 1
        else:
            nodes = tuple(islice(ast.walk(tree), NODES_MAX + 1))
            if len(nodes) > NODES_MAX:
                self.fault, self.fault_line = "is too large to be looked at", 1
            else:
                self.tree, self.nodes = tree, nodes

    def span(self, node: ast.expr | ast.stmt | ast.alias | ast.keyword) -> tuple[int, int]:
        """Return the first byte of a node, and the one behind it."""
        start = self.offset(node.lineno, node.col_offset)
        end = self.offset(node.end_lineno or node.lineno, node.end_col_offset or 0)
        return start, end

    def offset(self, line: int, column_bytes: int) -> int:
        """Return the byte of a place as the parser counts; a mark at the file's start is extra."""
        mark = 3 if line == 1 and self.source.data.startswith(b"\xef\xbb\xbf") else 0
        return self.source.offset(line, column_bytes + mark)

    @cached_property
    def imports(self) -> tuple[Import, ...]:
        """Every import, wherever it stands."""
        return tuple(_imports(self.nodes))

    @cached_property
    def top_level_names(self) -> frozenset[str]:
        """The names that its module has."""
        return frozenset(bound_names(self.tree.body if self.tree else ()))

    @property
    def top_level_functions(self) -> tuple[str, ...]:
        """The functions of its module itself, in their order."""
        body = self.tree.body if self.tree else ()
        return tuple(one.name for one in body if isinstance(one, ast.FunctionDef))

    def may_have(self, name: str) -> bool:
        """Whether its module has a name; True also where that cannot be told without running it."""
        names = self.top_level_names
        return self.tree is None or not names.isdisjoint({name, "*", "__getattr__"})


def last_name(node: ast.AST | None) -> str:
    """Return the last word of a dotted name: `join` of `os.path.join`; empty: it is no name."""
    if isinstance(node, ast.Name):
        return node.id
    return node.attr if isinstance(node, ast.Attribute) else ""


class Import:
    """One name that is imported."""

    __slots__ = ("alias", "line", "module", "name", "node")

    def __init__(self, node: ast.Import | ast.ImportFrom, alias: ast.alias, module: str) -> None:
        self.node, self.alias, self.line = node, alias, alias.lineno
        self.module = module
        """Of `from module import name`, and of `import module`; relative ones keep their dots."""
        self.name = alias.name if isinstance(node, ast.ImportFrom) else ""

    @property
    def bound(self) -> str:
        """The name that the module has it by."""
        return self.alias.asname or self.name or self.module.partition(".")[0]

    @property
    def package(self) -> str:
        """The top-level package; empty for relative imports."""
        return self.module.partition(".")[0]


def _imports(nodes: tuple[ast.AST, ...]) -> Iterator[Import]:
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (Import(node, one, one.name) for one in node.names)
        elif isinstance(node, ast.ImportFrom):
            module = "." * node.level + (node.module or "")
            yield from (Import(node, one, module) for one in node.names)


_INNER: Final = (
    *(ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.Lambda),
    *(ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp),
)
"""What is inside them is bound in a scope of its own."""


def bound_names(nodes: Iterable[ast.AST]) -> Iterator[str]:
    """Yield each name that these nodes bind in the scope in which they stand."""
    waiting = list(nodes)  # no recursion: a sum of a thousand parts is a thousand levels deep
    while waiting:
        node = waiting.pop()
        yield from names_bound_by(node)
        if not isinstance(node, _INNER):
            waiting += ast.iter_child_nodes(node)


def names_bound_by(node: ast.AST) -> Iterator[str]:
    """Yield each name that a node itself binds, without those inside it."""
    match node:
        case ast.FunctionDef(name=name) | ast.AsyncFunctionDef(name=name):
            yield name
        case ast.ClassDef(name=name):
            yield name
        case ast.Import(names=names) | ast.ImportFrom(names=names):
            yield from (one.asname or one.name.partition(".")[0] for one in names)
        case ast.Name(id=name, ctx=ast.Store()):
            yield name
        case ast.MatchAs(name=str(name)) | ast.MatchStar(name=str(name)):
            yield name
        case ast.MatchMapping(rest=str(name)):
            yield name
        case ast.ExceptHandler(name=str(name)):
            yield name
        case _:
            pass
