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
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

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
    """Groups of two and more nodes that reach each other, the largest first (Tarjan 1972)."""
    index: dict[str, int] = {}
    low: dict[str, int] = {}
    stack: list[str] = []
    found: list[list[str]] = []

    def visit(root: str) -> None:
        work = [(root, iter(sorted(graph[root])))]
        index[root] = low[root] = len(index)
        stack.append(root)
        while work:
            node, rest = work[-1]
            for other in rest:
                if other not in graph:
                    continue
                if other not in index:
                    index[other] = low[other] = len(index)
                    stack.append(other)
                    work.append((other, iter(sorted(graph[other]))))
                    break
                if other in stack:
                    low[node] = min(low[node], index[other])
            else:
                work.pop()
                if work:
                    low[work[-1][0]] = min(low[work[-1][0]], low[node])
                if low[node] == index[node]:
                    cut = stack.index(node)
                    group = stack[cut:]
                    del stack[cut:]
                    if len(group) > 1:
                        found.append(sorted(group))

    for node in sorted(graph):
        if node not in index:
            visit(node)
    return sorted(found, key=len, reverse=True)


def longest_chain(graph: dict[str, frozenset[str]]) -> list[str]:
    """The longest way along imports; a circle is left at its first repetition."""
    best: dict[str, list[str]] = {}

    def below(node: str, above: frozenset[str]) -> list[str]:
        if node not in best:
            under = above | {node}
            rest = [below(one, under) for one in sorted(graph[node] & graph.keys() - under)]
            best[node] = [node, *max(rest, key=len, default=[])]
        return best[node]

    return max((below(node, frozenset()) for node in sorted(graph)), key=len, default=[])


def print_python(folder: Path) -> None:
    """Print the figures of the Python files."""
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
    print(f"files                      {len(files)}")
    print(f"lines                      {sum(lines)}")
    print(f"median file                {statistics.median(lines):.0f} lines")
    print(f"over 600 lines             {sum(count > 600 for count in lines)}")
    print(f"imports                    {import_share:.1%} of the lines")
    print(f"one importer               {len(alone) / len(files):.0%} of the files")
    print(f"types imported apart       {sum(bool(file.types) for file in files.values())} files")
    chain = longest_chain(runs)
    print(f"longest chain of imports   {len(chain)}")
    print(f"  {' > '.join(name.removeprefix('studio.') for name in chain)}")
    print(f"circles as it runs         {[len(one) for one in circles(runs)]}")
    with_types = circles(every)
    print(f"circles with types         {[len(one) for one in with_types]}")
    for one in with_types:
        print(f"  {' '.join(name.removeprefix('studio.') for name in one)}")


def print_page() -> None:
    """Print the figures of the page's modules."""
    root = REPOSITORY / "frontend_assets"
    paths = [
        path
        for path in sorted(root.rglob("*.js"))
        if not {"vendor", "node_modules", "tools"} & set(path.relative_to(root).parts)
    ]
    importers: dict[Path, set[Path]] = defaultdict(set)
    for path in paths:
        for target in PAGE_IMPORT.findall(path.read_text(encoding="utf-8")):
            if target.startswith("."):
                importers[(path.parent / target).resolve()].add(path)
    lines = [len(path.read_text(encoding="utf-8").splitlines()) for path in paths]
    alone = sum(len(importers[path]) == 1 for path in paths)
    print(f"modules                    {len(paths)}")
    print(f"lines                      {sum(lines)}")
    print(f"median module              {statistics.median(lines):.0f} lines")
    print(f"one importer               {alone / len(paths):.0%} of the modules")


def main() -> None:
    """Print what was asked for."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", nargs="?", default="studio")
    given = parser.parse_args()
    print(f"== {given.folder}")
    print_python((REPOSITORY / given.folder).resolve())
    if given.folder == "studio":
        print("== frontend_assets")
        print_page()


if __name__ == "__main__":
    main()
