from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

if TYPE_CHECKING:
    from pathlib import Path


@pytest.fixture(autouse=True)
def own_folders(tmp_path_factory: pytest.TempPathFactory, monkeypatch: pytest.MonkeyPatch):
    """Commands see no package and no recent file of whoever runs the tests."""
    folder: Path = tmp_path_factory.mktemp("folder")
    monkeypatch.setenv("STUDIO_DATA_DIR", str(folder / "data"))
    monkeypatch.chdir(folder)
    for name in ("ROS_DOMAIN_ID", "ROS_DISTRO", "AMENT_PREFIX_PATH", "ZENOH_CONFIG_OVERRIDE"):
        monkeypatch.delenv(name, raising=False)
