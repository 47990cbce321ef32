"""Where a part comes from: its place, the calls that led there, and the inputs of each number."""

from __future__ import annotations

import re
from itertools import islice
from typing import TYPE_CHECKING, Final

from studio.description.evaluator.graph import Input, YamlValue
from studio.description.origins.origin_values import (
    InputKind,
    OriginAttribute,
    OriginCall,
    OriginCause,
    OriginInput,
    PartOrigin,
)
from studio.description.origins.tracing import (
    Given,
    Governor,
    TracedBinding,
    YamlSites,
    inputs_of,
    site_of_binding,
    written_at,
)
from studio.description.sites.widgets import quantity_of_attribute
from studio.description.syntax.attribute_spans import attribute_spans
from studio.description.syntax.params import param_defaults
from studio.description.syntax.source_tree import SourceText
from studio.description.values import SiteKind
from studio.errors import EditError
from studio.problems import Place

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator, Set

    from studio.description.evaluator.output_tree import CallFrame, OutputElement
    from studio.description.origins.tracing import Trace
    from studio.description.syntax.source_tree import SourceElement

_LINE_END: Final = re.compile(rb"\r\n?|\n")
ATTRIBUTES_KEPT: Final = 400
"""Limit for one part; PR2's largest has 130."""
INPUTS_KEPT: Final = 500
_TEXT_KEPT: Final = 2_000
"""Characters of a text or value; one may be a whole file."""
_KINDS: Final = {
    None: InputKind.PARAMETER,
    SiteKind.PROPERTY: InputKind.PROPERTY,
    SiteKind.ARG: InputKind.ARG,
    SiteKind.PARAM_DEFAULT: InputKind.PARAM_DEFAULT,
}
_GOVERNING_ATTRIBUTES: Final = ("value", "filename", "macro", "xacro:name", "name")


def part_origin(part: str, element: OutputElement, trace: Trace, sites: Set[str]) -> PartOrigin:
    """Return where a part of a traced run comes from.

    Args:
        part: Its key.
        element: Its element that came out.
        trace: The run.
        sites: Ids of the texts that can be edited.
    """
    return _Collector(trace, sites).of_part(part, element)


class _Collector:
    """Collects what is behind one part; each input once."""

    def __init__(self, trace: Trace, sites: Set[str]) -> None:
        self._trace, self._sites = trace, sites
        self._yaml = YamlSites(trace.yaml)
        self._numbers: dict[Input, int] = {}
        self._is_cut = False

    def of_part(self, part: str, top: OutputElement) -> PartOrigin:
        """Everything about one part."""
        attributes = tuple(islice(self._attributes(top), ATTRIBUTES_KEPT + 1))
        calls = tuple(self._call(frame) for frame in _frames(top.calls))
        causes = tuple(self._cause(one) for one in _governors(self._trace.governors.get(top)))
        inputs = self._all_inputs()
        place = top.origin.place
        return PartOrigin(
            part=part,
            place=place,
            include_chain=tuple(self._includes(place.file)),
            calls=calls,
            causes=causes,
            attributes=attributes[:ATTRIBUTES_KEPT],
            inputs=inputs,
            is_cut=self._is_cut or len(attributes) > ATTRIBUTES_KEPT,
        )

    def _includes(self, file: str) -> list[Place]:
        chain: list[Place] = []
        while (place := self._trace.included_at.get(file)) and place not in chain:
            chain.append(place)
            file = place.file
        return chain[::-1]

    def _attributes(self, top: OutputElement) -> Iterator[OriginAttribute]:
        is_slide = top.tag == "joint" and top.attributes.get("type") == "prismatic"
        above = "joint:prismatic/" if is_slide else ""
        for path, element in walk_named(top):
            for name, value in element.attributes.items():
                quantity = quantity_of_attribute(above + element.tag, name)
                yield self._attribute(path, element, name, value, quantity.unit if quantity else "")
            if text := self._text(path, element):
                yield text

    def _attribute(
        self, path: str, element: OutputElement, name: str, value: str, unit: str
    ) -> OriginAttribute:
        written = written_at(element, name)
        if written is None:  # an attribute that the namespace declarations of a root left
            place = element.origin.place
            return OriginAttribute(path, name, _cut(value), "", unit, place, "", ())
        source, attribute = written.element, written.attribute
        text = source.attributes.get(attribute, "")
        return OriginAttribute(
            element=path,
            attribute=name,
            value=_cut(value),
            text=_cut(text),
            unit=unit,
            place=attribute_place(source, attribute),
            site=self._known(f"{source.tree.path}#{source.ordinal}@{attribute}"),
            inputs=self._all(written.inputs),
        )

    def _text(self, path: str, element: OutputElement) -> OriginAttribute | None:
        texts = [child for child in element.children if isinstance(child, SourceText)]
        value = "".join(one.text for one in texts).strip()
        if not value:
            return None
        children = element.origin.children
        text = "".join(one.text for one in children if isinstance(one, SourceText)).strip()
        read = [one for child in texts for one in self._trace.text_inputs.get(child, ())]
        place, inputs = element.origin.place, self._all(read)
        return OriginAttribute(path, "", _cut(value), _cut(text), "", place, "", inputs)

    def _call(self, frame: CallFrame) -> OriginCall:
        called = self._trace.calls.get(frame)
        bound = called.parameters.values() if called else ()
        defined_at = called.macro.place if called else frame.call.place
        return OriginCall(frame.macro, frame.call.place, defined_at, self._all(bound))

    def _cause(self, governor: Governor) -> OriginCause:
        element = governor.element
        name = next((one for one in _GOVERNING_ATTRIBUTES if one in element.attributes), "")
        return OriginCause(
            tag=element.tag,
            text=_cut(element.attributes.get(name, "")),
            place=attribute_place(element, name),
            inputs=self._all(governor.inputs),
        )

    def _all(self, inputs: Iterable[Input]) -> tuple[int, ...]:
        """Return the numbers of inputs, and list them; what is no text is left out."""
        numbers = (self._number(one) for one in inputs)
        return tuple(dict.fromkeys(number for number in numbers if number is not None))

    def _number(self, one: Input) -> int | None:
        if one in self._numbers:
            return self._numbers[one]
        if isinstance(one, YamlValue) and self._yaml.site_of(one) is None:
            return None
        if not isinstance(one, TracedBinding | Given | YamlValue):
            return None
        if len(self._numbers) >= INPUTS_KEPT:
            self._is_cut = True
            return None
        return self._numbers.setdefault(one, len(self._numbers))

    def _all_inputs(self) -> tuple[OriginInput, ...]:
        """Return all inputs, and those behind them, which get their numbers on the way."""
        found: list[OriginInput] = []
        while len(found) < len(self._numbers):
            waiting = list(self._numbers)[len(found) :]
            found += [self._input(one) for one in waiting]
        return tuple(found)

    def _input(self, one: Input) -> OriginInput:
        match one:
            case TracedBinding():
                return self._binding(one)
            case YamlValue():
                return self._scalar(one)
            case Given():
                value = _cut(one.value)
                return OriginInput(
                    InputKind.ARG, one.name, "", value, Place(""), "", given=True, inputs=()
                )
            case _:
                raise TypeError(f"{one!r} is never numbered")

    def _binding(self, one: TracedBinding) -> OriginInput:
        is_default = one.kind is SiteKind.PARAM_DEFAULT
        return OriginInput(
            kind=_KINDS[one.kind],
            name=one.name,
            text=_cut(one.text),
            value=_cut(next(iter(one.values), "")),
            place=attribute_place(one.element, one.attribute, one.name if is_default else ""),
            site=self._known(site_of_binding(one)),
            given=one.overridden,
            inputs=self._all(one.inputs),
        )

    def _scalar(self, one: YamlValue) -> OriginInput:
        site = self._yaml.site_of(one)
        assert site is not None
        text = _cut(site.text)
        return OriginInput(
            InputKind.YAML,
            site.name,
            text,
            text,
            site.place,
            self._known(site.id),
            given=False,
            inputs=(),
        )

    def _known(self, site: str) -> str:
        return site if site in self._sites else ""


def _frames(frame: CallFrame | None) -> list[CallFrame]:
    frames: list[CallFrame] = []
    while frame is not None:
        frames.append(frame)
        frame = frame.outer
    return frames[::-1]


def _governors(innermost: Governor | None) -> list[Governor]:
    """Return those that read inputs of their own, the outermost first."""
    found: dict[Governor, None] = {}
    front = [innermost] if innermost else []
    while front:
        governor = front.pop()
        found.pop(governor, None)
        found[governor] = None
        front += [one for one in inputs_of(governor) if isinstance(one, Governor)]
    return [one for one in reversed(found) if one.own_inputs]


def _cut(text: str) -> str:
    return text if len(text) <= _TEXT_KEPT else text[:_TEXT_KEPT] + "..."


def attribute_place(element: SourceElement, attribute: str, param: str = "") -> Place:
    """Return where an attribute's text begins; with `param`, the default of that macro parameter.

    For an element without such an attribute it is the element's place.
    """
    data = element.tree.data
    try:
        span = attribute_spans(data, element.offset)[attribute]
        start = span.start
        if param:
            defaults = param_defaults(data, span, element.tree.encoding)
            start = next((one.span.start for one in defaults if one.name == param), start)
    except (EditError, KeyError):
        return element.place
    return _place_at(element, start)


def _place_at(element: SourceElement, byte: int) -> Place:
    """Return the place of a byte at or behind the `<` of an element."""
    before = element.tree.data[element.offset : byte]
    ends = list(_LINE_END.finditer(before))
    if not ends:
        column = element.place.column + _characters(element, before)
        return Place(element.tree.path, element.line, column)
    column = _characters(element, before[ends[-1].end() :]) + 1
    return Place(element.tree.path, element.line + len(ends), column)


def _characters(element: SourceElement, data: bytes) -> int:
    return len(data) if data.isascii() else len(data.decode(element.tree.encoding, "replace"))


def walk_named(top: OutputElement, path: str = "") -> Iterator[tuple[str, OutputElement]]:
    """Yield a part and every element below it in document order, with its path in the part.

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
    """Return the tags of a path, without their numbers."""
    return tuple(step.partition("[")[0] for step in path.split("/")) if path else ()
