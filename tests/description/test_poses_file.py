"""The file of a person's own poses: written for people, kept as they left it, read as hostile."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.description.poses import (
    POSE_LIMIT,
    SIZE_LIMIT_BYTES,
    NamedPose,
    position_of,
    read_poses,
    rounded,
    write_poses,
)
from studio.errors import PosesFileError

PATH = "/robot/arm.poses.yaml"
HOME = NamedPose("Home", {"shoulder": 0.5, "elbow": -1.25})
FOLDED = NamedPose("Folded", {"shoulder": 0.0})


def write(before: bytes, *poses: NamedPose) -> bytes:
    return write_poses(PATH, "arm.urdf.xacro", before, poses)


def told(data: bytes) -> list[tuple[str, dict[str, float]]]:
    return [(one.name, one.positions) for one in read_poses(PATH, data)]


def test_a_new_file_says_what_it_is_and_holds_the_poses():
    data = write(b"", HOME)
    assert data.decode() == (
        "# Poses of arm.urdf.xacro: named joint positions, rad or m.\n"
        "# Written by the studio; edit it as you like.\n"
        "version: 1\n"
        "poses:\n"
        "  - name: Home\n"
        "    joints:\n"
        "      shoulder: 0.5\n"
        "      elbow: -1.25\n"
    )
    assert told(data) == [("Home", HOME.positions)]
    assert read_poses(PATH, data)[0].line == 5


def test_comments_and_layout_of_other_poses_stay():
    before = write(b"", HOME, FOLDED).replace(
        b"  - name: Folded", b"  # for the van\n  - name: Folded"
    )
    before = before.replace(b"elbow: -1.25", b"elbow:   -1.25 # stiff")
    assert write(before, HOME, FOLDED) == before
    after = write(before, HOME, FOLDED, NamedPose("Up", {"elbow": 1.0}))
    assert after.startswith(before)
    assert write(after, HOME, FOLDED) == before
    only = write(before, FOLDED)
    assert b"for the van" in only
    assert told(only) == [("Folded", FOLDED.positions)]


def test_the_last_pose_leaves_a_file_without_any():
    assert told(write(write(b"", HOME))) == []


@pytest.mark.parametrize(
    "name",
    [
        "yes",
        "1.5",
        "a: b",
        "# no",
        "'",
        '"',
        "<b>",
        "käse 🤖",
        "a\u2028b",
        "- x",
        "*x",
        "null",
        "{",
    ],
)
def test_any_name_reads_back_as_it_was(name: str):
    assert told(write(b"", NamedPose(name, {name: 1.0}))) == [(name, {name: 1.0})]


_NAMES = st.text(st.characters(codec="utf-8"), min_size=1, max_size=8)


@given(st.dictionaries(_NAMES, st.floats(-100, 100), max_size=4))
def test_positions_read_back_as_rounded(positions: dict[str, float]):
    wanted = {name: rounded(value) for name, value in positions.items()}
    assert told(write(b"", NamedPose("x", wanted))) == [("x", wanted)]


def test_half_a_character_is_in_no_file():
    with pytest.raises(PosesFileError, match="cannot hold"):
        write(b"", NamedPose("x", {"\ud800": 1.0}))


@pytest.mark.parametrize(
    ("text", "reason"),
    [
        ("poses: 7", "line 1 must be a list"),
        ("version: 2\nposes: []", "another version"),
        ("poses:\n  - name: x", "without joints"),
        ("poses:\n  - {name: x, joints: {a: .nan}}", "line 2 is no position"),
        ("poses:\n  - {name: x, joints: {a: 1e999}}", "is no position"),
        ("poses:\n  - {name: x, joints: {a: 0x10}}", "is no position"),
        ("poses:\n  - {name: x, joints: {a: 1, a: 2}}", 'has "a" twice'),
        ("poses:\n  - {name: x, joints: {}}\n  - {name: x, joints: {}}", 'has "x" twice'),
        ("poses:\n  - {name: '', joints: {}}", "is no name"),
        ("poses: &a [*a]", "anchor"),
        ("poses: !!python/object:os.system []", "anchor, alias or tag"),
        ("[" * 50, "nested too deeply"),
        ("poses: [", "is no YAML"),
        ("other: 1", 'unknown key "other"'),
        ("\x00", "is no YAML"),
    ],
)
def test_what_is_no_list_of_poses_is_told_with_its_line(text: str, reason: str):
    with pytest.raises(PosesFileError, match=reason):
        read_poses(PATH, text.encode())
    with pytest.raises(PosesFileError):
        write(text.encode(), HOME)


def test_what_is_no_text_or_too_much_is_refused():
    with pytest.raises(PosesFileError, match="UTF-8"):
        read_poses(PATH, b"\xff\xfe")
    with pytest.raises(PosesFileError, match="larger than 1 MB"):
        read_poses(PATH, b" " * (SIZE_LIMIT_BYTES + 1))
    many = [NamedPose(f"p{number}", {"a": 0.0}) for number in range(POSE_LIMIT + 1)]
    with pytest.raises(PosesFileError):
        write(b"", *many)


@pytest.mark.parametrize(
    "text", ["", "nan", "inf", "1e999", "0x10", "1_0", "1 2", "1e10", "1" * 200]
)
def test_what_no_joint_can_have_is_no_position(text: str):
    assert position_of(text) is None


def test_a_position_may_have_blanks_around_and_an_exponent():
    assert position_of(" -1.5e-3\n") == -0.0015
