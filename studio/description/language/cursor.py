"""A place in a text, with the element of the run that it is in."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

from studio.description.language.token_at import (
    Where,
    declarations_in,
    open_tags,
    segment_at,
    token_at,
)
from studio.description.syntax.attribute_spans import attribute_text
from studio.description.syntax.params import name_in_params
from studio.description.syntax.templates import Cut

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.description.editing.editor_text import EditorText
    from studio.description.evaluator.graph import Scope
    from studio.description.language.questions import SubjectKind, TextPlace
    from studio.description.language.reading import Reading
    from studio.description.language.token_at import Segment, Tag, Token
    from studio.description.language.watched_run import Evaluated, Trace
    from studio.description.syntax.source_tree import SourceElement


@dataclass
class Cursor:
    """A cursor before the character `index` of a text; `file` is resolved."""

    reading: Reading
    file: str
    editor: EditorText
    index: int

    @property
    def text(self) -> str:
        """The text as the editor shows it."""
        return self.editor.text

    @property
    def is_yaml(self) -> bool:
        """Whether the file is YAML, not XML."""
        return self.file.lower().endswith((".yaml", ".yml"))

    @property
    def trace(self) -> Trace | None:
        """The watched run."""
        return self.reading.trace

    @cached_property
    def token(self) -> Token:
        """The token that it is in."""
        return token_at(self.text, self.index)

    @cached_property
    def segment(self) -> Segment | None:
        """The `${...}` or `$(...)` that it is in."""
        if self.token.where not in {Where.VALUE, Where.CONTENT}:
            return None
        return segment_at(self.text, self.token, self.index)

    @cached_property
    def around(self) -> tuple[Tag, ...]:
        """The tags that are open around the tag or text that it is in, the outermost first."""
        tag = self.token.tag
        return open_tags(self.text, self.index if tag is None else tag.start)

    @cached_property
    def tag(self) -> Tag | None:
        """The tag that it is in, or in whose content."""
        if self.token.tag is not None:
            return self.token.tag
        return self.around[-1] if self.around else None

    @cached_property
    def element(self) -> SourceElement | None:
        """That tag's element in the run."""
        return self.element_of(self.tag) if self.tag else None

    @cached_property
    def macro(self) -> Tag | None:
        """The `xacro:macro` that it is in the body of."""
        return next((one for one in reversed(self.around) if one.name == "xacro:macro"), None)

    def element_of(self, tag: Tag) -> SourceElement | None:
        """Return the element of the run that a tag of this text is."""
        byte = self.editor.byte_at(self.editor.offset_of(tag.start))
        return self.reading.element_at(self.file, byte, tag.name)

    def written(self, tag: Tag, attribute: str) -> str:
        """Return the text of an attribute; empty when it has none."""
        found = next((one for one in tag.attributes if one.name == attribute), None)
        return "" if found is None or found.start < 0 else self.plain(found.start, found.end)

    def plain(self, start: int, end: int) -> str:
        """Return a stretch of the text as XML reads it: references resolved, blanks to spaces."""
        return attribute_text(self.text[start:end].encode("utf-8", "replace"))

    def offsets(self, start: int, end: int) -> tuple[int, int]:
        """Offsets of the editor for indices of the text."""
        return self.editor.offset_of(start), self.editor.offset_of(end)

    def evaluated(self, segment: Segment) -> list[Evaluated]:
        """Return the values of a segment of this element in the run, once per call."""
        if self.trace is None or self.element is None:
            return []
        cut = Cut.EXPRESSION if segment.is_expression else Cut.SUBSTITUTION
        text = self.plain(segment.start, segment.end)
        seen = self.trace.seen
        found = seen.evaluated.get((self.element, cut, text))
        if found is None and self.element.tag == "xacro:macro":  # a default: it belongs to calls
            calls = (call.element for call in seen.calls.get(self.element, ()))
            found = [one for call in calls for one in seen.evaluated.get((call, cut, text), ())]
        return found or []

    def scopes(self) -> list[Scope]:
        """Return the names that can be read here, as the run had them; the likeliest first."""
        if self.trace is None:
            return []
        if self.segment and (exact := self.evaluated(self.segment)):
            return [one.scope for one in exact]
        macro = self.element_of(self.macro) if self.macro else None
        calls = self.trace.seen.calls.get(macro, ()) if macro else ()
        if calls:
            return [one.scope for one in calls]
        includes = [one.scope for one in self.trace.seen.includes if one.file == self.file]
        return includes or [self.trace.scope]

    @cached_property
    def declarations(self) -> tuple[Tag, ...]:
        """The properties, args and macros that this text declares, whether a run saw it or not."""
        return tuple(declarations_in(self.text))

    def open_before(self, index: int) -> tuple[Tag, ...]:
        """Return the tags that are open before a character, the outermost first."""
        return open_tags(self.text, index)

    def defining(self, tag: str, name: str) -> tuple[SourceElement, ...]:
        """Return the properties or args of a name in the run, those of this file first."""
        definitions = self.reading.definitions
        found = definitions.named(tag, name) if definitions else []
        return tuple(sorted(found, key=lambda one: one.tree.path != self.file))

    def declared(self, kind: SubjectKind, name: str) -> tuple[TextPlace, ...]:
        """Return where this text itself declares a name; for texts that no run has seen."""
        found = (one for tag in self._declaring(kind, name) for one in tag.attributes)
        return tuple(self.place(one.start, one.end) for one in found if one.name == "name")

    def declared_text(self, kind: SubjectKind, name: str) -> str:
        """Return the value that this text gives a name; empty if it does not declare it."""
        for tag in self._declaring(kind, name):
            return self.written(tag, "value") or self.written(tag, "default")
        return ""

    def _declaring(self, kind: SubjectKind, name: str) -> Iterator[Tag]:
        wanted = f"xacro:{kind.value}"
        named = (one for one in self.declarations if one.name == wanted)
        return (one for one in named if self.written(one, "name") == name)

    def parameter_of(self, macro: Tag, name: str) -> TextPlace:
        """Return where a macro of this text names a parameter."""
        params = next((one for one in macro.attributes if one.name == "params"), None)
        at = -1 if params is None else name_in_params(self.text[params.start : params.end], name)
        if params is None or at < 0:
            return self.place(macro.start, macro.name_end)
        return self.place(params.start + at, params.start + at + len(name))

    def place(self, start: int, end: int) -> TextPlace:
        """Return a stretch of this text as a place."""
        first, last = (self.editor.byte_at(offset) for offset in self.offsets(start, end))
        return self.reading.places(self.file).place(first, last)
