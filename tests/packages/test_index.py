"""Which folder a name means, and for whom."""

from __future__ import annotations

from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from studio.errors import PackageNotFoundError
from studio.packages.index import Indexed, PackageIndex, Rank, nearest
from studio.problems import Severity


def opened(folder: str, name: str = "arm") -> Indexed:
    return Indexed(name, Path(folder), Rank.OPENED)


def test_a_name_is_found_wherever_the_asker_is():
    index = PackageIndex([opened("/ws/arm")])
    assert index.best("arm", "/elsewhere/robot.xacro") == Path("/ws/arm")
    assert "arm" in index


def test_a_missing_name_says_who_asked_and_what_to_do():
    with pytest.raises(PackageNotFoundError, match=r'robot.xacro: package "leg".*--package-path'):
        PackageIndex([opened("/ws/arm")]).best("leg", "/ws/robot.xacro")


def test_of_two_copies_the_one_nearest_to_the_asking_file_is_used():
    index = PackageIndex([opened("/ws/repo1/arm"), opened("/ws/repo2/arm")])
    assert index.best("arm", "/ws/repo1/rover/a.xacro") == Path("/ws/repo1/arm")
    assert index.best("arm", "/ws/repo2/rover/a.xacro") == Path("/ws/repo2/arm")


def test_copies_equally_near_are_taken_the_same_way_every_time():
    folders = [opened("/ws/b/arm"), opened("/ws/a/arm"), opened("/ws/a/deeper/arm")]
    for order in (folders, folders[::-1]):
        assert PackageIndex(order).best("arm", "/ws/rover/a.xacro") == Path("/ws/a/arm")


def test_a_source_wins_over_what_is_installed_however_near():
    index = PackageIndex(
        [Indexed("arm", Path("/ws/install/arm"), Rank.INSTALLED, 1), opened("/other/arm")]
    )
    assert index.candidates("arm", "/ws/install/rover/a.xacro") == (Path("/other/arm"),)


def test_an_earlier_prefix_overlays_a_later_one():
    index = PackageIndex(
        [
            Indexed("arm", Path("/opt/ros/share/arm"), Rank.INSTALLED, 2),
            Indexed("arm", Path("/ws/install/arm/share/arm"), Rank.INSTALLED, 1),
        ]
    )
    assert index.best("arm", "/opt/ros/share/x/a") == Path("/ws/install/arm/share/arm")


def test_a_nested_copy_serves_only_its_own_files_and_names_that_nobody_else_has():
    nested = Indexed("arm", Path("/ws/rover/test/arm"), Rank.NESTED)
    index = PackageIndex([nested, opened("/ws/arm")])
    assert index.best("arm", "/ws/rover/a.xacro") == Path("/ws/arm")
    assert index.best("arm", "/ws/rover/test/arm/a.xacro") == Path("/ws/rover/test/arm")
    assert PackageIndex([nested]).best("arm", "/ws/rover/a.xacro") == nested.folder


def test_a_chosen_folder_is_the_only_one():
    index = PackageIndex([opened("/ws/arm")]).with_chosen("arm", Path("/chosen"))
    assert index.candidates("arm", "/ws/arm/a.xacro") == (Path("/chosen"),)
    assert PackageIndex([]).with_chosen("leg", Path("/leg")).best("leg", "/a") == Path("/leg")


def test_a_name_that_exists_twice_is_a_warning_that_says_which_copy_is_used():
    index = PackageIndex([opened("/ws/a/arm"), opened("/ws/b/arm"), opened("/ws/leg", "leg")])
    (problem,) = index.duplicates("/ws/b/rover/a.xacro")
    assert problem.severity is Severity.WARNING
    assert "/ws/b/arm is used" in problem.sentence
    assert "/ws/a/arm is not" in problem.sentence
    assert index.duplicates("/ws/b/rover/a.xacro", ["leg", "unknown"]) == []


def test_a_mapping_has_every_name_best_first():
    index = PackageIndex([opened("/ws/a/arm"), opened("/ws/b/arm"), opened("/ws/leg", "leg")])
    assert index.mapping_for("/ws/b/rover/a.xacro") == {
        "arm": ("/ws/b/arm", "/ws/a/arm"),
        "leg": ("/ws/leg",),
    }


parts = st.lists(st.sampled_from(["a", "b", "ab"]), min_size=1, max_size=4)
paths = parts.map(lambda steps: "/" + "/".join(steps))


@given(st.lists(paths, min_size=1, max_size=4, unique=True), paths, paths)
def test_asking_the_mapping_of_an_entry_equals_asking_the_index(
    folders: list[str], entry: str, asking_file: str
):
    """A worker that knows only the entry's mapping finds as near a folder for any other file."""
    index = PackageIndex([opened(folder) for folder in folders])
    found = nearest(index.mapping_for(entry)["arm"], asking_file)
    best = index.best("arm", asking_file)
    assert shared(found, asking_file) == shared(str(best), asking_file)


def shared(one: str, other: str) -> int:
    count = 0
    for a, b in zip(Path(one).parts, Path(other).parts, strict=False):
        if a != b:
            break
        count += 1
    return count
