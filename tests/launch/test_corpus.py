"""Launch files of real packages."""

from __future__ import annotations

import pytest

from tests.support.corpus import corpus
from tests.support.launch_sweep import sweep

_PLANNED_AT_LEAST = 0.98


@pytest.mark.corpus
def test_launch_files_of_real_packages_are_planned():
    swept = sweep(corpus())
    assert swept.planned
    assert swept.share >= _PLANNED_AT_LEAST, swept.failed
