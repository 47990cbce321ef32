from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.packages.edits.cmake_edits import generated, installed_folder, installed_program
from studio.packages.sources.cmake import CMakeLists
from studio.packages.sources.spans import with_replacements

HEAD = (
    "cmake_minimum_required(VERSION 3.8)\nproject(p)  # ü\nfind_package(ament_cmake REQUIRED)\n\n"
)
CALLS = [
    "",
    'rosidl_generate_interfaces(${PROJECT_NAME}\n  "msg/A.msg"\n)\n',
    "rosidl_generate_interfaces(${PROJECT_NAME} msg/A.msg DEPENDENCIES std_msgs)\n",
    'rosidl_generate_interfaces(${PROJECT_NAME}\n  "msg/A.msg"  # the first )\n'
    "  DEPENDENCIES std_msgs\n)\n",
    'set(files\n  "msg/A.msg"\n)\nrosidl_generate_interfaces(${PROJECT_NAME}\n  ${files}\n'
    "  DEPENDENCIES std_msgs\n)\n",
    'ROSIDL_GENERATE_INTERFACES( p "msg/A.msg" )\n',
]
TAIL = "if(BUILD_TESTING)\n  find_package(ament_lint_auto REQUIRED)\nendif()\n\nament_package()\n"


def lists_of(text: str) -> CMakeLists:
    return CMakeLists("CMakeLists.txt", text.encode())


def interfaces(lists: CMakeLists) -> list[str]:
    calls = lists.of("rosidl_generate_interfaces", "set")
    return [one for call in calls for one in call.values if one.endswith((".msg", ".srv"))]


@given(st.sampled_from(CALLS), st.sampled_from(["\n", "\r\n"]))
def test_an_interface_is_generated_and_all_else_stays(call: str, eol: str):
    text = (HEAD + call + TAIL).replace("\n", eol)
    before = lists_of(text)
    changes = generated(before, "srv/B.srv", ["geometry_msgs", "std_msgs"])
    after = lists_of(with_replacements(text.encode(), changes).decode())
    assert not after.fault
    assert interfaces(after) == [*interfaces(before), "srv/B.srv"]
    assert {"rosidl_default_generators", "geometry_msgs", "std_msgs"} <= set(after.found_packages)
    (made,) = after.of("rosidl_generate_interfaces")
    assert sorted(one.value for one in made.after("DEPENDENCIES")) == ["geometry_msgs", "std_msgs"]
    others = [
        one.values for one in before.calls if one.name not in {"rosidl_generate_interfaces", "set"}
    ]
    kept = [one.values for one in after.calls]
    assert all(one in kept for one in others)
    assert is_subsequence(text, after.source.text)
    assert generated(after, "srv/B.srv", ["geometry_msgs", "std_msgs"]) == ()


def is_subsequence(inner: str, outer: str) -> bool:
    letters = iter(outer)
    return all(letter in letters for letter in inner)


@pytest.mark.parametrize(
    "rule",
    [
        "",
        "install(DIRECTORY urdf DESTINATION share/${PROJECT_NAME})\n",
        "install(\n  DIRECTORY urdf\n  DESTINATION share/${PROJECT_NAME}/\n)\n",
        "install(DIRECTORY urdf/ DESTINATION share/${PROJECT_NAME}/urdf)\n",
    ],
)
def test_a_folder_is_installed_once(rule: str):
    text = HEAD + rule + TAIL
    after = lists_of(
        with_replacements(text.encode(), installed_folder(lists_of(text), "launch")).decode()
    )
    folders = [name for kind, name, _ in after.installs() if kind == "DIRECTORY"]
    assert "launch" in folders
    assert installed_folder(after, "launch") == ()


def test_a_program_is_installed_beside_the_others():
    text = HEAD + TAIL
    for name in ("scripts/a.py", "scripts/b.py", "scripts/b.py"):
        changes = installed_program(lists_of(text), name)
        text = with_replacements(text.encode(), changes).decode()
    assert text.count("install(") == 1
    assert "  PROGRAMS scripts/a.py scripts/b.py\n  DESTINATION lib/${PROJECT_NAME}\n" in text


@pytest.mark.parametrize("text", ["", "project(p\n", "find_package(x)\ninstall(a"])
def test_a_broken_file_is_left_alone(text: str):
    with pytest.raises(ValueError, match="CMakeLists"):
        generated(lists_of(text), "msg/A.msg", [])
