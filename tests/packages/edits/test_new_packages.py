from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import pytest

from studio.errors import NotMadeError
from studio.packages.creation.new_package import NewPackage
from studio.packages.edits.new_files import new_interface
from studio.packages.edits.new_packages import (
    new_description_package,
    new_package,
)
from studio.packages.edits.writing import write_edit
from studio.packages.roots import ServedRoots
from studio.packages.sources.package_source import PackageSource
from tests.support.seeded_packages import KNOWN, codes

if TYPE_CHECKING:
    from pathlib import Path

MINE = NewPackage("mine", license="MIT", description="Mine.", maintainer_email="a@b.c")


def test_packages_of_each_kind_have_no_fault(tmp_path: Path):
    roots = ServedRoots([tmp_path])
    write_edit(new_package(tmp_path, MINE), roots)
    write_edit(new_description_package(tmp_path, "my_rover_description", "rover"), roots)
    assert codes(tmp_path) == set()
    with pytest.raises(NotMadeError, match="something of that name"):
        new_package(tmp_path, MINE)


def test_a_package_of_interfaces_takes_its_first_one(tmp_path: Path):
    roots = ServedRoots([tmp_path])
    write_edit(new_package(tmp_path, replace(MINE, has_interfaces=True)), roots)
    source = PackageSource(tmp_path / "mine")
    write_edit(new_interface(source, "msg", "Quote", "", KNOWN), roots)
    assert codes(tmp_path) == set()
    lists = (tmp_path / "mine" / "CMakeLists.txt").read_text()
    assert lists.count("find_package(rosidl_default_generators REQUIRED)") == 1


def test_names_are_checked(tmp_path: Path):
    for make in (
        lambda: new_description_package(tmp_path, "../x"),
        lambda: new_package(tmp_path, NewPackage("A")),
        lambda: new_package(tmp_path, replace(MINE, build_type="cmake", has_interfaces=True)),
    ):
        with pytest.raises(NotMadeError):
            make()
