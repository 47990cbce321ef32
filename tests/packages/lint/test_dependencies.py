from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import (
    changed,
    codes,
    finding,
    interface_package,
    mended,
    sound,
    written,
)

if TYPE_CHECKING:
    from pathlib import Path


def test_an_import_that_package_xml_does_not_name_is_added(tmp_path: Path):
    package = sound(tmp_path)
    written(
        package,
        "my_pkg/hear.py",
        "import math\n\nfrom geometry_msgs.msg import Twist\n\nprint(Twist, math)\n",
    )
    mended(tmp_path, "missing-depend", "hear.py", 3)
    assert "<depend>geometry_msgs</depend>" in (package / "package.xml").read_text()
    assert codes(tmp_path) == set()


def test_modules_of_the_system_are_named_as_rosdep_knows_them(tmp_path: Path):
    package = sound(tmp_path)
    written(package, "my_pkg/numbers_of.py", "import numpy as np\n\nprint(np)\n")
    mended(tmp_path, "missing-depend", "numbers_of.py", 1)
    assert "<exec_depend>python3-numpy</exec_depend>" in (package / "package.xml").read_text()


def test_a_misspelt_package_is_mended_and_a_strange_one_only_told(tmp_path: Path):
    package = sound(tmp_path)
    changed(package, "package.xml", "<depend>std_msgs</depend>", "<depend>std_msg</depend>")
    mended(tmp_path, "unknown-package", "package.xml", 11)
    changed(package, "package.xml", "<depend>std_msgs</depend>", "<depend>quux_of_mine</depend>")
    assert finding(tmp_path, "unlisted-package", "package.xml", 11).severity == "info"


def test_a_package_of_interfaces_gets_all_its_entries(tmp_path: Path):
    # A listing of the course, S0:600: the interface package was marked depend only
    package = interface_package(tmp_path)
    assert codes(tmp_path) == set()
    for line in (
        "  <buildtool_depend>rosidl_default_generators</buildtool_depend>\n",
        "  <exec_depend>rosidl_default_runtime</exec_depend>\n",
        "  <member_of_group>rosidl_interface_packages</member_of_group>\n",
    ):
        changed(package, "package.xml", line, "")
    for _ in range(3):
        mended(tmp_path, "missing-interface-depend", "package.xml")
    assert codes(tmp_path) == set()


def test_a_package_that_needs_itself_does_not(tmp_path: Path):
    changed(
        sound(tmp_path),
        "package.xml",
        "<depend>std_msgs</depend>",
        "<depend>std_msgs</depend><depend>my_pkg</depend>",
    )
    mended(tmp_path, "depends-on-itself", "package.xml", 11)
