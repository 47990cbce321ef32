"""Where the real robot descriptions are that tests go through."""

from __future__ import annotations

import os
from pathlib import Path

import pytest


def corpus() -> Path:
    """The corpus folder; skips the test without it."""
    named = os.environ.get("STUDIO_CORPUS")
    if not named:
        pytest.skip("STUDIO_CORPUS names no folder of real robot descriptions")
    folder = Path(named)
    assert folder.is_dir(), f"STUDIO_CORPUS is {named}, which is no folder"
    return folder.resolve()
