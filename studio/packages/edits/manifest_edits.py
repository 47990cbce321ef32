"""Changes of a package.xml: one more dependency, one more group; all other bytes stay."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final
from xml.sax.saxutils import escape

from studio.packages.sources.package_xml import TAGS

if TYPE_CHECKING:
    from studio.packages.sources.package_xml import Element, PackageXml
    from studio.problems import Replacement

_COVERS: Final = {
    "depend": ("depend",),
    "build_depend": ("build_depend", "depend"),
    "exec_depend": ("exec_depend", "depend", "run_depend"),
    "buildtool_depend": ("buildtool_depend",),
    "test_depend": ("test_depend", "depend", "exec_depend"),
    "member_of_group": ("member_of_group",),
}
"""Tags that say as much as one does."""


def has(manifest: PackageXml, tag: str, text: str) -> bool:
    """Whether a package.xml says this already, by this tag or one that says more."""
    return any(one.text == text for one in manifest.of(*_COVERS.get(tag, (tag,))))


def added(manifest: PackageXml, tag: str, text: str) -> tuple[Replacement, ...]:
    """Return the change that adds an element, beside those of its kind; none if it is there.

    Raises:
        ValueError: The file is not whole, so that nobody knows where it belongs.
    """
    if has(manifest, tag, text):
        return ()
    return (put_element(manifest, tag, f"<{tag}>{escape(text)}</{tag}>"),)


def put_element(manifest: PackageXml, tag: str, element: str) -> Replacement:
    """Put an element where its tag belongs, on a line of its own.

    Raises:
        ValueError: The file is not whole, so that nobody knows where it belongs.
    """
    if manifest.closing is None or not manifest.source.is_utf8:
        raise ValueError(manifest.source.file)
    source = manifest.source
    before = _before(manifest, tag)
    if before is None:
        at = manifest.closing
        first = next((one for one in manifest.elements if one.parents == ("package",)), None)
        indent = source.indent_at(first.start) if first else "  "
        start = source.line_start(at)
        if source.data[start:at].strip():
            return source.put_in(at, f"{indent}{element}{source.line_break}")
        return source.put_in(start, f"{indent}{element}{source.line_break}")
    indent = source.indent_at(before.start)
    return source.put_in(before.end, f"{source.line_break}{indent}{element}")


def _before(manifest: PackageXml, tag: str) -> Element | None:
    """Return the last element of this tag, or else of one that stands before it."""
    same = manifest.of(tag)
    if same:
        return same[-1]
    rank = TAGS.index(tag) if tag in TAGS else len(TAGS)
    earlier = [
        one
        for one in manifest.elements
        if one.parents == ("package",) and one.tag in TAGS and TAGS.index(one.tag) < rank
    ]
    return earlier[-1] if earlier else None
