"""One system for all tests of the Doctor's subjects: each adds its fault, and takes it away."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

import pytest

from studio.protocol.doctor import Finding
from studio.server.commands import parse_command
from tests.support.patient import patient_system

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.support.patient import Patient


@pytest.fixture(scope="session")
def system() -> Iterator[Patient]:
    """The system, for all files."""
    with patient_system() as made:
        yield made


@pytest.fixture(autouse=True)
def found(monkeypatch: pytest.MonkeyPatch) -> Iterator[list[Finding]]:
    """All findings of a test: each says what it is concluded from, and has a click that works."""
    made: list[Finding] = []
    begin = Finding.__init__

    def noted(self: Finding, **values: Any) -> None:  # noqa: ANN401
        begin(self, **values)
        made.append(self)

    monkeypatch.setattr(Finding, "__init__", noted)
    yield made
    bare = {one.code for one in made if not all(one.evidence) or not one.evidence}
    assert bare == set(), "findings without evidence"
    idle = {one.code for one in made if not one.about and one.mend is None}
    assert idle == set(), "findings without a click that mends or shows them"
    for mend in (one.mend for one in made if one.mend):
        parse_command(json.dumps({"request": 1, "document": "d", **mend.command}).encode())


@pytest.fixture
def patient(system: Patient) -> Iterator[Patient]:
    """The same, without any fault yet."""
    yield system
    system.heal()
