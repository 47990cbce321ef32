"""A package that lies in two places is the one nearer to who asks."""

from __future__ import annotations

import pytest

from studio.description.evaluator.substitution import find_package
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


@pytest.mark.parametrize(
    ("name", "meant"),
    [
        ("realsense2_description", ""),
        ("realsense_description", ""),
        ("ur5_description", ""),
        ("aliengo_descripton", "aliengo_description"),
        ("aliengodescription", "aliengo_description"),
        ("alliengo-description", "aliengo_description"),
    ],
)
def test_only_a_misspelt_name_is_guessed(name: str, meant: str):
    known = {"aliengo_description": ("/w/a",), "ur10_description": ("/w/u",), "zed_msgs": ("/z",)}
    with pytest.raises(Fault) as missing:
        find_package(known, name, "/w/x.xacro")
    assert missing.value.misnamed == ((name, meant) if meant else None)
