from __future__ import annotations

from typing import TYPE_CHECKING

from studio.course.lessons.files import write_files
from studio.documents.lessons.package_checks import package_verdict
from studio.documents.lessons.verdict import HOLDS
from studio.live.programs.inspecting import inspect
from studio.settings import repository_or_wheel

if TYPE_CHECKING:
    from pathlib import Path

COURSE = repository_or_wheel("frontend_assets") / "lessons"


def replace(file: Path, old: str, new: str) -> None:
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new))


def test_a_package_of_no_opened_folder_is_missing(tmp_path: Path):
    assert package_verdict({"name": "harbor"}, ()).code == "package.none"
    assert package_verdict({"name": "harbor"}, (inspect(tmp_path),)).code == "package.none"


def test_the_packages_of_the_lesson_hold_once_each_fault_is_mended(tmp_path: Path):
    write_files(COURSE, "mend_a_package", tmp_path / "ws")
    source = tmp_path / "ws" / "src"
    harbor, interfaces = source / "harbor", source / "harbor_interfaces"

    def verdicts() -> list[tuple[str, str]]:
        found = [
            package_verdict({"name": name}, (inspect(tmp_path / "ws"),))
            for name in ("harbor", "harbor_interfaces")
        ]
        return [(one.code, one.found.get("count", "")) for one in found]

    assert verdicts() == [("package.problems", "2"), ("package.problems", "3")]
    replace(harbor / "setup.py", "harbor.server_node", "harbor.tide_server_node")
    replace(harbor / "package.xml", "<depend>rclpy</depend>\n",
            "<depend>rclpy</depend>\n  <depend>harbor_interfaces</depend>\n")  # fmt: skip
    replace(interfaces / "package.xml", "ament_cmake/build", "ament_cmake</build")
    replace(interfaces / "CMakeLists.txt", "(${PROJECT_NAME})\n  \"srv/Tide.srv\"",
            "(${PROJECT_NAME}\n  \"srv/Tide.srv\"\n)")  # fmt: skip
    replace(interfaces / "srv" / "Tide.srv", "high float64", "high\nfloat64")
    assert verdicts() == [("", ""), ("", "")]
    assert package_verdict({"name": "harbor"}, (inspect(tmp_path / "ws"),)) == HOLDS
