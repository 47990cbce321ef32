"""All subjects together: their order, and their bounds."""

from __future__ import annotations

from typing import get_args

from studio.live.doctor.examination import examine, subjects
from studio.live.doctor.seen import Seen, SeenBrowser, SeenDocument, listed, short
from studio.problems import Problem, Severity
from studio.protocol.doctor import FINDINGS_MAX, SubjectName


def test_there_is_a_file_for_each_subject_in_their_order():
    assert tuple(one.SUBJECT for one in subjects()) == get_args(SubjectName)


def test_of_nothing_nothing_is_concluded():
    found = examine(Seen())
    assert (found.findings, found.more) == ((), 0)
    states = {one.subject: one.state for one in found.subjects}
    assert states["nodes"] == states["frames"] == states["document"] == "not_examined"
    assert states["versions"] == "well"


def test_the_gravest_come_first_and_a_note_alone_is_well():
    problem = Problem(Severity.ERROR, "x", "It is wrong.")
    document = SeenDocument("d", "d.xacro", problems=(problem,))
    browser = SeenBrowser("SwiftShader", draws_by_software=True)
    found = examine(Seen(document=document, browser=browser))
    assert [one.level for one in found.findings] == ["error", "note"]
    states = {one.subject: one.state for one in found.subjects}
    assert (states["document"], states["browser"]) == ("found", "well")


def test_findings_without_end_are_bounded_and_counted():
    problems = tuple(Problem(Severity.WARNING, f"c{at}", "w" * 5_000) for at in range(400))
    found = examine(Seen(document=SeenDocument("d", "d", problems=problems)))
    assert len(found.findings) == 30
    assert found.more == 10  # beyond those that the subject itself leaves to its panel
    assert max(len(one.sentence) for one in found.findings) <= 700
    assert len(found.findings) <= FINDINGS_MAX


def test_names_are_cut_in_their_middle_and_listed_once():
    assert short("a" * 80 + "b" * 200) == "a" * 79 + "…" + "b" * 79
    assert listed(["/a", "/b", "/a"], 1) == "/a and 1 more"
