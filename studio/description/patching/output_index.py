"""Where things came out: by the source element, and by the part that they are in."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.evaluator.parts import part_keys
from studio.description.syntax.source_tree import SourceText

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.syntax.source_tree import SourceElement


class OutputIndex:
    """The tree of one run, looked up from below. Attributes and texts may change meanwhile."""

    def __init__(self, root: OutputElement) -> None:
        self.root = root
        self.keys = {element: key for key, element in part_keys(root)}
        """The key of each part, by its element, in the order of the robot."""
        self.part_of: dict[OutputElement, OutputElement] = {}
        """The part's element, by any element in it; what did not come out is missing."""
        self.came_out: dict[SourceElement, list[OutputElement]] = {root.origin: [root]}
        """The elements that each source element came out as."""
        for part in self.keys:
            for element in part.walk():
                self.part_of[element] = part
                self.came_out.setdefault(element.origin, []).append(element)

    def keys_by_source(self) -> dict[SourceElement, tuple[str, ...]]:
        """Which parts each source element came out in; one that is in no part is missing."""
        found: dict[SourceElement, dict[str, None]] = {}
        for element, part in self.part_of.items():
            found.setdefault(element.origin, {})[self.keys[part]] = None
        return {element: tuple(keys) for element, keys in found.items()}

    @cached_property
    def parts_of_text(self) -> Mapping[SourceText, list[OutputElement]]:
        """The parts in which a text came out; copies of a block share their texts."""
        found: dict[SourceText, list[OutputElement]] = {}
        for element, part in self.part_of.items():
            for child in element.children:
                if isinstance(child, SourceText):
                    found.setdefault(child, []).append(part)
        return found
