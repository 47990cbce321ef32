"""A setup.py as it is written: what it gives to `setup()`, with its bytes; it is never run."""

from __future__ import annotations

import ast
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Final

from studio.packages.sources.python_file import PythonFile, last_name
from studio.packages.sources.scripts import GROUP, Script

if TYPE_CHECKING:
    from collections.abc import Iterator

FILE_NAME: Final = "setup.py"
_DEPTH_MAX: Final = 40
_STEPS_MAX: Final = 100_000
"""Expressions that are looked at: `a = [*a, *a]` has no end."""
_TEXT_MAX: Final = 10_000
"""Characters of a text that is put together: so has `a = a + a`."""


@dataclass(frozen=True, slots=True)
class DataFiles:
    """One pair of `data_files`: where to, and which files or patterns."""

    destination: str | None
    """None: it is computed."""
    sources: tuple[str, ...]
    start: int
    end: int
    line: int
    is_whole: bool
    """Whether every source could be read without running anything."""


class SetupPy:
    """What a setup.py says, as far as it can be known without running it."""

    def __init__(self, file: str, data: bytes) -> None:
        self.python = PythonFile(file, data)
        self.source = self.python.source
        self.constants: dict[str, str] = {}
        """Texts by the names that the module gives them."""
        self._values: dict[str, ast.expr] = {}
        """Lists and dictionaries by theirs."""
        self._steps = 0
        self.call: ast.Call | None = None
        if self.python.tree is not None:
            self._look(self.python.tree)
        self._keywords: dict[str, ast.expr] = {}
        for one in self.call.keywords if self.call else ():
            if one.arg:
                self._keywords[one.arg] = one.value

    @property
    def fault(self) -> str:
        """Why it cannot be read, as the end of a sentence."""
        return self.python.fault

    def keyword(self, name: str) -> ast.expr | None:
        """Return what `setup()` gets by this name."""
        return self._keywords.get(name)

    def text(self, name: str) -> str | None:
        """Return the text of a keyword; None if there is none, or it is computed."""
        value = self._keywords.get(name)
        return None if value is None else self.string(value)

    def string(self, node: ast.expr, depth: int = 0) -> str | None:
        """Return what an expression of texts gives; None if that needs to be run."""
        self._steps += 1
        if depth > _DEPTH_MAX or self._steps > _STEPS_MAX:
            return None
        if isinstance(node, ast.Constant):
            return node.value if isinstance(node.value, str) else None
        if isinstance(node, ast.Name):
            return self.constants.get(node.id)
        found = self._put_together(node, depth)
        return found if found is not None and len(found) <= _TEXT_MAX else None

    def _put_together(  # noqa: PLR0911 - a form each
        self, node: ast.expr, depth: int
    ) -> str | None:
        match node:
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return self._joined([left, right], "", depth)
            case ast.BinOp(left=left, op=ast.Mod(), right=right):
                form, word = self.string(left, depth + 1), self.string(right, depth + 1)
                return None if form is None or word is None else form.replace("%s", word, 1)
            case ast.JoinedStr(values=values):
                return self._joined(values, "", depth)
            case ast.FormattedValue(value=value, conversion=-1, format_spec=None):
                return self.string(value, depth + 1)
            case ast.Call(func=func, args=args) if last_name(func) == "join":
                return self._joined(args, "/", depth)
            case ast.Call(func=func, args=[value]) if last_name(func) in {"str", "Path"}:
                return self.string(value, depth + 1)
            case _:
                return None

    def _joined(self, nodes: list[ast.expr], by: str, depth: int) -> str | None:
        parts = [self.string(one, depth + 1) for one in nodes]
        known = [one for one in parts if one is not None]
        return by.join(known) if len(known) == len(parts) else None

    def items(self, node: ast.expr | None, depth: int = 0) -> list[ast.expr]:
        """Return the items of a list that is written out, also by a name, a sum or a star.

        A part that is computed is one item, itself.
        """
        self._steps += 1
        if node is None or depth > _DEPTH_MAX or self._steps > _STEPS_MAX:
            return [] if node is None else [node]
        match node:
            case ast.List(elts=elts) | ast.Tuple(elts=elts):
                found: list[ast.expr] = []
                for one in elts:
                    is_starred = isinstance(one, ast.Starred)
                    found += self.items(one.value, depth + 1) if is_starred else [one]
                return found
            case ast.BinOp(left=left, op=ast.Add(), right=right):
                return [*self.items(left, depth + 1), *self.items(right, depth + 1)]
            case ast.Name(id=name) if name in self._values:
                return self.items(self._values[name], depth + 1)
            case _:
                return [node]

    def _dictionary(self, node: ast.expr | None) -> ast.Dict | None:
        if isinstance(node, ast.Name):
            node = self._values.get(node.id)
        return node if isinstance(node, ast.Dict) else None

    @cached_property
    def packages(self) -> tuple[str, ...] | None:
        """The Python packages that it lists; None: they are found, or computed."""
        value = self._keywords.get("packages")
        names = [self.string(one) for one in self.items(value)]
        known = tuple(one for one in names if one is not None)
        return known if value is not None and len(known) == len(names) else None

    @property
    def finds_packages(self) -> bool:
        """Whether it has setuptools find its packages: folders with an `__init__.py`."""
        value = self._keywords.get("packages")
        return isinstance(value, ast.Call) and last_name(value.func) == "find_packages"

    @cached_property
    def package_dir(self) -> dict[str, str]:
        """The folders of Python packages by their names; that of the empty name holds all."""
        value = self._dictionary(self._keywords.get("package_dir"))
        rows = zip(value.keys, value.values, strict=True) if value else ()
        texts = ((self.string(key), self.string(one)) for key, one in rows if key is not None)
        return {key: one for key, one in texts if key is not None and one is not None}

    @property
    def entry_points(self) -> ast.Dict | None:
        """The dictionary of `entry_points`."""
        return self._dictionary(self._keywords.get("entry_points"))

    @cached_property
    def _scripts_value(self) -> ast.expr | None:
        """What `console_scripts` is: in `entry_points`, else wherever a dictionary has it."""
        entries = self.entry_points
        nodes = self.python.nodes if entries is None else (entries,)
        for node in nodes:
            for key, value in zip(*_rows(node), strict=True):
                if isinstance(key, ast.Constant) and key.value == GROUP:
                    return value
        return None

    @property
    def scripts_list(self) -> ast.List | None:
        """The list of `console_scripts`, where it is written out."""
        value = self._scripts_value
        if isinstance(value, ast.Name):
            value = self._values.get(value.id)
        return value if isinstance(value, ast.List) else None

    @cached_property
    def scripts(self) -> tuple[Script, ...]:
        """The entries of `console_scripts`."""
        found: list[Script] = []
        for one in self.items(self._scripts_value):
            text = self.string(one)
            if text is not None:
                start, end = self.python.span(one)
                found.append(Script(text, start, end, one.lineno, self.source))
        return tuple(found)

    @property
    def data_files_list(self) -> ast.List | None:
        """The list of `data_files`, where it is written out."""
        value = self._keywords.get("data_files")
        return value if isinstance(value, ast.List) else None

    @cached_property
    def data_files(self) -> tuple[DataFiles, ...]:
        """What it installs beside its modules."""
        return tuple(self._data_files(self.items(self._keywords.get("data_files"))))

    @property
    def computes_data_files(self) -> bool:
        """Whether it installs more than what is written out."""
        value = self._keywords.get("data_files")
        return value is not None and (
            not isinstance(value, ast.List)
            or any(not isinstance(one, ast.Tuple | ast.List) for one in value.elts)
        )

    def _data_files(self, rows: list[ast.expr]) -> Iterator[DataFiles]:
        for row in rows:
            if not isinstance(row, ast.Tuple | ast.List) or len(row.elts) != 2:
                continue
            where, what = row.elts
            sources = [self._source(one) for one in self.items(what)]
            start, end = self.python.span(row)
            known = tuple(one for one in sources if one is not None)
            is_whole = len(known) == len(sources)
            yield DataFiles(self.string(where), known, start, end, row.lineno, is_whole)

    def _source(self, node: ast.expr) -> str | None:
        """Return a file or a pattern; None for what is computed."""
        if isinstance(node, ast.Call) and node.args and last_name(node.func) in {"glob", "iglob"}:
            return self.string(node.args[0])
        return self.string(node)

    def imports(self, module: str, name: str = "") -> bool:
        """Whether `import module`, or `from module import name`, stands at its top."""
        tree = self.python.tree
        wanted = ast.ImportFrom if name else ast.Import
        return any(
            isinstance(node, wanted)
            and (not name or getattr(node, "module", None) == module)
            and any(one.name == (name or module) and one.asname is None for one in node.names)
            for node in (tree.body if tree else ())
        )

    def _look(self, tree: ast.Module) -> None:
        for node in tree.body:
            match node:
                case ast.Assign(targets=[ast.Name(id=name)], value=value):
                    text = self.string(value)
                    if text is not None:
                        self.constants[name] = text
                    elif isinstance(value, ast.List | ast.Tuple | ast.Dict | ast.BinOp):
                        self._values[name] = value
                case ast.Expr(value=ast.Call() as call) if self._is_setup(call):
                    self.call = self.call or call
                case _:
                    pass
        if self.call is None:
            calls = (one for one in ast.walk(tree) if isinstance(one, ast.Call))
            self.call = next((one for one in calls if self._is_setup(one)), None)

    @staticmethod
    def _is_setup(call: ast.Call) -> bool:
        return last_name(call.func) == "setup"


def _rows(node: ast.AST) -> tuple[list[ast.expr | None], list[ast.expr]]:
    return (node.keys, node.values) if isinstance(node, ast.Dict) else ([], [])
