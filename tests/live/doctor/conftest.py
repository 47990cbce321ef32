"""One system for all tests of the Doctor's subjects: each adds its fault, and takes it away."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.patient import patient_system

if TYPE_CHECKING:
    from collections.abc import Iterator

    from tests.support.patient import Patient


@pytest.fixture(scope="session")
def system() -> Iterator[Patient]:
    """The system, for all files."""
    with patient_system() as made:
        yield made


@pytest.fixture
def patient(system: Patient) -> Iterator[Patient]:
    """The same, without any fault yet."""
    yield system
    system.heal()
