"""The wheel: what it holds, and that it runs where nothing else is."""

from __future__ import annotations

import ast
import os
import re
import signal
import subprocess
import sys
import sysconfig
import tomllib
import urllib.request
import venv
from importlib.metadata import packages_distributions
from pathlib import Path
from typing import TYPE_CHECKING
from zipfile import ZipFile

import pytest

from tests.support.patience import ended_within

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.server.modules import Modules

REPOSITORY = Path(__file__).resolve().parents[1]
INSIDE = {
    "studio": "studio",
    "studio/_frontend_assets": "frontend_assets",
    "studio/_models": "models",
}
NEVER = {"screenshots", "tests", "node_modules", "__pycache__", ".ci"}
_FOR_WORK_ON_IT = re.compile(
    r"^(studio/_)?frontend_assets/(?:tools/|types/|.*\.d\.ts$|vendor/vendor\.lock\.json$)"
)
END_WITHIN_S = 2.0
_OF_HELP = re.compile(r"/(help/pictures/|panels/\w+/help-)")

pytestmark = pytest.mark.timeout(300)


def is_never(name: str) -> bool:
    """Whether a file of this path in a wheel or in the checkout belongs to no wheel."""
    return bool(NEVER & set(Path(name).parts)) or bool(_FOR_WORK_ON_IT.match(name))


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The wheel, built without the network by the hatchling of this environment."""
    folder = tmp_path_factory.mktemp("dist")
    command = [sys.executable, "-m", "build", "--wheel", "--no-isolation", "--outdir", folder]
    built = subprocess.run(
        [*command, REPOSITORY], capture_output=True, text=True, check=False, cwd=folder
    )
    assert built.returncode == 0, built.stdout + built.stderr
    (path,) = folder.glob("*.whl")
    return path


@pytest.fixture(scope="module")
def names(wheel: Path) -> list[str]:
    with ZipFile(wheel) as archive:
        return archive.namelist()


def source_of(name: str) -> Path | None:
    """The repository's file that a file of the wheel comes from; None for metadata."""
    for inside in sorted(INSIDE, key=len, reverse=True):
        if name.startswith(f"{inside}/"):
            return REPOSITORY / INSIDE[inside] / name.removeprefix(f"{inside}/")
    return None


def test_the_wheel_holds_the_program_the_page_and_the_models(names: list[str]):
    assert {
        "studio/__init__.py",
        "studio/cli/main.py",
        "studio/_frontend_assets/index.html",
        "studio/_models/rover_description/package.xml",
        "studio/_models/rover_description/urdf/rover.urdf.xacro",
        "studio/_models/rover_description/meshes/tyre.stl",
    } <= set(names)


def test_the_wheel_holds_every_committed_file_of_them(names: list[str]):
    listed = subprocess.run(
        ["git", "-C", REPOSITORY, "ls-files", "-z", *INSIDE.values()],
        capture_output=True,
        check=False,
    )
    if listed.returncode:
        pytest.skip("this is no git checkout, so no file is committed")
    committed = {name for name in listed.stdout.decode().split("\0") if name}
    wanted = {name for name in committed if not is_never(name)}
    held = {path.relative_to(REPOSITORY).as_posix() for name in names if (path := source_of(name))}
    assert {name for name in wanted if (REPOSITORY / name).is_file()} <= held


def test_the_wheel_holds_nothing_else(names: list[str]):
    assert len(names) == len(set(names))
    for name in names:
        assert not is_never(name), name
        source = source_of(name)
        if source is None:
            assert ".dist-info/" in name, name
        else:
            assert source.is_file(), f"{name} comes from nowhere"


def test_the_wheel_serves_the_page_of_this_checkout(wheel: Path, names: list[str]):
    """Its modules are without comments already, so what is made of them is the same."""
    from studio.server import modules

    inside = "studio/_frontend_assets/"
    own = [name for name in names if re.match(f"{inside}(?!vendor/).*\\.js$", name)]
    with ZipFile(wheel) as archive:
        held = {name.removeprefix(inside): archive.read(name) for name in own}
    written = {name: (REPOSITORY / "frontend_assets" / name).read_bytes() for name in held}
    assert sum(map(len, held.values())) < 0.8 * sum(map(len, written.values()))
    in_wheel, here = modules.Modules(held), modules.Modules(written)
    for name in held:
        assert _served(in_wheel, name) == _served(here, name), name


def _served(modules: Modules, name: str) -> list[str] | None:
    """The lines of what is sent under this name, without the blanks that a comment leaves."""
    text = modules.text(name)
    return None if text is None else [line.strip() for line in text.splitlines() if line.strip()]


@pytest.mark.sweep
def test_the_source_archive_makes_the_same_wheel(names: list[str], tmp_path: Path):
    command = [sys.executable, "-m", "build", "--no-isolation", "--outdir", tmp_path, REPOSITORY]
    built = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
    assert built.returncode == 0, built.stdout + built.stderr
    (again,) = tmp_path.glob("*.whl")
    with ZipFile(again) as archive:
        assert set(archive.namelist()) == set(names)


def test_the_wheel_is_small(wheel: Path):
    """The studio itself in as much as a picture of a phone; beside it those of every panel."""
    with ZipFile(wheel) as archive:
        pictures = [one for one in archive.infolist() if _OF_HELP.search(one.filename)]
    pictures_bytes = sum(one.compress_size for one in pictures)
    assert wheel.stat().st_size - pictures_bytes < 4_000_000
    assert pictures_bytes < 1_000_000
    assert max(one.compress_size for one in pictures) < 30_000


def test_the_wheel_says_what_it_is(wheel: Path, names: list[str]):
    (metadata,) = [name for name in names if name.endswith(".dist-info/METADATA")]
    (entry_points,) = [name for name in names if name.endswith(".dist-info/entry_points.txt")]
    assert [name for name in names if name.endswith("/licenses/LICENSE")]
    with ZipFile(wheel) as archive:
        text = archive.read(metadata).decode()
        assert "\nName: robot-description-studio\n" in text
        assert "\nLicense-Expression: Apache-2.0\n" in text
        assert "\nRequires-Python: >=3.11\n" in text
        assert "studio = studio.cli:main" in archive.read(entry_points).decode()


# Imported by a library of ours when they are there: what for.
CALLED_BY_OTHERS = {
    "uvloop": "uvicorn runs its loop on it",
}


def requirements() -> set[str]:
    """The distributions that the project asks for, by normal name."""
    text = (REPOSITORY / "pyproject.toml").read_text()
    lines = tomllib.loads(text)["project"]["dependencies"]
    return {re.split(r"[\[<>=;~! ]", line)[0].lower() for line in lines}


def imported() -> set[str]:
    """The distributions that modules of `studio` import, at the top or inside a function."""
    modules = {
        name
        for path in (REPOSITORY / "studio").rglob("*.py")
        for node in ast.walk(ast.parse(path.read_text()))
        for name in imports_of(node)
    }
    distributions = packages_distributions()
    foreign = modules - set(sys.stdlib_module_names) - {"studio"}
    return {distributions[name][0].lower().replace("_", "-") for name in foreign}


def imports_of(node: ast.AST) -> list[str]:
    match node:
        case ast.Import(names=names):
            return [alias.name.partition(".")[0] for alias in names]
        case ast.ImportFrom(module=str(module), level=0):
            return [module.partition(".")[0]]
        case _:
            return []


def test_what_is_imported_is_required_and_what_is_required_is_imported():
    assert imported() <= requirements()
    assert requirements() - imported() == set(CALLED_BY_OTHERS)


@pytest.fixture(
    scope="module",
    params=["with the libraries of ours", pytest.param("alone", marks=pytest.mark.sweep)],
)
def installed(
    wheel: Path, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Path:
    """The folder of commands of an environment into which only the wheel was installed.

    Alone, pip installs its requirements, too; else they are those of this environment, which is
    not asked for a studio.
    """
    folder = tmp_path_factory.mktemp("installed") / "venv"
    venv.create(folder)
    commands = folder / ("Scripts" if sys.platform == "win32" else "bin")
    pip = [sys.executable, "-m", "pip", "--python", commands / "python"]
    # What is imported is compiled then; all of it would take a quarter of a minute.
    install = ["--disable-pip-version-check", "install", "--quiet", "--no-compile"]
    if request.param != "alone":
        install.append("--no-deps")
        (own,) = folder.rglob("site-packages")
        (own / "ours.pth").write_text(f"{sysconfig.get_path('purelib')}\n")
    done = subprocess.run(
        [*pip, *install, "--constraint", REPOSITORY / "constraints.txt", wheel],
        capture_output=True,
        text=True,
        check=False,
        env=bare_environment(folder),
    )
    assert done.returncode == 0, done.stderr
    return commands


def bare_environment(home: Path) -> dict[str, str]:
    """Nothing of this checkout or of the user's settings, but what pip needs to find its index."""
    dropped = ("PYTHONPATH", "VIRTUAL_ENV", "STUDIO_CORPUS", "DISPLAY", "AMENT_PREFIX_PATH")
    kept = {name: value for name, value in os.environ.items() if name not in dropped}
    return {**kept, "STUDIO_DATA_DIR": str(home / "data")}


def test_the_installed_command_names_its_version(installed: Path, tmp_path: Path):
    import studio

    answer = subprocess.run(
        [installed / "studio", "--version"],
        capture_output=True,
        text=True,
        check=True,
        cwd=tmp_path,
        env=bare_environment(tmp_path),
    )
    assert answer.stdout == f"studio {studio.__version__}\n"


@pytest.fixture
def demo(installed: Path, tmp_path: Path) -> Iterator[subprocess.Popen[str]]:
    """A running `studio demo` of the installed wheel."""
    command = [installed / "studio", "demo", "--no-browser", "--no-graph", "--port", "0"]
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        env=bare_environment(tmp_path),
        stdout=subprocess.PIPE,
        text=True,
    ) as process:
        yield process
        if process.poll() is None:
            process.kill()


def test_the_installed_demo_serves_its_page_and_ends_when_told(demo: subprocess.Popen[str]):
    assert demo.stdout is not None
    line = demo.stdout.readline()
    assert line.startswith("Studio: http://127.0.0.1:")
    cookies = urllib.request.HTTPCookieProcessor()
    opener = urllib.request.build_opener(cookies)
    with opener.open(line.removeprefix("Studio: ").strip(), timeout=60) as page:
        assert page.status == 200
        assert "<!doctype html>" in page.read(200).decode().lower()
    demo.send_signal(signal.SIGTERM)
    ended_within(demo, END_WITHIN_S)
    assert demo.stdout.read() == ""
