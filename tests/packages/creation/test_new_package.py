from __future__ import annotations

from dataclasses import replace

import pytest

from studio.packages.creation.new_package import NewPackage, faults

FINE = NewPackage("my_pkg", "ament_python", ("rclpy", "std_msgs"), "talker")


def test_a_usual_package_has_no_fault():
    assert list(faults(FINE)) == []


@pytest.mark.parametrize(
    "wrong",
    [
        replace(FINE, name="My-Pkg"),
        replace(FINE, name="test"),
        replace(FINE, name="json"),
        replace(FINE, name="class"),
        replace(FINE, name="rclpy"),
        replace(FINE, name="a"),
        replace(FINE, dependencies=("../../x",)),
        replace(FINE, dependencies=("my_pkg",)),
        replace(FINE, dependencies=("a",) * 1000),
        replace(FINE, node_name="a b"),
        replace(FINE, node_name="import"),
        replace(FINE, library_name="talker"),
        replace(FINE, build_type="ament_cmake", library_name="my_pkg", node_name=""),
        replace(FINE, build_type="catkin"),
        replace(FINE, package_format=1),
        replace(FINE, description=""),
        replace(FINE, description="x" * 5000),
        replace(FINE, license="\x00"),
        replace(FINE, maintainer_email="nobody"),
        replace(FINE, version="1"),
    ],
)
def test_what_forbids_a_package_is_a_sentence(wrong: NewPackage):
    (sentence,) = list(faults(wrong))[:1]
    assert sentence.endswith(".")
    assert len(sentence) < 250
