"""How the elements of a part are named: `visual[2]/origin`, numbered where there are several."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.evaluator.output_tree import OutputElement


def walk_named(top: OutputElement, path: str = "") -> Iterator[tuple[str, OutputElement]]:
    """A part and every element below it in document order, each with its path inside the part.

    The part's own path is empty.
    """
    yield path, top
    counts: dict[str, int] = {}
    for child in top.elements():
        counts[child.tag] = counts.get(child.tag, 0) + 1
    seen: dict[str, int] = {}
    for child in top.elements():
        seen[child.tag] = number = seen.get(child.tag, 0) + 1
        name = f"{child.tag}[{number}]" if counts[child.tag] > 1 else child.tag
        yield from walk_named(child, f"{path}/{name}" if path else name)


def tags_of(path: str) -> tuple[str, ...]:
    """The tags of a path, without their numbers."""
    return tuple(step.partition("[")[0] for step in path.split("/")) if path else ()
