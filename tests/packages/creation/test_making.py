from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError
from studio.packages.creation.making import create_package
from studio.packages.creation.new_package import NewPackage
from tests.support.permissions import open_folder, unprivileged

if TYPE_CHECKING:
    from pathlib import Path

MINE = NewPackage("my_pkg", "ament_python")


def test_a_package_is_made_with_all_folders_above(tmp_path: Path):
    made = create_package(tmp_path / "ws" / "src", MINE)
    assert made[0] == tmp_path / "ws" / "src" / "my_pkg" / "package.xml"
    assert [one.name for one in (tmp_path / "ws" / "src").iterdir()] == ["my_pkg"]


def test_what_is_there_is_never_written_over(tmp_path: Path):
    (tmp_path / "my_pkg").write_text("mine")
    with pytest.raises(NotMadeError, match="something of that name"):
        create_package(tmp_path, MINE)
    assert (tmp_path / "my_pkg").read_text() == "mine"


def test_all_reasons_are_said_at_once(tmp_path: Path):
    with pytest.raises(NotMadeError, match=r"small letters.*no e-mail address"):
        create_package(tmp_path, NewPackage("My-Pkg", maintainer_email="x"))
    assert list(tmp_path.iterdir()) == []


def test_where_the_system_refuses_nothing_is_left():
    with open_folder() as folder:
        with unprivileged(), pytest.raises(NotMadeError, match="the system refused"):
            create_package(folder, MINE)
        assert list(folder.iterdir()) == []
