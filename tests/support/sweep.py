"""Which of many cases every run tries; `make sweep` tries them all."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

if TYPE_CHECKING:
    from collections.abc import Iterable


def some_of(cases: Iterable[Any], every: int = 3) -> list[Any]:
    """Return the cases for `parametrize`: one in `every` as it is, the others for a sweep."""
    return [
        pytest.param(case, marks=pytest.mark.sweep) if number % every else case
        for number, case in enumerate(cases)
    ]
