from studio.documents.findings import OF_A_CODE, Findings
from studio.documents.runs import LastRun
from studio.problems import Problem, Severity
from studio.protocol.listeners import Audience

NO_INERTIA = Problem(Severity.WARNING, "no-inertia", "No inertia.")
BROKEN = Problem(Severity.ERROR, "syntax", "Broken.")


def no_findings() -> Findings:
    """The findings of a document that nobody watches."""
    return Findings(Audience(), LastRun("r.xacro"))


def test_errors_come_before_warnings_whoever_found_them_first():
    findings = no_findings()
    findings.replace("robot", [NO_INERTIA])
    findings.replace("expansion", [BROKEN])
    assert findings.all() == (BROKEN, NO_INERTIA)


def test_an_origin_heals_its_own_findings_only():
    findings = no_findings()
    findings.replace("robot", [NO_INERTIA])
    findings.replace("expansion", [BROKEN])
    assert findings.replace("expansion", [])
    assert findings.all() == (NO_INERTIA,)


def test_who_looked_first_does_not_matter_for_the_order():
    other = Problem(Severity.WARNING, "urdf-rule", "A rule is broken.")
    findings = no_findings()
    findings.replace("validation", [other])
    findings.replace("robot", [NO_INERTIA])
    assert findings.all() == (NO_INERTIA, other)


def test_the_same_findings_again_are_no_news():
    findings = no_findings()
    assert findings.replace("robot", [NO_INERTIA])
    assert not findings.replace("robot", [NO_INERTIA])


def test_what_two_found_is_listed_once():
    findings = no_findings()
    findings.replace("robot", [BROKEN])
    findings.replace("validation", [BROKEN])
    assert findings.all() == (BROKEN,)


def test_of_one_code_only_the_first_are_told_and_how_many_more_there_are():
    findings = no_findings()
    many = [Problem(Severity.WARNING, "same", f"Link {n} is odd.") for n in range(OF_A_CODE + 7)]
    findings.replace("checks", [*many, Problem(Severity.INFO, "other", "One.")])
    told = findings.all()
    assert len(told) == OF_A_CODE + 2
    last = [one for one in told if one.code == "same"][-1]
    assert last.sentence == f"7 more findings are like this one: Link {OF_A_CODE - 1} is odd."
