"""Effects of a text: every attribute that would come out otherwise if the text were another."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

from studio.description.evaluator.output_tree import part_keys
from studio.description.origins.origin_values import Aspect, Effect, SiteEffects
from studio.description.origins.provenance import attribute_place, tags_of, walk_named
from studio.description.origins.tracing import (
    Governor,
    TracedBinding,
    inputs_by_site,
    inputs_of,
    written_at,
)
from studio.description.syntax.source_tree import SourceText

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

    from studio.description.evaluator.graph import Input
    from studio.description.evaluator.output_tree import OutputElement
    from studio.description.origins.tracing import Inputs, Trace
    from studio.description.syntax.source_tree import SourceElement

EFFECTS_KEPT: Final = 5_000
READERS_KEPT: Final = 500
_READING: Final = {
    "xacro:if": "value",
    "xacro:unless": "value",
    "xacro:include": "filename",
    "xacro:call": "macro",
    "xacro:element": "xacro:name",
    "xacro:property": "name",
}
_OF_LINKS: Final = {
    "inertial": Aspect.INERTIA,
    "collision": Aspect.COLLISION,
    "visual/origin": Aspect.POSE,
    "visual/material": Aspect.COLOR,
}
_OF_JOINTS: Final = {
    ("origin", "xyz"): Aspect.POSE,
    ("origin", "rpy"): Aspect.POSE,
    ("parent", "link"): Aspect.NAME,
    ("child", "link"): Aspect.NAME,
    ("mimic", "joint"): Aspect.NAME,
    ("", "name"): Aspect.NAME,
}


class _Text(NamedTuple):
    """A text of a source file: where it is read from, by element and attribute."""

    element: SourceElement
    attribute: str


class _Shaped(NamedTuple):
    """One attribute that came out, and the text that it is made of."""

    effect: Effect
    text: _Text


class Readers:
    """Readers of each value in one traced run, from the texts to what came out."""

    def __init__(self, trace: Trace) -> None:
        self._inputs = inputs_by_site(trace)
        self._dependents: dict[Input, list[TracedBinding | Governor]] = {}
        self._shaped: dict[Input, list[_Shaped]] = {}
        self._literals: dict[str, list[_Shaped]] = {}
        self._governed: dict[Governor, list[Effect]] = {}
        for one in (*trace.bindings, *_all_governors(trace)):
            for read in inputs_of(one):
                self._dependents.setdefault(read, []).append(one)
        for part, top in part_keys(trace.root):
            for path, element in walk_named(top):
                self._note_element(trace, part, path, element)
            self._note_governed(trace, part, top)

    def effects_of(self, site: str) -> SiteEffects:
        """Return all effects of one text, in the order of the robot, and its direct readers."""
        starts = self._inputs.get(site, [])
        reached = self._reached(starts)
        shaped = [one for read in reached for one in self._shaped.get(read, ())]
        shaped += self._literals.get(site, [])
        effects = dict.fromkeys(one.effect for one in shaped)
        for one in reached:
            if isinstance(one, Governor):
                effects.update(dict.fromkeys(self._governed.get(one, ())))
        decisions = {
            one.element
            for one in reached
            if isinstance(one, Governor) and not reached.keys().isdisjoint(one.own_inputs)
        }
        texts = list(dict.fromkeys(self._direct_readers(starts)))
        places = dict.fromkeys(attribute_place(*text) for text in texts[:READERS_KEPT])
        return SiteEffects(
            site=site,
            effects=tuple(effects)[:EFFECTS_KEPT],
            decisions=len(decisions),
            readers=tuple(places),
            is_cut=len(effects) > EFFECTS_KEPT or len(texts) > READERS_KEPT,
        )

    def _reached(self, starts: Iterable[Input]) -> dict[Input, None]:
        reached = dict.fromkeys(starts)
        front = list(reached)
        while front:
            for one in self._dependents.get(front.pop(), ()):
                if one not in reached:
                    reached[one] = None
                    front.append(one)
        return reached

    def _direct_readers(self, starts: Iterable[Input]) -> Iterator[_Text]:
        for start in starts:
            for one in self._dependents.get(start, ()):
                if isinstance(one, TracedBinding):
                    yield _Text(one.element, one.attribute)
                elif one.element.tag in _READING:
                    yield _Text(one.element, _READING[one.element.tag])
            yield from (one.text for one in self._shaped.get(start, ()))

    def _note_element(self, trace: Trace, part: str, path: str, element: OutputElement) -> None:
        for name in element.attributes:
            if written := written_at(element, name):
                effect = Effect(part, path, name, aspect_of(part, path, name))
                shaped = _Shaped(effect, _Text(written.element, written.attribute))
                self._note_shaped(shaped, written.inputs)
        for child in element.children:
            if isinstance(child, SourceText) and child in trace.text_inputs:
                effect = Effect(part, path, "", aspect_of(part, path, ""))
                shaped = _Shaped(effect, _Text(element.origin, ""))
                self._note_shaped(shaped, trace.text_inputs[child])

    def _note_shaped(self, shaped: _Shaped, inputs: Inputs) -> None:
        for read in inputs:
            self._shaped.setdefault(read, []).append(shaped)
        if not inputs:
            element, attribute = shaped.text
            site = f"{element.tree.path}#{element.ordinal}@{attribute}"
            self._literals.setdefault(site, []).append(shaped)

    def _note_governed(self, trace: Trace, part: str, top: OutputElement) -> None:
        """Note the outermost elements that each governor decides about."""
        governors = trace.governors
        around: dict[OutputElement, Governor | None] = {top: None}
        for path, element in walk_named(top):
            governor = governors.get(element)
            around.update((child, governor) for child in element.elements())
            if governor is not None and governor is not around[element]:
                effect = Effect(part, path, "", Aspect.PRESENCE)
                self._governed.setdefault(governor, []).append(effect)


def _all_governors(trace: Trace) -> list[Governor]:
    """Return every governor of the run that something came to be under."""
    found: dict[Governor, None] = {}
    front = [one for binding in trace.bindings for one in binding.inputs]
    front += trace.governors.values()
    front += trace.decisions
    while front:
        one = front.pop()
        if isinstance(one, Governor) and one not in found:
            found[one] = None
            front += inputs_of(one)
    return list(found)


def aspect_of(part: str, path: str, attribute: str) -> Aspect:
    """Return what an attribute means for its part; `part` is its key, `path` as of `walk_named`."""
    tags = tags_of(path)
    match part.partition(":")[0]:
        case "link":
            return _aspect_of_link(tags, attribute)
        case "joint":
            at = "/".join(tags), attribute
            return _OF_JOINTS.get(at, Aspect.MOTION)
        case "material":
            return Aspect.COLOR if tags else Aspect.NAME
        case _:
            return Aspect.OTHER


def _aspect_of_link(tags: tuple[str, ...], attribute: str) -> Aspect:
    if not tags:
        return Aspect.NAME if attribute == "name" else Aspect.OTHER
    if tags[:2] == ("visual", "geometry"):
        return Aspect.SHAPE if attribute == "filename" else Aspect.SIZE
    return _OF_LINKS.get(tags[0]) or _OF_LINKS.get("/".join(tags[:2]), Aspect.OTHER)
