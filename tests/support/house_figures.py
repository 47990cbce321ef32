"""Figures of the house as it stands: `python -m tests.support.house_figures [FOLDER]`.

Counts of files and lines, what imports take of them, how many files have one importer, the longest
chain of imports, and the circles, once with what is imported for types only. `FOLDER` looks at a
part of `studio/` alone.
"""

from __future__ import annotations

import argparse
import ast
import re
import statistics
import sys
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

REPOSITORY = Path(__file__).resolve().parents[2]
PAGE_IMPORT = re.compile(
    r"""^\s*(?:import|export)\b[^"';]*?from\s*["']([^"']+)["']""", re.MULTILINE
)


@dataclass(frozen=True)
class SourceFile:
    """One module: which modules it imports when it runs, and which for their types only."""

    module: str
    lines: int
    import_lines: int
    runs: frozenset[str]
    types: frozenset[str]

    @property
    def imports(self) -> frozenset[str]:
        """All of them."""
        return self.runs | self.types


def module_of(path: Path) -> str:
    """Dotted name of a file below the repository."""
    parts = path.relative_to(REPOSITORY).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def python_files(folder: Path) -> dict[str, SourceFile]:
    """Every module below `folder`, by its name; of imports only those among `studio`'s modules."""
    paths = {module_of(path): path for path in sorted((REPOSITORY / "studio").rglob("*.py"))}
    inside = {name: path for name, path in paths.items() if path.is_relative_to(folder)}
    return {name: _read(name, path, frozenset(paths)) for name, path in inside.items()}


def _read(module: str, path: Path, modules: frozenset[str]) -> SourceFile:
    text = path.read_text(encoding="utf-8")
    tree = ast.parse(text)
    typed = {
        id(node)
        for block in ast.walk(tree)
        if isinstance(block, ast.If) and ast.unparse(block.test) == "TYPE_CHECKING"
        for node in ast.walk(block)
    }
    runs: set[str] = set()
    types: set[str] = set()
    import_lines = 0
    for node in ast.walk(tree):
        if isinstance(node, ast.Import | ast.ImportFrom):
            import_lines += (node.end_lineno or node.lineno) - node.lineno + 1
            (types if id(node) in typed else runs).update(_targets(node, modules) - {module})
    return SourceFile(
        module, len(text.splitlines()), import_lines, frozenset(runs), frozenset(types - runs)
    )


def _targets(node: ast.Import | ast.ImportFrom, modules: frozenset[str]) -> set[str]:
    if isinstance(node, ast.Import):
        return {alias.name for alias in node.names} & modules
    of_names = {f"{node.module}.{alias.name}" for alias in node.names} & modules
    whole = {node.module or ""} & modules if len(of_names) < len(node.names) else set[str]()
    return of_names | whole


def circles(graph: dict[str, frozenset[str]]) -> list[list[str]]:
    """Groups of two and more nodes that all reach each other, the largest first."""
    reached = {node: _reached_from(node, graph) for node in graph}
    groups = {
        frozenset(other for other in far if node in reached[other])
        for node, far in reached.items()
        if node in far
    }
    return sorted((sorted(group) for group in groups), key=len, reverse=True)


def _reached_from(start: str, graph: dict[str, frozenset[str]]) -> set[str]:
    """What `start` imports, directly or not; itself only along a circle."""
    reached: set[str] = set()
    waiting = [start]
    while waiting:
        news = (graph[waiting.pop()] & graph.keys()) - reached
        reached |= news
        waiting += news
    return reached


def longest_chain(graph: dict[str, frozenset[str]]) -> list[str]:
    """The longest way along imports; a circle is left at its first repetition."""
    best: dict[str, list[str]] = {}

    def below(node: str, above: frozenset[str]) -> list[str]:
        if node not in best:
            under = above | {node}
            rest = [below(one, under) for one in sorted(graph[node] & graph.keys() - under)]
            best[node] = [node, *_longest(rest)]
        return best[node]

    return _longest(below(node, frozenset()) for node in sorted(graph))


def _longest(chains: Iterable[list[str]]) -> list[str]:
    return max(chains, key=len, default=list[str]())


def python_figures(folder: Path) -> Iterator[str]:
    """Give the figures of the Python files."""
    files = python_files(folder)
    lines = [file.lines for file in files.values()]
    importers: dict[str, set[str]] = defaultdict(set)
    for file in python_files(REPOSITORY / "studio").values():
        for one in file.imports:
            importers[one].add(file.module)
    alone = [name for name in files if len(importers[name]) == 1]
    runs = {name: file.runs for name, file in files.items()}
    every = {name: file.imports for name, file in files.items()}
    import_share = sum(file.import_lines for file in files.values()) / sum(lines)
    yield f"files                      {len(files)}"
    yield f"lines                      {sum(lines)}"
    yield f"median file                {statistics.median(lines):.0f} lines"
    yield f"over 600 lines             {sum(count > 600 for count in lines)}"
    yield f"imports                    {import_share:.1%} of the lines"
    yield f"one importer               {len(alone) / len(files):.0%} of the files"
    yield f"types imported apart       {sum(bool(file.types) for file in files.values())} files"
    chain = longest_chain(runs)
    yield f"longest chain of imports   {len(chain)}"
    yield f"  {' > '.join(name.removeprefix('studio.') for name in chain)}"
    yield f"circles as it runs         {[len(one) for one in circles(runs)]}"
    with_types = circles(every)
    yield f"circles with types         {[len(one) for one in with_types]}"
    for one in with_types:
        yield f"  {' '.join(name.removeprefix('studio.') for name in one)}"


def page_figures() -> Iterator[str]:
    """Give the figures of the page's modules."""
    root = REPOSITORY / "frontend_assets"
    paths = [
        path
        for path in sorted(root.rglob("*.js"))
        if not {"vendor", "node_modules", "tools"} & set(path.relative_to(root).parts)
    ]
    importers: dict[Path, set[Path]] = defaultdict(set)
    for path in paths:
        for target in PAGE_IMPORT.findall(path.read_text(encoding="utf-8")):
            importers[(path.parent / target).resolve()].add(path)
    lines = [len(path.read_text(encoding="utf-8").splitlines()) for path in paths]
    alone = sum(len(importers[path]) == 1 for path in paths)
    yield f"modules                    {len(paths)}"
    yield f"lines                      {sum(lines)}"
    yield f"median module              {statistics.median(lines):.0f} lines"
    yield f"one importer               {alone / len(paths):.0%} of the modules"


def main() -> None:
    """Print what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default="studio")
    folder = parser.parse_args().folder
    lines = [f"== {folder}", *python_figures((REPOSITORY / folder).resolve())]
    if folder == "studio":
        lines += ["== frontend_assets", *page_figures()]
    sys.stdout.writelines(f"{line}\n" for line in lines)


if __name__ == "__main__":
    main()
