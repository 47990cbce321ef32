"""A package that lies in two places is the one nearer to who asks."""

from __future__ import annotations

import pytest

from studio.description.evaluator.packages_found import find_package
from studio.description.faults import Fault

PACKAGES = {
    "one": ("/w/src/one",),
    "twice": ("/w/src/b/twice", "/w/src/a/twice"),
}


@pytest.mark.parametrize(
    ("name", "asking", "folder"),
    [
        ("one", "/elsewhere/x.xacro", "/w/src/one"),
        ("twice", "/w/src/a/robot/urdf/x.xacro", "/w/src/a/twice"),
        ("twice", "/w/src/b/robot/x.xacro", "/w/src/b/twice"),
        ("twice", "/w/src/c/x.xacro", "/w/src/b/twice"),
    ],
)
def test_the_folder_that_shares_the_longest_path(name: str, asking: str, folder: str):
    assert find_package(PACKAGES, name, asking) == folder


def test_a_missing_package_names_itself():
    with pytest.raises(Fault) as missing:
        find_package(PACKAGES, "none", "/w/x.xacro")
    assert missing.value.package == "none"
    assert '"none" was not found' in missing.value.sentence
