"""Changes of a setup.py: one more executable, more installed files, the imports these need."""

from __future__ import annotations

import ast
from typing import TYPE_CHECKING

from studio.packages.edits.python_edits import import_added

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence

    from studio.packages.sources.setup_py import SetupPy
    from studio.problems import Replacement


def check_whole(setup: SetupPy) -> None:
    """Refuse a file that is broken, or has no call of `setup`.

    Raises:
        ValueError: It is so.
    """
    if setup.fault or setup.call is None or not setup.source.is_utf8:
        raise ValueError(setup.source.file)


def script_added(setup: SetupPy, name: str, place: str) -> tuple[Replacement, ...]:
    """Return the change that starts `place` (`module:function`) by a name; none if it is there.

    Raises:
        ValueError: The file is broken, or computes its entry points.
    """
    check_whole(setup)
    if any(one.name == name and one.place == place for one in setup.scripts):
        return ()
    entry = _quoted(setup, f"{name} = {place}")
    listed = setup.scripts_list
    if listed is not None:
        return (list_items_added(setup, listed, [entry]),)
    entries = setup.entry_points
    if entries is not None:
        if any(getattr(one, "value", "") == "console_scripts" for one in entries.keys):
            raise ValueError(setup.source.file)
        key = _quoted(setup, "console_scripts")
        return (list_items_added(setup, entries, [f"{key}: [{entry}]"]),)
    if setup.keyword("entry_points") is not None:
        raise ValueError(setup.source.file)
    key = _quoted(setup, "console_scripts")
    return (_keyword_added(setup, f"entry_points={{{key}: [{entry}]}}"),)


def data_files_added(setup: SetupPy, rows: Iterable[tuple[str, str]]) -> tuple[Replacement, ...]:
    """Return the changes that install files: of each row the folder and a pattern of its files.

    Rows whose files are installed already are left out; `glob` is imported where it is not.

    Raises:
        ValueError: The file is broken, or computes what it installs.
    """
    check_whole(setup)
    known = {source for row in setup.data_files for source in row.sources}
    wanted = [one for one in rows if "/".join(filter(None, one)) not in known]
    if not wanted:
        return ()
    items = [data_files_row(setup, *one) for one in wanted]
    imported: tuple[Replacement, ...] = ()
    if any(map(_has_wildcard, (pattern for _, pattern in wanted))) and not imports_glob(setup):
        imported = (import_added(setup.python, "from glob import glob"),)
    listed = setup.data_files_list
    if listed is None:
        if setup.keyword("data_files") is not None:
            raise ValueError(setup.source.file)
        change = _keyword_added(setup, f"data_files=[{', '.join(items)}]")
        return (*imported, change)
    return (*imported, list_items_added(setup, listed, items))


def data_files_row(setup: SetupPy, folder: str, pattern: str) -> str:
    """Return the row of `data_files` that installs files of a folder, as the file would have it.

    Args:
        setup: The file.
        folder: Below the package; empty: its root.
        pattern: Of the names of files in it, or one name.

    Raises:
        ValueError: The name of the package is computed.
    """
    below = f"/{folder}" if folder else ""
    if "package_name" in setup.constants:
        share = "'share/' + package_name" + (f" + '{below}'" if below else "")
    elif name := setup.text("name"):
        share = f"'share/{name}{below}'"
    else:
        raise ValueError(setup.source.file)
    files = repr(f"{folder}/{pattern}" if folder else pattern)
    if not _has_wildcard(pattern):
        return f"({share}, [{files}])"
    return f"({share}, {'glob.glob' if setup.imports('glob') else 'glob'}({files}))"


def imports_glob(setup: SetupPy) -> bool:
    """Whether a row with `glob` needs no import."""
    return setup.imports("glob") or setup.imports("glob", "glob")


def _has_wildcard(pattern: str) -> bool:
    return any(letter in pattern for letter in "*?[")


def list_items_added(
    setup: SetupPy, listed: ast.List | ast.Dict, items: Sequence[str]
) -> Replacement:
    """Put items last into a list or dictionary, in the form in which the others stand.

    A comma that is missing behind the last one is put in, comments stay where they are.
    """
    source, python = setup.source, setup.python
    start, end = python.span(listed)
    nodes = listed.elts if isinstance(listed, ast.List) else listed.values
    closing = end - 1
    if not nodes:
        return _first_items(setup, start, closing, items)
    last_start, last_end = python.span(nodes[-1])
    comma, last_end = _behind(source.data, last_end, closing)
    own_line = source.line_of(last_start) > source.line_of(start)
    at = last_end if comma is None else comma + 1
    if not own_line:
        lead = "," if comma is None else ""
        return source.put_in(at, f"{lead} {', '.join(items)}")
    first = nodes[-1] if isinstance(listed, ast.List) else listed.keys[-1]
    lead = f"{source.line_break}{source.indent_at(python.span(first or nodes[-1])[0])}"
    if comma is None:
        return source.put_in(at, "".join(f",{lead}{one}" for one in items))
    return source.put_in(at, "".join(f"{lead}{one}," for one in items))


def _first_items(setup: SetupPy, start: int, closing: int, items: Sequence[str]) -> Replacement:
    source = setup.source
    line = source.line_start(closing)
    if source.line_of(start) == source.line_of(closing) or source.data[line:closing].strip():
        return source.put_in(start + 1, ", ".join(items))
    indent = source.indent_at(closing) + "    "
    return source.put_in(line, "".join(f"{indent}{one},{source.line_break}" for one in items))


def _behind(data: bytes, at: int, end: int) -> tuple[int | None, int]:
    """Return the comma behind an item, if there is one, and where the item ends, brackets and all.

    Comments are passed over.
    """
    item_end = at
    while at < end:
        letter = data[at : at + 1]
        if letter == b",":
            return at, item_end
        if letter == b"#":
            line_end = data.find(b"\n", at, end)
            at = end if line_end < 0 else line_end
        elif not letter.isspace():
            item_end = at + 1
        at += 1
    return None, item_end


def _keyword_added(setup: SetupPy, text: str) -> Replacement:
    """Give one more keyword to `setup()`, behind the last one."""
    call = setup.call
    if call is None or not call.keywords:
        raise ValueError(setup.source.file)
    source, python = setup.source, setup.python
    last = call.keywords[-1]
    _, last_end = python.span(last)
    closing = python.span(call)[1] - 1
    comma, last_end = _behind(source.data, last_end, closing)
    at, lead = (last_end, ",") if comma is None else (comma + 1, "")
    if source.line_of(python.span(last)[0]) == source.line_of(python.span(call)[0]):
        return source.put_in(at, f"{lead} {text}")
    indent = source.indent_at(python.span(last)[0])
    trail = "" if comma is None else ","
    return source.put_in(at, f"{lead}{source.line_break}{indent}{text}{trail}")


def _quoted(setup: SetupPy, text: str) -> str:
    """Quote a text as the file does."""
    quote = '"' if setup.source.data.count(b'"') > setup.source.data.count(b"'") else "'"
    return f"{quote}{text}{quote}"
