from __future__ import annotations

import subprocess
import sys
from typing import TYPE_CHECKING

import pytest

from studio.errors import EntryPointError
from studio.packages.inspection.inspecting import PackagesFound
from studio.packages.lint.package_checks import check_packages
from studio.packages.sources.package_source import PackageSource
from studio.programs.entry_points import EntryPoint, find_entry_point
from tests.support.student_programs import python_package

if TYPE_CHECKING:
    from pathlib import Path

MAIN = "def main():\n    pass\n"


def found_in(folder: Path, executable: str = "talk") -> EntryPoint | None:
    return find_entry_point(PackageSource(folder, name=folder.name), executable)


def refusal(folder: Path, file: str, line: int, executable: str = "talk") -> str:
    """Return the sentence that refuses an executable: that of a finding of `studio pkg check`."""
    with pytest.raises(EntryPointError) as caught:
        found_in(folder, executable)
    error = caught.value
    assert error.problem in check_packages(PackagesFound(folder))
    place = error.problem.place
    assert place is not None
    assert (place.file, place.line) == (str(folder / file), line)
    assert str(error).startswith(f"{folder / file}:{line}: ")
    return str(error)


@pytest.mark.parametrize(
    "text",
    [
        MAIN,
        "from other import main\n",
        "main = print\n",
        "try:\n    from a import main\nexcept ImportError:\n    main = None\n",
        "from a import *\n",
        "no python at all (\n",
        "def __getattr__(name): ...\n",
    ],
)
def test_a_name_that_the_module_binds_is_an_entry_point(tmp_path: Path, text: str):
    folder = python_package(tmp_path, "own_pkg", {"talk": text}, "talk = own_pkg.talk:main")
    found = found_in(folder)
    assert found is not None
    assert (found.module, found.function, found.root) == ("own_pkg.talk", "main", folder)


def test_a_file_that_is_not_in_the_package_is_told_with_those_that_are(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {"quux": MAIN}, "talk = own_pkg.talk:main")
    said = refusal(folder, "setup.py", 18)
    assert "write own_pkg/talk.py, or name one that is there, own_pkg.quux." in said


def test_a_function_that_is_not_in_the_file_is_told_with_those_that_are(tmp_path: Path):
    text = "class Talker:\n    def main(self): ...\ndef other(): ...\n"
    folder = python_package(tmp_path, "own_pkg", {"talk": text}, "talk = own_pkg.talk:main")
    said = refusal(folder, "setup.py", 18)
    assert "own_pkg/talk.py, which has no such function: write def main(args=None): at" in said
    assert said.endswith("or start one that it has, other.")


@pytest.mark.parametrize(
    ("line", "said"),
    [
        ("talk = own_pkg.talk", "name = module:function is meant, talk = own_pkg.talk:main, say."),
        ("talk = own_pkg.talk.py:main", "own_pkg.talk is meant, it seems. [Write own_pkg.talk: "),
        ("talk = own_pkg.talk:main other = own_pkg.talk:main", "[Make two entries of it: "),
        ("other = own_pkg.talk:main talk = own_pkg.talk:main", "[Make two entries of it: "),
        ("own_pkg.talk:main", "starts nothing: name = module:function is meant"),
    ],
)
def test_a_line_that_names_no_function_is_told_with_its_mend(tmp_path: Path, line: str, said: str):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, line)
    assert said in refusal(folder, "setup.py", 18)


def test_entry_points_that_are_not_closed_are_told_with_their_line(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    setup = folder / "setup.py"
    setup.write_text(setup.read_text().replace("        ],\n    },\n)", ""))
    said = refusal(folder, "setup.py", 17)
    assert "was never closed" in said
    assert "Close every bracket" in said


def test_a_module_that_packages_does_not_list_is_told(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {}, "talk = scripts.talk:main")
    (folder / "scripts").mkdir()
    (folder / "scripts" / "talk.py").write_text(MAIN)
    said = refusal(folder, "setup.py", 9)
    assert said.endswith("[List scripts: studio pkg check --fix does it]")


def test_find_packages_passes_over_a_folder_without_init(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    setup = folder / "setup.py"
    setup.write_text(setup.read_text().replace("[package_name],", "find_packages(),", 1))
    assert found_in(folder) is not None
    (folder / "own_pkg" / "__init__.py").unlink()
    assert "[Make own_pkg/__init__.py: " in refusal(folder, "setup.py", 18)


@pytest.mark.parametrize(
    ("text", "file", "line", "said"),
    [
        (None, "setup.py", 1, "There is no setup.cfg"),
        (
            *("[develop]\nscript_dir=$base/lib/own_pkg\n", "setup.cfg", 1),
            "[install] sets no install_scripts",
        ),
        (
            *("[develop]\nscript_dir=$base/lib/other\n", "setup.cfg", 2),
            "[develop] script_dir is $base/lib/other",
        ),
        ("develop\nscript_dir\n", "setup.cfg", 1, "[develop] sets no script_dir"),
    ],
)
def test_a_setup_cfg_that_hides_executables_is_told(
    tmp_path: Path, text: str | None, file: str, line: int, said: str
):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    (folder / "setup.cfg").unlink()
    if text is not None:
        (folder / "setup.cfg").write_text(text)
    sentence = refusal(folder, file, line)
    assert said in sentence
    assert "ros2 run looks in" in sentence or "where ros2 run looks" in sentence


def test_both_spellings_of_setup_cfg_are_right(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    config = folder / "setup.cfg"
    config.write_text(config.read_text().replace("script_dir", "script-dir"))
    assert found_in(folder) is not None


def test_faults_of_other_executables_and_of_the_package_stop_nothing(tmp_path: Path):
    lines = ("talk = own_pkg.talk:main", "gone = own_pkg.gone:main", "talk = own_pkg.gone:main")
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, *lines)
    (folder / "resource" / "own_pkg").unlink()
    (folder / "package.xml").write_text("<package><name>own_pkg</name>")
    assert found_in(folder) is not None
    assert found_in(folder, "another") is None
    assert "own_pkg.gone" in refusal(folder, "setup.py", 19, "gone")


def test_nothing_is_found_where_there_are_no_setup_files(tmp_path: Path):
    assert found_in(tmp_path) is None


def test_checks_are_not_imported_for_an_entry_that_starts(tmp_path: Path):
    folder = python_package(tmp_path, "own_pkg", {"talk": MAIN}, "talk = own_pkg.talk:main")
    text = (
        "import sys\nfrom pathlib import Path\n"
        "from studio.packages.sources.package_source import PackageSource\n"
        "from studio.programs.entry_points import find_entry_point\n"
        "assert find_entry_point(PackageSource(Path(sys.argv[1]), name='own_pkg'), 'talk')\n"
        "print([name for name in sys.modules if '.lint' in name or '.edits' in name])"
    )
    ran = subprocess.run(
        [sys.executable, "-c", text, str(folder)], capture_output=True, text=True, check=True
    )
    assert ran.stdout == "[]\n"
