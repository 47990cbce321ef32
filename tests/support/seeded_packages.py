"""Sound packages with one fault each, and what is found in them before and after its mend."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.live.known_packages import known_packages
from studio.packages.creation.making import create_package
from studio.packages.creation.new_package import NewPackage
from studio.packages.edits.package_edit import PackageEdit
from studio.packages.edits.writing import write_edit
from studio.packages.inspection.inspecting import PackagesFound
from studio.packages.lint.package_checks import check_packages
from studio.packages.roots import ServedRoots
from studio.ros.types.library import TypeLibrary

if TYPE_CHECKING:
    from pathlib import Path

    from studio.packages.creation.new_package import BuildType
    from studio.problems import Problem

KNOWN = known_packages(TypeLibrary("jazzy"))


def sound(
    folder: Path, name: str = "my_pkg", build_type: BuildType = "ament_python", *needs: str
) -> Path:
    """Make a package without any fault."""
    new = NewPackage(
        name,
        build_type,
        needs or (("rclpy", "std_msgs") if build_type == "ament_python" else ()),
        node_name="talker" if build_type == "ament_python" else "",
        license="MIT",
        description="For a test.",
        maintainer_name="Ada",
        maintainer_email="ada@example.com",
    )
    create_package(folder, new)
    return folder / name


def interface_package(folder: Path, name: str = "radio_station_interfaces") -> Path:
    """Make a sound package with GetNowPlaying.srv, as the course wants it."""
    from studio.packages.edits.new_files import new_interface
    from studio.packages.sources.package_source import PackageSource

    package = sound(folder, name, "ament_cmake")
    text = "---\nstring station\nstring song_title\nstring artist\n"
    edit = new_interface(PackageSource(package), "srv", "GetNowPlaying", text, KNOWN)
    write_edit(edit, ServedRoots([folder]))
    return package


def changed(package: Path, file: str, before: str, after: str) -> None:
    """Seed a fault: put other words in the place of some, which are there once."""
    path = package / file
    text = path.read_text()
    assert text.count(before) == 1, f"{before!r} is {text.count(before)} times in {file}"
    path.write_text(text.replace(before, after))


def written(package: Path, file: str, text: str) -> None:
    """Write a file of a package."""
    path = package / file
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text)


def problems(folder: Path) -> tuple[Problem, ...]:
    """Check the packages of a folder."""
    return check_packages(PackagesFound(folder), KNOWN)


def codes(folder: Path) -> set[str]:
    """Name what is found."""
    return {one.code for one in problems(folder)}


def finding(folder: Path, code: str, file: str, line: int = 0) -> Problem:
    """Return the finding of a code in a file; `line` 0: on any."""
    found = problems(folder)
    here = [
        one
        for one in found
        if one.code == code and one.place and one.place.file.endswith(f"/{file}")
    ]
    assert here, f"no {code} in {file} among {[str(one) for one in found]}"
    assert line in (0, here[0].place.line if here[0].place else 0), str(here[0])
    return here[0]


def mended(folder: Path, code: str, file: str, line: int = 0) -> None:
    """Check that a finding is there, make its fix, and check that it is gone and brought none."""
    before = codes(folder)
    one = finding(folder, code, file, line)
    mend(folder, one)
    after = problems(folder)
    assert not [
        str(each) for each in after if (each.code, each.sentence) == (one.code, one.sentence)
    ]
    brought = {each.code for each in after} - before
    assert not brought, f"the fix brought {[str(each) for each in after]}"


def mend(folder: Path, one: Problem) -> None:
    """Make the fix of a finding."""
    assert one.fix is not None, f"no fix: {one}"
    edit = PackageEdit(one.fix.label, "", one.fix.new_files, one.fix.edits)
    write_edit(edit, ServedRoots([folder]))
