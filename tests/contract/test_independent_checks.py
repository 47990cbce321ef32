# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
# pyright: reportUnknownArgumentType=false, reportAttributeAccessIssue=false
"""Our checks agree with a script that shares nothing with them, over models and the corpus."""

from __future__ import annotations

from typing import TYPE_CHECKING, TypeAlias

import pytest
from lxml import etree

from studio.description.evaluator.stock_xacro import export_urdf
from studio.errors import PackageError
from studio.packages.uris import resolve_uri
from studio.packages.workspace import open_location
from studio.robot.checks.finding import CheckedRobot
from studio.robot.checks.robot_checks import check_robot
from studio.robot.meshes.textured import mesh_uris
from tests.support.descriptions import policy_for
from tests.support.expanded import Assembled, Expanded, expanded_robots
from tests.support.independent_checks import inertia_faults, missing_meshes, packages, root_faults

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

    from studio.packages.workspace import Location

Opinion: TypeAlias = "tuple[set[str], set[str], set[tuple[str, str]]]"
"""Meshes that are missing, what is wrong with the roots, and (link, fault) of inertias."""

ROBOTS_AT_LEAST = 95
FAULTS_AT_LEAST = 700
ROOT_CODES = frozenset({"no-links", "several-roots", "cycle"})
INERTIA_CODES = {
    "bad-mass": "bad-mass",
    "bad-inertia": "bad-inertia",
    "inertia-triangle": "triangle",
}
WITH_ARGUMENTS = (
    *(("ur.urdf.xacro", {"name": "ur", "ur_type": f"ur{kind}"}) for kind in ("3e", "10e", "30")),
    *(("xarm_device.urdf.xacro", {"dof": dof}) for dof in "567"),
    ("xarm_device.urdf.xacro", {"dof": "6", "robot_type": "lite"}),
)


def ours(one: Expanded, location: Location) -> Opinion:
    """What the studio finds."""
    assembled = Assembled(one.urdf)
    robot = assembled.first.robot
    uris = {uri for link in robot.links.values() for uri in mesh_uris(link)}
    ties = {problem.code for problem in assembled.first.problems} & ROOT_CODES
    checked = CheckedRobot(robot, assembled.assembly.part, lambda _: None, lambda _: None)
    return (
        {uri for uri in uris if not is_found(uri, one.file, location)},
        ties,
        {
            (problem.parts[0].removeprefix("link:"), INERTIA_CODES[problem.code])
            for problem in check_robot(checked)
            if problem.code in INERTIA_CODES
        },
    )


def is_found(uri: str, file: Path, location: Location) -> bool:
    try:
        return resolve_uri(uri, file, location.index, location.served).is_file()
    except PackageError:
        return False


def theirs(one: Expanded, known: dict[str, list[Path]]) -> Opinion:
    """What the script finds."""
    robot = etree.fromstring(one.urdf.encode())
    return missing_meshes(robot, one.file, known), root_faults(robot), set(inertia_faults(robot))


def with_arguments(corpus: Path) -> Iterator[Expanded]:
    policy = policy_for(corpus)
    for name, arguments in WITH_ARGUMENTS:
        file = next(corpus.rglob(name))
        yield Expanded(file, export_urdf(str(file), arguments, policy))


@pytest.fixture
def model(models: Path, tmp_path: Path) -> tuple[Expanded, Location, dict[str, list[Path]]]:
    """A shipped model that has meshes."""
    file = next(models.rglob("rover.urdf.xacro"))
    location = open_location(file, [models], tmp_path, {})
    urdf = export_urdf(str(file), {}, policy_for(models))
    return Expanded(file, urdf), location, packages(models)


@pytest.mark.parametrize(
    ("before", "after", "kind"),
    [
        ("", "", None),
        (".stl", ".stlx", 0),
        ("</robot>", '<link name="lonely"/></robot>', 1),
        ("<mass value=", '<mass value="0" was=', 2),
        ("ixx=", 'ixx="-1" was=', 2),
        ("ixx=", 'ixx="1e6" was=', 2),
    ],
)
def test_both_find_what_was_broken_in_a_model(
    model: tuple[Expanded, Location, dict[str, list[Path]]],
    before: str,
    after: str,
    kind: int | None,
):
    whole, location, known = model
    assert before in whole.urdf
    broken = Expanded(whole.file, whole.urdf.replace(before, after) if before else whole.urdf)
    opinion = ours(broken, location)
    assert opinion == theirs(broken, known)
    assert [bool(found) for found in opinion] == [kind == n for n in range(3)]


@pytest.mark.corpus
@pytest.mark.timeout(300)
def test_both_find_the_same_over_the_corpus(corpus: Path, tmp_path: Path):
    location, known = open_location(corpus, [], tmp_path, {}), packages(corpus)
    differing: dict[str, tuple[Opinion, Opinion]] = {}
    robots = faults = 0
    for one in (*expanded_robots(corpus), *with_arguments(corpus)):
        own, other = ours(one, location), theirs(one, known)
        robots += 1
        faults += sum(map(len, own))
        if own != other:
            differing[one.file.relative_to(corpus).as_posix()] = own, other
    assert differing == {}
    assert robots >= ROBOTS_AT_LEAST
    assert faults >= FAULTS_AT_LEAST
