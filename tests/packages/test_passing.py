from __future__ import annotations

from pathlib import Path

from studio.packages.index import Indexed, PackageIndex, Rank
from studio.packages.passing import VARIABLE, environment_of, passed_packages


def test_source_packages_are_passed_on_and_installed_ones_are_not():
    index = PackageIndex(
        [
            Indexed("far", Path("/other/far"), Rank.OPENED),
            Indexed("near", Path("/ws/src/near"), Rank.OPENED),
            Indexed("ros", Path("/opt/ros/share/ros"), Rank.INSTALLED),
        ]
    )
    passed = environment_of(index, Path("/ws/src/near/setup.py"))
    assert passed == {VARIABLE: "near=/ws/src/near:far=/other/far"}
    assert passed_packages(passed) == {
        "near": Path("/ws/src/near"),
        "far": Path("/other/far"),
    }


def test_of_too_many_the_nearest_are_passed_on():
    near = Indexed("near", Path("/ws/near"), Rank.OPENED)
    many = [Indexed(f"p{n}", Path(f"/far/{'x' * 90}/{n}"), Rank.OPENED) for n in range(3_000)]
    passed = environment_of(PackageIndex([*many, near]), Path("/ws/near/a.py"))
    assert len(passed[VARIABLE]) < 110_000
    assert next(iter(passed_packages(passed))) == "near"


def test_nothing_is_passed_on_where_there_is_nothing():
    assert environment_of(PackageIndex([]), Path("/x")) == {}
    assert passed_packages({VARIABLE: "::broken:"}) == {}
