# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportPrivateUsage=false
"""Small xacro files, expanded by our evaluator and by stock xacro, in one comparable form."""

from __future__ import annotations

import re
from typing import TYPE_CHECKING, TypeAlias, cast
from unittest.mock import patch
from xml.dom import minidom
from xml.parsers.expat import ExpatError

import xacro
from xacro import substitution_args

from studio.description.evaluator.evaluation import Evaluation
from studio.description.evaluator.output_tree import OutputElement
from studio.description.evaluator.source_store import SourceStore
from studio.description.faults import Fault
from studio.description.syntax.source_tree import SourceText
from studio.description.values import ReadPolicy
from studio.packages.roots import ServedRoots

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from studio.description.expressions.bounds import Limits

XMLNS = 'xmlns:xacro="http://www.ros.org/wiki/xacro"'
_PACKAGE_NAME = re.compile(r"<name>\s*([^<\s]+)")

Canonical: TypeAlias = "tuple[str, tuple[tuple[str, str], ...], tuple[Canonical | str, ...]]"
"""Tag, sorted attributes, children without comments and blank text."""


def robot(body: str, attributes: str = 'name="r"') -> str:
    """A whole xacro file around its content."""
    return f"<robot {XMLNS} {attributes}>{body}</robot>"


def write(folder: Path, files: Mapping[str, str | bytes]) -> Path:
    """Write files below a folder; the path of the first."""
    for name, content in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(content.encode() if isinstance(content, str) else content)
    return folder / next(iter(files))


def packages_below(folder: Path) -> dict[str, tuple[str, ...]]:
    """Package names and folders, as `ReadPolicy` wants them."""
    found: dict[str, tuple[str, ...]] = {}
    for manifest in sorted(folder.rglob("package.xml")):
        name = _PACKAGE_NAME.search(manifest.read_text(encoding="utf-8"))
        if name:
            found[name[1]] = (*found.get(name[1], ()), str(manifest.parent))
    return found


def policy_for(root: Path, environment: Mapping[str, str] | None = None) -> ReadPolicy:
    """Everything below a folder may be read."""
    return ReadPolicy((str(root),), packages_below(root), dict(environment or {}))


def evaluation_of(
    policy: ReadPolicy,
    arguments: Mapping[str, str] | None = None,
    limits: Limits | None = None,
) -> Evaluation:
    """A run with a store of its own."""
    store = SourceStore(ServedRoots([_path(root) for root in policy.roots]), {})
    return Evaluation(store, policy, arguments or {}, limits)


def _path(text: str) -> Path:
    from pathlib import Path

    return Path(text)


def expand(file: Path, arguments: Mapping[str, str] | None = None) -> OutputElement:
    """Our expansion of a file that may read its own folder."""
    return evaluation_of(policy_for(file.parent), arguments).run(str(file))


def fault_of(file: Path, arguments: Mapping[str, str] | None = None) -> Fault:
    """Why our expansion of a file stops."""
    try:
        expand(file, arguments)
    except Fault as fault:
        return fault
    raise AssertionError(f"{file} was expanded, but should not be")


def canonical(element: OutputElement) -> Canonical:
    """Our output in comparable form."""
    children: list[Canonical | str] = []
    for child in element.children:
        if isinstance(child, OutputElement):
            children.append(canonical(child))
        elif isinstance(child, SourceText):
            _add_text(children, child.text)
    return element.tag, tuple(sorted(element.attributes.items())), tuple(children)


def canonical_xml(text: str) -> Canonical:
    """XML text in comparable form."""
    root = minidom.parseString(text).documentElement
    assert root is not None
    return canonical_dom(root)


def canonical_dom(element: minidom.Element) -> Canonical:
    """A DOM element in comparable form."""
    children: list[Canonical | str] = []
    for child in element.childNodes:
        if isinstance(child, minidom.Element):
            children.append(canonical_dom(child))
        elif isinstance(child, minidom.Text):
            _add_text(children, child.data)
    return element.tagName, tuple(sorted(element.attributes.items())), tuple(children)


def _add_text(children: list[Canonical | str], text: str) -> None:
    """Texts that only a dropped comment or blanks separate are one, and blanks do not count."""
    solid = "".join(text.split())
    if not solid:
        return
    if children and isinstance(children[-1], str):
        children[-1] += solid
    else:
        children.append(solid)


def stock(
    file: Path,
    arguments: Mapping[str, str] | None = None,
    environment: Mapping[str, str] | None = None,
) -> Canonical | None:
    """What bare stock xacro makes of a harmless file; None when it cannot expand it."""
    text = stock_text(file, arguments, environment)
    return None if text is None else canonical_xml(text)


def stock_text(
    file: Path,
    arguments: Mapping[str, str] | None = None,
    environment: Mapping[str, str] | None = None,
) -> str | None:
    """The XML that bare stock xacro writes; None when it fails or writes what is no XML."""
    packages = packages_below(file.parent)

    def find(name: str) -> str:
        return packages[name][0]

    with (
        patch.object(substitution_args, "_eval_find", find),
        patch.dict(substitution_args._eval_dict, {"find": find}),
        patch.dict("os.environ", environment or {}),
    ):
        try:
            document = cast(
                "minidom.Document", xacro.process_file(str(file), mappings=dict(arguments or {}))
            )
            text = document.toxml()
            canonical_xml(text)
        except (xacro.XacroException, ExpatError, RuntimeError, OSError, AttributeError):
            return None
        except (LookupError, TypeError, ValueError):
            return None
    return text
