"""Every code of a verdict has its sentence in both languages of the page."""

from __future__ import annotations

import json
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[3]
WORDS = json.loads((ROOT / "frontend_assets/panels/lessons/panel.json").read_text())["words"]
SOURCES = "".join(one.read_text() for one in (ROOT / "studio/documents/lessons").glob("*.py"))
MADE = {f"{what}.none" for what in ("topic", "service", "action")}
"""By `_typed`, of what it looks for."""


def codes() -> set[str]:
    found = re.findall(r'(?:missing\(|_FAULTY: Final = |none: str = )"([a-z_.]+)"', SOURCES)
    ends = re.findall(r'"((?:publishers|subscriptions)\.none)"', SOURCES)
    return {*found, *ends} | MADE


@pytest.mark.parametrize("language", WORDS)
def test_all_that_may_be_missing_is_said(language: str):
    assert len(codes()) > 30
    said = {one.removeprefix("lessons.missing.") for one in WORDS[language]}
    assert codes() - said == set()
