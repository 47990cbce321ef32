from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.hostile import HostileStudio, hostile_studio

if TYPE_CHECKING:
    from collections.abc import Iterator


@pytest.fixture(scope="module")
def studio() -> Iterator[HostileStudio]:
    """A studio that hostile files are opened in, one for the tests of a module."""
    with hostile_studio() as made:
        yield made
