from __future__ import annotations

import io
import sys
from typing import TYPE_CHECKING

from hypothesis import given
from hypothesis import strategies as st

from studio.cli.terminal import harmless, shown

if TYPE_CHECKING:
    import pytest


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_what_steers_a_terminal_is_written_out(monkeypatch: pytest.MonkeyPatch):
    text = "\x1b[2Jgone\r\u202eover\n\tkept ü"
    assert harmless(text) == "\\x1b[2Jgone\\r\\u202eover\n\tkept ü"
    monkeypatch.setattr(sys, "stdout", Terminal())
    assert shown(text) == harmless(text)


def test_into_a_file_a_text_goes_whole(monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setattr(sys, "stdout", io.StringIO())
    assert shown("\x1b[2J\r\n") == "\x1b[2J\r\n"


@given(st.text())
def test_no_text_steers(text: str):
    assert all(letter >= " " or letter in "\n\t" for letter in harmless(text))
    assert harmless(harmless(text)) == harmless(text)
