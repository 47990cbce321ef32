"""Types that a test alone knows."""

from __future__ import annotations

import pytest

from studio.ros.types.library import TypeLibrary


@pytest.fixture
def library(monkeypatch: pytest.MonkeyPatch) -> TypeLibrary:
    """Of this test alone: what is added is gone after it."""
    made = TypeLibrary("jazzy")

    def types_of(_: str) -> TypeLibrary:
        return made

    for place in ("studio.ros.messages", "studio.live.connection.link"):
        monkeypatch.setattr(f"{place}.types_of", types_of)
    return made
