"""Problems of the open description."""

from __future__ import annotations

from studio.live.doctor.examination import examine
from studio.live.doctor.seen import Seen, SeenDocument
from studio.problems import Place, Problem, Severity


def test_problems_that_hinder_are_findings():
    problems = (
        Problem(Severity.WARNING, "no-inertia", "arm has no inertia.", Place("/w/a.xacro", 4)),
        Problem(Severity.ERROR, "mesh-missing", "package://x/y.dae was not found."),
        Problem(Severity.INFO, "unused", "spare is not used."),
    )
    document = SeenDocument("d", "a.xacro", frozenset({"base"}), problems=problems)
    found = examine(Seen(document=document)).findings
    assert [(one.level, one.sentence) for one in found] == [
        ("error", "package://x/y.dae was not found."),
        ("warn", "arm has no inertia."),
    ]
    assert found[1].evidence == ("a.xacro:4", "no-inertia")
    assert {one.code for one in found} == {"problem"}


def test_without_a_document_it_is_not_examined():
    (looked,) = (one for one in examine(Seen()).subjects if one.subject == "document")
    assert looked.state == "not_examined"
