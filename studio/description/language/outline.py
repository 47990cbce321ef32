"""Outline of the files of a run: includes, macros, properties and args."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.description.language.definitions import documentation_of, parameters_of
from studio.description.language.questions import (
    Outline,
    OutlineFile,
    OutlineMacro,
    OutlineValue,
    SubjectKind,
    TextPlace,
)
from studio.description.language.subject import printed

if TYPE_CHECKING:
    from studio.description.language.definitions import Definitions
    from studio.description.language.reading import Reading
    from studio.description.syntax.source_tree import SourceElement

_CALLS_SHOWN: Final = 50
_FILES_SHOWN: Final = 5_000
_VALUES_SHOWN: Final = 10_000


def outline_of(reading: Reading) -> Outline:
    """Return the outline of the last run that was watched; empty before there was one."""
    definitions = reading.definitions
    if definitions is None:
        return Outline((), (), (), is_current=False)
    return Outline(
        files=tuple(_files(definitions, reading)),
        macros=tuple(_macro(name, one, reading) for name, one in definitions.macros),
        values=tuple(_value(one, reading) for one in definitions.values[:_VALUES_SHOWN]),
        is_current=reading.is_current,
    )


def _files(definitions: Definitions, reading: Reading) -> list[OutlineFile]:
    """Return the entry, then every include where it happens; the same one in the same file once."""
    trace = definitions.trace
    found = [OutlineFile(trace.entry, -1, None, "", is_yaml=False)]
    numbers: list[int] = []
    known: dict[tuple[int, SourceElement, str], int] = {}
    for one in trace.seen.includes:
        inside = numbers[one.inside] if one.inside >= 0 else 0
        number = known.setdefault((inside, one.element, one.file), len(found))
        numbers.append(number)
        if number == len(found):
            space = definitions.namespace_of(one)
            place = _start(one.element, reading)
            found.append(OutlineFile(one.file, inside, place, space, is_yaml=False))
        if len(found) >= _FILES_SHOWN:
            break
    return found + _yaml_files(found, definitions, reading)


def _yaml_files(
    files: list[OutlineFile], definitions: Definitions, reading: Reading
) -> list[OutlineFile]:
    """Return each YAML file below the first mention of the file that loads it."""
    numbers = {one.file: number for number, one in reversed(list(enumerate(files)))}
    return [
        OutlineFile(path, numbers.get(one.tree.path, 0), _start(one, reading), "", is_yaml=True)
        for path, document in definitions.trace.yaml.items()
        for one in document.loaded_by[:1]
    ]


def _macro(name: str, element: SourceElement, reading: Reading) -> OutlineMacro:
    seen = reading.trace.seen if reading.trace else None
    calls = seen.calls.get(element, []) if seen else []
    callers = dict.fromkeys(call.element for call in calls)
    return OutlineMacro(
        name=name,
        parameters=parameters_of(element.attributes.get("params", "")),
        place=reading.element_place(element),
        doc=documentation_of(element),
        calls=seen.call_counts.get(element, 0) if seen else 0,
        called_at=tuple(_start(one, reading) for one in list(callers)[:_CALLS_SHOWN]),
    )


def _start(element: SourceElement, reading: Reading) -> TextPlace:
    return reading.place(element.tree.path, element.offset)


def _value(element: SourceElement, reading: Reading) -> OutlineValue:
    """Return a property or arg with its value, and its site where it has one."""
    name = element.attributes["name"]
    which = next((one for one in ("value", "default") if one in element.attributes), "")
    bindings = reading.trace.bindings if reading.trace else None
    binding = bindings.get((element, which, name)) if bindings else None
    site = reading.sites.get(f"{element.tree.path}#{element.ordinal}@{which}")
    is_arg = element.tag == "xacro:arg"
    return OutlineValue(
        kind=SubjectKind.ARG if is_arg else SubjectKind.PROPERTY,
        name=name,
        place=reading.element_place(element),
        text=element.attributes.get(which, ""),
        values=tuple(map(printed, binding.values)) if binding else (),
        doc=site.widget.help if site else documentation_of(element),
    )
