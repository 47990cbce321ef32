from pathlib import Path

import pytest

from studio.errors import UnknownTypeError
from studio.live.connection.opened_types import take_types
from studio.packages.workspace import Location, open_location
from studio.problems import Place
from studio.ros.types.library import TypeLibrary
from tests.support.packages import write_package

WHEELS = "course_rover/msg/Wheels"


@pytest.fixture
def location(tmp_path: Path) -> Location:
    files = {
        "urdf/rover.urdf": '<robot name="r"><link name="l"/></robot>',
        "msg/Wheels.msg": "uint8 count 4\nstd_msgs/Header header\n",
    }
    package = write_package(tmp_path / "src/course_rover", files=files)
    return open_location(package / "urdf/rover.urdf", [], tmp_path / "data", {})


def test_types_beside_an_opened_robot_are_known_with_their_hash(location: Location):
    library = TypeLibrary("jazzy")
    with pytest.raises(UnknownTypeError):
        library.message(WHEELS)
    assert take_types(location, library) == ()
    assert library.message(WHEELS)().count == 4
    assert library.hash_of(WHEELS).startswith("RIHS01_")


def test_what_is_known_already_is_not_taken_again(location: Location):
    library = TypeLibrary("jazzy")
    take_types(location, library)
    kind = library.message(WHEELS)
    take_types(location, library)
    assert library.message(WHEELS) is kind


def test_a_text_that_breaks_a_rule_is_a_warning_at_its_line_and_the_others_are_known(
    location: Location, tmp_path: Path
):
    folder = tmp_path / "src/course_rover/msg"
    (folder / "Axle.msg").write_text("uint8 count\nuint8 count\n")
    library = TypeLibrary("jazzy")
    (problem,) = take_types(location, library)
    assert (problem.code, problem.place) == (
        "unusable-interfaces",
        Place(str(folder / "Axle.msg"), 2),
    )
    assert "count stands there twice, first in line 1" in problem.sentence
    assert library.message(WHEELS)().count == 4
    with pytest.raises(UnknownTypeError, match=r"Axle\.msg:2"):
        library.message("course_rover/msg/Axle")
