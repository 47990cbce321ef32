from __future__ import annotations

from pathlib import Path

from studio.cli import commands
from studio.cli.commands import summaries
from tests.support.command_line import studio

FOLDER = Path(commands.__file__).parent


def test_every_file_and_folder_is_a_command_and_says_in_its_first_line_what_it_does():
    found = summaries()
    assert set(found) == {one.stem for one in FOLDER.iterdir() if one.stem[0] not in "_."}
    assert all(found.values()), found
    assert list(found)[:3] == ["demo", "open", "check"]


def test_the_help_lists_every_command_with_its_summary():
    words = " ".join(studio("--help").out.split())
    for name, summary in summaries().items():
        assert f"{name} {summary}" in words
