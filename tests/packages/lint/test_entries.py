from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import changed, codes, finding, mended, sound, written

if TYPE_CHECKING:
    from pathlib import Path

ENTRY = "'talker = my_pkg.talker:main',"


def test_entry_points_that_are_not_closed_are_named_with_their_line(tmp_path: Path):
    # A listing of the course, S3:153
    package = sound(tmp_path)
    changed(package, "setup.py", "        ],\n    },\n)\n", "")
    one = finding(tmp_path, "setup-broken", "setup.py")
    assert "Close every bracket" in one.sentence


def test_data_files_and_entry_points_run_together_are_told_apart(tmp_path: Path):
    # A listing of the course, S0:344
    changed(
        sound(tmp_path), "setup.py", "    ],\n    install_requires", "    ]\n    install_requires"
    )
    one = finding(tmp_path, "setup-broken", "setup.py", 9)
    assert "comma" in one.sentence


def test_two_entries_in_one_text_become_two(tmp_path: Path):
    # A listing of the course, S0:363
    package = sound(tmp_path)
    written(package, "my_pkg/other.py", "def main():\n    print(1)\n")
    changed(package, "setup.py", ENTRY, "'talker = my_pkg.talker:main other = my_pkg.other:main',")
    mended(tmp_path, "entry-two-in-one", "setup.py", 22)
    assert codes(tmp_path) == set()


def test_two_names_in_one_entry_become_one(tmp_path: Path):
    # A listing of the course, S0:410
    changed(sound(tmp_path), "setup.py", ENTRY, "'talker = other = my_pkg.talker:main',")
    mended(tmp_path, "entry-form", "setup.py", 22)
    assert codes(tmp_path) == set()


def test_an_entry_whose_file_has_another_name_finds_it(tmp_path: Path):
    # A listing of the course, S0:600/605: server_node, action_server_node.py
    package = sound(tmp_path)
    (package / "my_pkg" / "talker.py").rename(package / "my_pkg" / "talker_node.py")
    mended(tmp_path, "entry-module-missing", "setup.py", 22)
    assert codes(tmp_path) == set()


def test_an_entry_of_a_package_of_another_name_finds_its_own(tmp_path: Path):
    # A listing of the course, S0:344: radio_communication
    changed(sound(tmp_path), "setup.py", "my_pkg.talker", "your_package.talker")
    mended(tmp_path, "entry-module-missing", "setup.py", 22)
    assert codes(tmp_path) == set()


def test_an_entry_without_its_function_is_told(tmp_path: Path):
    changed(sound(tmp_path), "setup.py", "talker:main", "talker:mains")
    mended(tmp_path, "entry-function-missing", "setup.py", 22)
    assert codes(tmp_path) == set()


def test_an_entry_that_names_no_function_is_told(tmp_path: Path):
    changed(sound(tmp_path), "setup.py", "talker:main", "talker")
    finding(tmp_path, "entry-form", "setup.py", 22)


def test_an_entry_said_twice_is_told(tmp_path: Path):
    changed(sound(tmp_path), "setup.py", ENTRY, f"{ENTRY}\n            {ENTRY}")
    finding(tmp_path, "entry-repeated", "setup.py", 23)


def test_a_folder_that_packages_does_not_list_is_listed(tmp_path: Path):
    # A listing of the course, S3:153: scripts
    package = sound(tmp_path)
    written(package, "scripts/__init__.py", "")
    written(package, "scripts/talker.py", "def main():\n    print(1)\n")
    changed(package, "setup.py", "find_packages(exclude=['test'])", "[package_name]")
    changed(package, "setup.py", "my_pkg.talker", "scripts.talker")
    mended(tmp_path, "package-not-listed", "setup.py", 8)
    assert codes(tmp_path) == set()


def test_a_folder_that_find_packages_passes_over_gets_its_init(tmp_path: Path):
    package = sound(tmp_path)
    (package / "my_pkg" / "__init__.py").unlink()
    mended(tmp_path, "init-missing", "setup.py", 22)
    assert codes(tmp_path) == set()


def test_a_setup_cfg_that_is_missing_is_made(tmp_path: Path):
    (sound(tmp_path) / "setup.cfg").unlink()
    mended(tmp_path, "setup-cfg-missing", "setup.py")
    assert codes(tmp_path) == set()


def test_a_setup_cfg_of_another_package_is_mended(tmp_path: Path):
    # A listing of the course, S1: the names disagree
    changed(
        sound(tmp_path), "setup.cfg", "script_dir=$base/lib/my_pkg", "script_dir=$base/lib/other"
    )
    mended(tmp_path, "setup-cfg-folder", "setup.cfg", 2)
    assert codes(tmp_path) == set()


def test_a_setup_cfg_without_a_section_gets_it(tmp_path: Path):
    changed(sound(tmp_path), "setup.cfg", "[install]\ninstall_scripts=$base/lib/my_pkg\n", "")
    mended(tmp_path, "setup-cfg-folder", "setup.cfg")
    assert codes(tmp_path) == set()


def test_a_setup_py_that_starts_nothing_is_told(tmp_path: Path):
    package = sound(tmp_path)
    (package / "setup.py").write_text("print('hello')\n")
    finding(tmp_path, "setup-call", "setup.py")
    (package / "setup.py").write_text("from setuptools import setup\nsetup(name='my_pkg')\n")
    finding(tmp_path, "entry-points-missing", "setup.py", 2)


def test_entries_of_setup_cfg_are_followed_too(tmp_path: Path):
    package = sound(tmp_path)
    changed(package, "setup.py", ENTRY, "")
    lines = (
        "[options.entry_points]\nconsole_scripts =\n    # these\n\n    talker = my_pkg.talker:{}\n"
    )
    config = (package / "setup.cfg").read_text()
    (package / "setup.cfg").write_text(config + lines.format("mains"))
    mended(tmp_path, "entry-function-missing", "setup.cfg", 9)
    assert codes(tmp_path) == set()
    (package / "setup.cfg").write_text(config + lines.format("main other = my_pkg.talker:main"))
    mended(tmp_path, "entry-two-in-one", "setup.cfg", 9)
    assert codes(tmp_path) == set()


def test_a_module_of_quite_another_name_is_not_guessed(tmp_path: Path):
    package = sound(tmp_path)
    (package / "my_pkg" / "talker.py").rename(package / "my_pkg" / "quux.py")
    one = finding(tmp_path, "entry-module-missing", "setup.py", 22)
    assert one.fix is None
    assert one.sentence.endswith(
        ": write my_pkg/talker.py, or name one that is there, my_pkg.quux."
    )


def test_packages_in_a_folder_of_their_own_are_found_there(tmp_path: Path):
    package = sound(tmp_path)
    (package / "src").mkdir()
    (package / "my_pkg").rename(package / "src" / "my_pkg")
    changed(package, "setup.py", "find_packages(exclude=['test'])",
            "find_packages('src'), package_dir={'': 'src'}")  # fmt: skip
    assert codes(tmp_path) == set()
