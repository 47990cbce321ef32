"""What the process of a plug-in answers, asked here without a process of its own."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import pytest

from studio.displays.plugins.requests import Describe, Described, Failed
from studio.displays.plugins.worker import Plugin
from tests.support.plugins import UNLOADABLE, example

if TYPE_CHECKING:
    from pathlib import Path


def described(folder: Path, name: str, text: str) -> object:
    file = folder / f"{name}.py"
    file.write_text(text)
    with (folder / "trace").open("w") as trace:
        return Plugin(trace).answer(Describe(str(file), {}))


@pytest.fixture(autouse=True)
def _path_as_it_was(monkeypatch: pytest.MonkeyPatch) -> None:
    """Loading a file adds its folder to where modules are looked for."""
    monkeypatch.setattr(sys, "path", [*sys.path])


@pytest.mark.parametrize("name", UNLOADABLE)
def test_a_file_without_a_display_says_what_is_wrong_with_it(tmp_path: Path, name: str):
    text, reason = UNLOADABLE[name]
    answer = described(tmp_path, name, text)
    assert isinstance(answer, Failed)
    assert reason in answer.sentence


def test_the_example_of_the_readme_says_what_it_is(tmp_path: Path):
    answer = described(tmp_path, "battery", example())
    assert isinstance(answer, Described)
    assert (answer.kind, answer.doc) == (
        "Battery",
        "How full a battery is, written over the robot.",
    )
