"""Parameters that change while the Doctor listens."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.ros.parameters.parameter import Parameter

if TYPE_CHECKING:
    from tests.support.patient import Patient

pytestmark = pytest.mark.network


def test_a_changed_parameter_is_a_note_with_its_value(patient: Patient):
    node = patient.node("tuned")
    node.declare_parameter("gain", 1)
    values = iter(range(2, 1_000_000))
    found = patient.until(
        "parameter-changed",
        "/tuned",
        do=lambda: node.set_parameters([Parameter("gain", value=next(values))]),
    )
    assert found.level == "note"
    assert "since the Doctor began to listen" in found.sentence
    assert "restart" not in found.sentence
    assert found.evidence[0].startswith("gain is now ")
    assert "gain" in found.sentence


def test_an_event_of_any_size_does_no_harm(patient: Patient):
    node = patient.node("huge")
    for name, value in (("blob", ""), ("text", ""), ("done", 0)):
        node.declare_parameter(name, value)
    numbers = iter(range(1, 1_000_000))

    def change() -> None:
        node.set_parameters([Parameter("blob", value="x" * 5_000_000)])
        node.set_parameters([Parameter("text", value="x" * 100_000)])
        node.set_parameters([Parameter("done", value=next(numbers))])

    found = patient.until("parameter-changed", "done", do=change)
    assert "blob" not in found.sentence
    assert max(map(len, found.evidence)) < 500
