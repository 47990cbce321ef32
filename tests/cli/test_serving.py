"""Options of the commands that start the server: how ROS is joined is checked before it starts."""

from __future__ import annotations

from argparse import ArgumentParser
from typing import TYPE_CHECKING

import pytest

from studio.cli.serving import add_server_options, server_settings
from studio.errors import SettingsError
from studio.settings import WireChoice
from tests.support.command_line import studio

if TYPE_CHECKING:
    from argparse import Namespace
    from pathlib import Path


def parsed(*words: str) -> Namespace:
    parser = ArgumentParser()
    add_server_options(parser)
    return parser.parse_args(list(words))


def test_ros_is_joined_as_the_options_say():
    words = ("--connect", "tcp/a:1", "--connect", "tls/b:2", "--domain", "7", "--router", "off")
    assert server_settings(parsed(*words)).wire == WireChoice("off", ("tcp/a:1", "tls/b:2"), 7)
    assert server_settings(parsed()).wire == WireChoice("auto", (), None)


@pytest.mark.parametrize("option", ["--connect", "--router"])
@pytest.mark.parametrize("command", ["demo", "open"])
def test_an_endpoint_that_is_none_is_said_before_anything_starts(command: str, option: str):
    ran = studio(command, option, "somewhere")
    assert ran.code == 2
    assert "somewhere" in ran.err


@pytest.mark.parametrize("domain", ["-1", "233", "many"])
def test_a_domain_that_is_none_is_a_wrong_command_line(
    domain: str, capsys: pytest.CaptureFixture[str]
):
    with pytest.raises(SystemExit) as ended:
        parsed("--domain", domain)
    assert ended.value.code == 2
    assert "--domain" in capsys.readouterr().err


def test_folders_of_displays_come_from_the_command_line_alone(tmp_path: Path):
    folder = tmp_path / "own"
    folder.mkdir()
    words = ("--displays", str(folder), "--displays", str(tmp_path))
    assert server_settings(parsed(*words)).display_folders == (folder, tmp_path)
    assert server_settings(parsed()).display_folders == ()
    with pytest.raises(SettingsError, match="gone is none"):
        server_settings(parsed("--displays", str(tmp_path / "gone")))


def test_folders_whose_programs_may_be_run_come_from_the_command_line_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("HOME", str(tmp_path / "home"))
    folder, link = tmp_path / "home" / "ws", tmp_path / "link"
    folder.mkdir(parents=True)
    link.symlink_to(folder)
    words = ("--allow-run", str(folder), "--allow-run", str(link))
    assert server_settings(parsed(*words)).run_folders == (folder, folder)
    assert server_settings(parsed()).run_folders == ()
    with pytest.raises(SettingsError, match="--allow-run takes a folder"):
        server_settings(parsed("--allow-run", str(tmp_path / "gone")))
    for wide in ("/", str(tmp_path / "home")):
        with pytest.raises(SettingsError, match="inside it"):
            server_settings(parsed("--allow-run", wide))
