"""A subject told to whoever looks at it: its text, values, unit, documentation and places."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.description.language.definitions import parameter_place, parameters_of, place_of
from studio.description.language.documentation import documentation_of, parameter_documentation
from studio.description.language.questions import Meaning
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.subject import distinct
from studio.description.sites.yaml_spans import key_path_text, read_yaml_document
from studio.description.values import Widget, WidgetKind

if TYPE_CHECKING:
    from studio.description.language.cursor import Cursor
    from studio.description.language.questions import TextPlace
    from studio.description.language.reading import Reading
    from studio.description.language.subject import Subject
    from studio.description.sites.yaml_spans import YamlScalar
    from studio.description.syntax.source_tree import SourceElement

_PLAIN = Widget(WidgetKind.TEXT)
_OF_MACROS = frozenset({Kind.PARAMETER, Kind.BLOCK})


def meaning_of(subject: Subject, cursor: Cursor) -> Meaning:
    """What is told of a subject at a cursor."""
    reading, first = cursor.reading, subject.elements[0] if subject.elements else None
    start, end = cursor.offsets(subject.start, subject.end)
    widget = _widget(subject, first, reading)
    text, expression_values = "", ()
    if cursor.segment is not None and subject.kind is not Kind.EXPRESSION:
        text = cursor.plain(cursor.segment.start, cursor.segment.end)
        expression_values = distinct(one.value for one in cursor.evaluated(cursor.segment))
    macro = first if subject.kind is Kind.MACRO else None
    return Meaning(
        kind=subject.kind,
        name=_name(subject),
        start=start,
        end=end,
        text=_written(subject, first, cursor),
        values=subject.values,
        unit=widget.unit,
        doc=_documentation(subject, first, widget),
        places=places_of(subject, reading),
        target=subject.target,
        parameters=parameters_of(macro.attributes.get("params", "")) if macro else (),
        calls=sum(_calls(one, reading) for one in subject.elements) if macro else 0,
        expression=text,
        expression_values=expression_values,
    )


def _name(subject: Subject) -> str:
    return key_path_text(subject.yaml[1]) if subject.yaml else subject.name


def _calls(macro: SourceElement, reading: Reading) -> int:
    return reading.trace.seen.call_counts.get(macro, 0) if reading.trace else 0


def _written(subject: Subject, first: SourceElement | None, cursor: Cursor) -> str:
    """The text of a definition as it stands in its file."""
    if subject.yaml:
        scalar = next(iter(_yaml_scalars(subject, cursor.reading)), None)
        return scalar.text if scalar else ""
    if first is None:
        return cursor.declared_text(subject.kind, subject.name)
    if subject.kind in _OF_MACROS:
        parameters = parameters_of(first.attributes.get("params", ""))
        found = next((one for one in parameters if one.name == subject.name), None)
        return (found.default or "") if found else ""
    texts = (first.attributes.get(name) for name in ("value", "default"))
    return next((text for text in texts if text is not None), "")


def _widget(subject: Subject, first: SourceElement | None, reading: Reading) -> Widget:
    """The widget of the subject's site, which knows unit and help."""
    if subject.yaml:
        file, path = subject.yaml
        site = reading.sites.get(f"{file}#{key_path_text(path)}")
        return site.widget if site else _PLAIN
    if first is None:
        return _PLAIN
    start = f"{first.tree.path}#{first.ordinal}@"
    endings = ("value", "default", f"params:{subject.name}")
    found = (reading.sites.get(start + ending) for ending in endings)
    return next((site.widget for site in found if site), _PLAIN)


def _documentation(subject: Subject, first: SourceElement | None, widget: Widget) -> str:
    if first is None or widget.help:
        return widget.help
    above = documentation_of(first)
    if subject.kind in _OF_MACROS and first.tag == "xacro:macro":
        return parameter_documentation(above, subject.name)
    return above


def places_of(subject: Subject, reading: Reading) -> tuple[TextPlace, ...]:
    """Where a subject is defined, in the texts of now."""
    if subject.yaml:
        return _yaml_places(subject, reading)
    if not subject.elements:
        return subject.places
    return tuple(_place(one, subject, reading) for one in subject.elements)


def _place(element: SourceElement, subject: Subject, reading: Reading) -> TextPlace:
    if element.tag == "xacro:macro" and subject.kind in _OF_MACROS:
        return parameter_place(reading, element, subject.name)
    return place_of(reading, element, "ns" if subject.kind is Kind.NAMESPACE else "name")


def _yaml_scalars(subject: Subject, reading: Reading) -> list[YamlScalar]:
    """The scalar of a key path; of a mapping or list the first one in it."""
    assert subject.yaml is not None
    file, path = subject.yaml
    scalars = read_yaml_document(reading.text(file) or b"").scalars
    return [one for one in scalars if one.path[: len(path)] == path][:1]


def _yaml_places(subject: Subject, reading: Reading) -> tuple[TextPlace, ...]:
    assert subject.yaml is not None
    places = reading.places(subject.yaml[0])
    found = _yaml_scalars(subject, reading)
    return tuple(places.place(one.span.start, one.span.end) for one in found)
