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
    assert found.evidence[0].startswith("gain is now ")
    assert "gain" in found.sentence
