"""Checks of the model: values, links and joints of an open document, and its problems."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.description.values import SiteKind
from studio.documents.lessons.verdict import HOLDS, Verdict, is_same, missing
from studio.problems import Severity

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from studio.documents.document import Document

    _Values = Mapping[str, str]

_NAMED: Final = frozenset((SiteKind.PROPERTY, SiteKind.YAML, SiteKind.PARAM_DEFAULT))


def model_verdict(kind: str, values: _Values, document: Document) -> Verdict:
    """Return how a check of the model stands.

    Args:
        kind: Its form.
        values: What fills it.
        document: What the reader has open.
    """
    if kind == "no_errors":
        return _no_errors(document)
    if document.last_run.failed:
        return missing("run.failed")
    return _FORMS[kind](values, document)


def _property(values: _Values, document: Document) -> Verdict:
    name, wanted = values["name"], values["value"]
    sites = [one for one in document.sites.sites.values() if one.name == name]
    found = [one.value or one.text for one in sites if one.kind in _NAMED]
    return _compared("property", wanted, found)


def _argument(values: _Values, document: Document) -> Verdict:
    found = document.sites.argument_values()
    passed = found | dict(document.sources.arguments)
    name = values["name"]
    return _compared("argument", values["value"], [passed[name]] if name in found else [])


def _compared(what: str, wanted: str, found: list[str]) -> Verdict:
    if not found:
        return missing(f"{what}.none")
    if any(is_same(wanted, one) for one in found):
        return HOLDS
    return missing(f"{what}.other", value=found[0][:80])


def _link(values: _Values, document: Document) -> Verdict:
    return HOLDS if values["name"] in document.model.assembly.robot.links else missing("link.none")


def _children(values: _Values, document: Document) -> Verdict:
    robot = document.model.assembly.robot
    if values["name"] not in robot.links:
        return missing("link.none")
    count = sum(joint.parent == values["name"] for joint in robot.joints.values())
    return HOLDS if count == int(values["count"]) else missing("children.other", count=count)


def _joint(values: _Values, document: Document) -> Verdict:
    joint = document.model.assembly.robot.joints.get(values["name"])
    if joint is None:
        return missing("joint.none")
    return HOLDS if joint.type == values["type"] else missing("joint.other", type=joint.type)


def _no_errors(document: Document) -> Verdict:
    errors = [one for one in document.findings.all() if one.severity is Severity.ERROR]
    if not errors:
        if document.last_run.expansion is None:
            return missing("run.none")
        is_checked = document.checks.is_settled and document.robot_checks.is_settled
        return HOLDS if is_checked and not document.last_run.failed else missing("checks.waiting")
    return missing("errors.some", count=len(errors), first=errors[0].sentence[:300])


_FORMS: Final[dict[str, Callable[[_Values, Document], Verdict]]] = {
    "property": _property,
    "argument": _argument,
    "link": _link,
    "children": _children,
    "joint": _joint,
}
