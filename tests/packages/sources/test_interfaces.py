from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.packages.sources.interfaces import interface_files, packages_of_interface
from studio.packages.sources.package_source import PackageSource
from tests.support.seeded_packages import written

if TYPE_CHECKING:
    from pathlib import Path


def test_interfaces_are_the_files_in_the_folders_of_their_kinds(tmp_path: Path):
    for name in ("srv/Add.srv", "msg/Quote.msg", "msg/README.md", "other/Lost.msg"):
        written(tmp_path, name, "")
    found = interface_files(PackageSource(tmp_path))
    assert found == [("msg", "msg/Quote.msg"), ("srv", "srv/Add.srv")]


@pytest.mark.parametrize(
    ("text", "kind", "packages"),
    [
        ("geometry_msgs/Point[] p\nstd_msgs/msg/Header h", "msg", ("geometry_msgs", "std_msgs")),
        ("Header header  # std_msgs by itself\nmine/Other o\nstring s", "msg", ("std_msgs",)),
        ("# sensor_msgs/Image is not meant\nint32 order\n---\n---\n", "action", ("action_msgs",)),
    ],
)
def test_an_interface_needs_the_packages_of_its_fields(
    text: str, kind: str, packages: tuple[str, ...]
):
    assert packages_of_interface(text, kind, "mine") == packages
