"""The page's reader of messages is tested with what the codec here writes."""

from __future__ import annotations

from tests.support.golden_cdr import FILE, golden_text


def test_the_golden_messages_are_fresh():
    assert FILE.read_text(encoding="utf-8").rstrip("\n") == golden_text(), (
        "run: python -m tests.support.golden_cdr"
    )
