from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.edited_rover import LIMITS, ROVER, opened

if TYPE_CHECKING:
    from pathlib import Path

    from studio.description.editing.sources import Sources


@pytest.fixture
def rover(tmp_path: Path) -> Path:
    path = tmp_path / "rover.xacro"
    path.write_bytes(ROVER.encode())
    return path


@pytest.fixture
def limits(tmp_path: Path) -> Path:
    path = tmp_path / "limits.yaml"
    path.write_bytes(LIMITS.encode())
    return path


@pytest.fixture
def sources(tmp_path: Path, rover: Path, limits: Path) -> Sources:
    return opened(tmp_path, rover, limits)
