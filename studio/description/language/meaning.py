"""The meaning of a name at a cursor: text, values, unit, documentation, places."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from studio.description.language.definitions import (
    documentation_of,
    parameter_documentation,
    parameters_of,
)
from studio.description.language.named_files import existing, is_text, package_folder
from studio.description.language.questions import Meaning, TextPlace
from studio.description.language.questions import SubjectKind as Kind
from studio.description.language.subject import Subject, distinct, found_in, subject_of
from studio.description.language.token_at import Where
from studio.description.language.uses import chain_at, string_at
from studio.description.language.words import FILE_ATTRIBUTES, PART_REFERENCES, XACRO_TAGS
from studio.description.syntax.params import name_in_params, read_parameters
from studio.description.syntax.yaml_spans import key_path_text, read_yaml_document
from studio.description.values import Widget, WidgetKind

if TYPE_CHECKING:
    from studio.description.language.cursor import Cursor
    from studio.description.language.reading import Reading
    from studio.description.language.token_at import Attribute, Segment, Tag
    from studio.description.language.uses import Chain
    from studio.description.syntax.source_tree import SourceElement
    from studio.description.syntax.yaml_spans import YamlScalar

_PLAIN = Widget(WidgetKind.TEXT)
_OF_MACROS = frozenset({Kind.PARAMETER, Kind.BLOCK})
_WORD: Final = re.compile(r"[^\s=:^|]+")
_NAMING: Final = {
    "xacro:property": Kind.PROPERTY,
    "xacro:arg": Kind.ARG,
    "xacro:macro": Kind.MACRO,
    "link": Kind.LINK,
    "joint": Kind.JOINT,
}


def subject_at(cursor: Cursor) -> Subject | None:
    """Return the subject under a cursor; None when nothing known is there."""
    token = cursor.token
    if token.where is Where.SILENT:
        return None
    if token.where in {Where.TAG_NAME, Where.CLOSING}:
        return _tag(cursor)
    if token.where is Where.ATTRIBUTE_NAME:
        return _attribute_name(cursor)
    if cursor.segment is not None:
        return _segment(cursor, cursor.segment)
    if token.where is Where.VALUE and cursor.tag and token.attribute:
        return _value(cursor, cursor.tag, token.attribute)
    return None


def yaml_subject_at(cursor: Cursor) -> Subject | None:
    """Return the key or value of a YAML file nearest to the cursor on its line."""
    editor = cursor.editor
    line = cursor.text.count("\n", 0, cursor.index) + 1
    scalars = [one for one in read_yaml_document(editor.data).scalars if one.line == line]
    if not scalars:
        return None
    byte = editor.byte_at(editor.offset_of(cursor.index))
    near = min(scalars, key=lambda one: max(byte - one.span.end, 0))
    start, end = (editor.index_of(editor.offset_at(b)) for b in (near.span.start, near.span.end))
    name = str(near.path[-1]) if near.path else ""
    return Subject(Kind.YAML, name, start, end, yaml=(cursor.file, near.path), values=(near.text,))


def meaning_of(subject: Subject, cursor: Cursor) -> Meaning:
    """Return the meaning of a subject at a cursor."""
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
    """Return the text of a definition as it stands in its file."""
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
    """Return the widget of the subject's site, which knows unit and help."""
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
    """Return where a subject is defined, in the present texts."""
    if subject.yaml:
        return _yaml_places(subject, reading)
    if not subject.elements:
        return subject.places
    return tuple(_place(one, subject, reading) for one in subject.elements)


def _place(element: SourceElement, subject: Subject, reading: Reading) -> TextPlace:
    if element.tag == "xacro:macro" and subject.kind in _OF_MACROS:
        return reading.parameter_place(element, subject.name)
    return reading.element_place(element, "ns" if subject.kind is Kind.NAMESPACE else "name")


def _yaml_scalars(subject: Subject, reading: Reading) -> list[YamlScalar]:
    """Return the scalar of a key path; of a mapping or list the first one in it."""
    assert subject.yaml is not None
    file, path = subject.yaml
    scalars = read_yaml_document(reading.text(file) or b"").scalars
    return [one for one in scalars if one.path[: len(path)] == path][:1]


def _yaml_places(subject: Subject, reading: Reading) -> tuple[TextPlace, ...]:
    assert subject.yaml is not None
    places = reading.places(subject.yaml[0])
    found = _yaml_scalars(subject, reading)
    return tuple(places.place(one.span.start, one.span.end) for one in found)


def _tag(cursor: Cursor) -> Subject | None:
    start, end = cursor.token.start, cursor.token.end
    name = cursor.text[start:end]
    own = name.removeprefix("xacro:")
    if own == name:
        return Subject(Kind.ELEMENT, name, start, end) if name else None
    if own in XACRO_TAGS:
        return Subject(Kind.TAG, own, start, end)
    called = _called(cursor, own)
    return replace(_macro(cursor, own, called), start=start, end=end)


def _called(cursor: Cursor, name: str) -> tuple[SourceElement, ...]:
    """Return the macros that a call means: those that it called, else those of its name."""
    definitions = cursor.reading.definitions
    if definitions is None:
        return ()
    is_tag = cursor.token.where is not Where.CLOSING
    if is_tag and cursor.element and (known := definitions.called.get(cursor.element)):
        return tuple(known)
    return tuple(definitions.macros_by_name.get(name, ()))


def _macro(cursor: Cursor, name: str, elements: tuple[SourceElement, ...]) -> Subject:
    return Subject(Kind.MACRO, name, elements=elements, places=cursor.declared(Kind.MACRO, name))


def _attribute_name(cursor: Cursor) -> Subject | None:
    attribute, tag = cursor.token.attribute, cursor.tag
    if attribute is None or tag is None:
        return None
    own = tag.name.removeprefix("xacro:")
    if own == tag.name or own in XACRO_TAGS:
        return Subject(Kind.ATTRIBUTE, attribute.name, cursor.token.start, cursor.token.end)
    return _argument(cursor, attribute)


def _argument(cursor: Cursor, attribute: Attribute) -> Subject:
    """Return the parameter that an attribute of a call gives."""
    tag = cursor.tag
    assert tag is not None
    macros = _called(cursor, tag.name.removeprefix("xacro:"))
    knowing = [one for one in macros if _has_parameter(one, attribute.name)]
    end = attribute.name_start + len(attribute.name)
    subject = parameter_subject(cursor, tuple(knowing), attribute.name)
    values = _given(cursor, attribute.name)
    return replace(subject, start=attribute.name_start, end=end, values=values or subject.values)


def _given(cursor: Cursor, name: str) -> tuple[str, ...]:
    """Return the values of a parameter in the calls that this element makes."""
    if cursor.trace is None or cursor.element is None:
        return ()
    calls = (call for those in cursor.trace.seen.calls.values() for call in those)
    cells = [one.scope.cells.get(name) for one in calls if one.element is cursor.element]
    return distinct(cell.value for cell in cells if cell is not None)


def _has_parameter(macro: SourceElement, name: str) -> bool:
    return name_in_params(macro.attributes.get("params", ""), name) >= 0


def parameter_subject(cursor: Cursor, macros: tuple[SourceElement, ...], name: str) -> Subject:
    """Return a parameter of macros, with what it came to in their calls."""
    is_block = any(
        one.name == name and one.kind != "value"
        for macro in macros
        for one in parameters_of(macro.attributes.get("params", ""))
    )
    kind = Kind.BLOCK if is_block else Kind.PARAMETER
    seen = cursor.trace.seen.calls if cursor.trace else {}
    cells = [call.scope.cells.get(name) for macro in macros for call in seen.get(macro, ())]
    values = distinct(cell.value for cell in cells if cell is not None and not is_block)
    return Subject(kind, name, elements=macros, values=values)


def _segment(cursor: Cursor, segment: Segment) -> Subject | None:
    text = cursor.text[segment.start : segment.end]
    inside = cursor.index - segment.start
    if not segment.is_expression:
        return _substitution(cursor, segment, text)
    chain = chain_at(text, inside)
    if chain is None:
        return _string(cursor, segment, text) or _whole(cursor, segment)
    subject = chain_subject(cursor, chain)
    last = chain.steps[-1]
    start, end = segment.start + last.start, segment.start + last.end
    return replace(subject, start=start, end=end) if subject else None


def _whole(cursor: Cursor, segment: Segment) -> Subject:
    values = distinct(one.value for one in cursor.evaluated(segment))
    text = cursor.plain(segment.start, segment.end)
    return Subject(Kind.EXPRESSION, text, segment.start, segment.end, values=values)


def _string(cursor: Cursor, segment: Segment, text: str) -> Subject | None:
    """Return a quoted text of an expression, if it names a file, such as that of `load_yaml`."""
    found = string_at(text, cursor.index - segment.start)
    if found is None:
        return None
    target = existing(cursor.reading, str(found.key), cursor.file)
    if not target or "." not in str(found.key):
        return None
    start, end = segment.start + found.start, segment.start + found.end
    places = (TextPlace(target, 1, 1),) if is_text(target) else ()
    return Subject(Kind.FILE, str(found.key), start, end, target=target, places=places)


def chain_subject(cursor: Cursor, chain: Chain) -> Subject | None:
    """Return what a chain of names in an expression means: exactly, if the run evaluated it."""
    if chain.is_local:
        return Subject(Kind.VARIABLE, chain.base)
    exact = cursor.evaluated(cursor.segment) if cursor.segment else []
    parameter = None if exact else _parameter_around(cursor, chain)
    if parameter is not None:
        return parameter
    scopes = [one.scope for one in exact] or cursor.scopes()
    found = subject_of(found_in(scope, chain) for scope in scopes)
    if found is not None:
        return _with_macros(cursor, found)
    places = () if chain.keys else cursor.declared(Kind.PROPERTY, chain.base)
    elements = () if chain.keys else cursor.defining("xacro:property", chain.base)
    if places or elements:
        return Subject(Kind.PROPERTY, chain.base, elements=elements, places=places)
    return None


def _parameter_around(cursor: Cursor, chain: Chain) -> Subject | None:
    """Return the parameter of the macro around, when the run did not come by here."""
    macro = cursor.macro
    if macro is None or chain.keys:
        return None
    names = read_parameters(cursor.written(macro, "params"))[0]
    if chain.base not in names:
        return None
    element = cursor.element_of(macro)
    if element is not None and _has_parameter(element, chain.base):
        return parameter_subject(cursor, (element,), chain.base)
    return Subject(Kind.PARAMETER, chain.base, places=(cursor.parameter_of(macro, chain.base),))


def _with_macros(cursor: Cursor, found: Subject) -> Subject:
    """A parameter is defined by its macro, not by the call that gave it."""
    definitions = cursor.reading.definitions
    if found.kind is not Kind.PARAMETER or definitions is None:
        return found
    macros: dict[SourceElement, None] = {}
    for element in found.elements:
        called = [element] if element.tag == "xacro:macro" else definitions.called.get(element, [])
        macros.update((one, None) for one in called if _has_parameter(one, found.name))
    return replace(found, elements=tuple(macros))


def _substitution(cursor: Cursor, segment: Segment, text: str) -> Subject | None:
    parts = [(found[0], found.start(), found.end()) for found in re.finditer(r"\S+", text)]
    if not parts:
        return None
    command = parts[0][0]
    inside = cursor.index - segment.start
    under = next((one for one in parts if one[1] <= inside <= one[2]), None)
    if command == "eval" and under != parts[0]:
        return _eval(cursor, segment, text)
    if under is None or under == parts[0] or len(parts) < 2:
        return _whole(cursor, segment)
    start, end = segment.start + under[1], segment.start + under[2]
    subject = _operand(cursor, command, under[0])
    return replace(subject, start=start, end=end) if subject else _whole(cursor, segment)


def _operand(cursor: Cursor, command: str, part: str) -> Subject | None:
    if command == "arg":
        return arg_subject(cursor, part)
    if command == "find":
        return package_subject(cursor, part)
    if command in {"env", "optenv"}:
        value = cursor.reading.policy.environment.get(part)
        return Subject(Kind.ENVIRONMENT, part, values=() if value is None else (value,))
    return None


def _eval(cursor: Cursor, segment: Segment, text: str) -> Subject | None:
    """Return a name in `$(eval ...)`, where args are read by their names."""
    chain = chain_at(text, cursor.index - segment.start)
    if chain is None or cursor.trace is None or chain.base not in cursor.trace.arguments:
        return _whole(cursor, segment)
    step = chain.steps[0]
    start, end = segment.start + step.start, segment.start + step.end
    return replace(arg_subject(cursor, chain.base), start=start, end=end)


def arg_subject(cursor: Cursor, name: str) -> Subject:
    """Return an arg with its value."""
    given = cursor.trace.arguments.get(name) if cursor.trace else None
    elements = cursor.defining("xacro:arg", name)
    values = () if given is None else distinct([given.value])
    places = cursor.declared(Kind.ARG, name)
    return Subject(Kind.ARG, name, elements=elements, values=values, places=places)


def package_subject(cursor: Cursor, name: str) -> Subject:
    """Return a package with its folder."""
    folder = package_folder(cursor.reading, name, cursor.file)
    return Subject(Kind.PACKAGE, name, target=folder)


def _value(cursor: Cursor, tag: Tag, attribute: Attribute) -> Subject | None:
    """Return a value, or a part of one, without any `$`."""
    text = cursor.plain(attribute.start, attribute.end)
    kind = _NAMING.get(tag.name) if attribute.name == "name" else None
    subject = _named_here(cursor, kind, text) if kind else _named_elsewhere(cursor, tag, attribute)
    if subject is not None and subject.start == subject.end == 0:
        return replace(subject, start=attribute.start, end=attribute.end)
    return subject


def _named_here(cursor: Cursor, kind: Kind, name: str) -> Subject:
    """Return what the element under the cursor itself defines."""
    element = cursor.element
    own = (element,) if element else ()
    if kind is Kind.MACRO:
        return _macro(cursor, name, own)
    if kind is Kind.ARG:
        return arg_subject(cursor, name)
    if kind is Kind.PROPERTY:
        return Subject(kind, name, elements=own, values=property_values(cursor, own, name))
    return part_subject(cursor, kind, name)


def property_values(
    cursor: Cursor, elements: tuple[SourceElement, ...], name: str
) -> tuple[str, ...]:
    """Return the values of the bindings of property elements."""
    if cursor.trace is None:
        return ()
    keys = [(one, which, name) for one in elements for which in ("value", "default")]
    found = (cursor.trace.bindings.get(key) for key in keys)
    return tuple(dict.fromkeys(value for one in found if one for value in one.values))


def _named_elsewhere(  # noqa: PLR0911 - one case a kind of attribute
    cursor: Cursor, tag: Tag, attribute: Attribute
) -> Subject | None:
    text = cursor.plain(attribute.start, attribute.end)
    match tag.name, attribute.name:
        case "xacro:insert_block", "name":
            return _block(cursor, text)
        case "xacro:call", "macro":
            return _macro(cursor, text, _called(cursor, text))
        case "xacro:macro", "params":
            return _written_parameter(cursor, attribute)
        case "xacro:property" | "xacro:arg", "value" | "default":
            kind = Kind.ARG if tag.name == "xacro:arg" else Kind.PROPERTY
            return _named_here(cursor, kind, cursor.written(tag, "name"))
        case name, which if (name, which) in FILE_ATTRIBUTES:
            return _files(cursor, attribute, text)
        case name, which if (name, which) in PART_REFERENCES:
            return part_subject(cursor, Kind(PART_REFERENCES[name, which]), text)
        case name, _ if name.startswith("xacro:") and name[6:] not in XACRO_TAGS:
            return _argument(cursor, attribute)
        case _:
            return None


def _files(cursor: Cursor, attribute: Attribute, text: str) -> Subject | None:
    """Return the files of an include or a mesh in the run; else what the text names."""
    found: list[str] = []
    definitions, element = cursor.reading.definitions, cursor.element
    if definitions is not None and element is not None:
        includes = definitions.trace.seen.includes
        found += dict.fromkeys(one.file for one in includes if one.element is element)
        written = definitions.written_out(element, attribute.name)
        found += (existing(cursor.reading, one, cursor.file) for one in written)
    found = [one for one in (*found, existing(cursor.reading, text, cursor.file)) if one]
    if not found:
        return None
    places = tuple(TextPlace(one, 1, 1) for one in dict.fromkeys(found) if is_text(one))
    return Subject(Kind.FILE, text, target=found[0], places=places)


def part_subject(cursor: Cursor, kind: Kind, name: str) -> Subject:
    """Return a link or joint of the robot."""
    definitions = cursor.reading.definitions
    part = definitions.parts.get((kind.value, name)) if definitions else None
    return Subject(kind, name, elements=(part.origin,) if part else ())


def _block(cursor: Cursor, name: str) -> Subject:
    for scope in cursor.scopes():
        property_block = scope.find(f"**{name}")
        if property_block and property_block[0].at is not None:
            return Subject(Kind.BLOCK, name, elements=(property_block[0].at,))
    macro = cursor.macro
    element = cursor.element_of(macro) if macro else None
    if element is not None and _has_parameter(element, name):
        return Subject(Kind.BLOCK, name, elements=(element,))
    places = (cursor.parameter_of(macro, name),) if macro else ()
    return Subject(Kind.BLOCK, name, places=places)


def _written_parameter(cursor: Cursor, attribute: Attribute) -> Subject | None:
    """Return the parameter that is written in `params` under the cursor."""
    for found in _WORD.finditer(cursor.text, attribute.start, attribute.end):
        if found.start() <= cursor.index <= found.end():
            name = found[0].lstrip("*")
            element = cursor.element
            if element is None or not _has_parameter(element, name):
                return None
            start = found.end() - len(name)
            subject = parameter_subject(cursor, (element,), name)
            return replace(subject, start=start, end=found.end())
    return None
