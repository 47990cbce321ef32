from studio.engine.findings import Findings
from studio.problems import Problem, Severity

NO_INERTIA = Problem(Severity.WARNING, "no-inertia", "No inertia.")
BROKEN = Problem(Severity.ERROR, "syntax", "Broken.")


def test_errors_come_before_warnings_whoever_found_them_first():
    findings = Findings()
    findings.replace("robot", [NO_INERTIA])
    findings.replace("expansion", [BROKEN])
    assert findings.all() == (BROKEN, NO_INERTIA)


def test_an_origin_heals_its_own_findings_only():
    findings = Findings()
    findings.replace("robot", [NO_INERTIA])
    findings.replace("expansion", [BROKEN])
    assert findings.replace("expansion", [])
    assert findings.all() == (NO_INERTIA,)


def test_the_same_findings_again_are_no_news():
    findings = Findings()
    assert findings.replace("robot", [NO_INERTIA])
    assert not findings.replace("robot", [NO_INERTIA])


def test_what_two_found_is_listed_once():
    findings = Findings()
    findings.replace("robot", [BROKEN])
    findings.replace("validation", [BROKEN])
    assert findings.all() == (BROKEN,)
