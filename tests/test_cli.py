from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

import studio
from studio.cli.commands import summaries
from studio.server.ports import bind, port_of
from studio.settings import repository_or_wheel

MODELS = repository_or_wheel("models")
ROBOT = MODELS / "xacro_robot_description" / "urdf" / "xacro_robot.urdf.xacro"
HEAVY = {"viser", "fastapi", "uvicorn", "starlette", "trimesh", "yourdfpy", "numpy", "pydantic"}


def run(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[bytes]:
    """The command as a person runs it."""
    return subprocess.run(
        [sys.executable, "-m", "studio", *arguments], capture_output=True, cwd=cwd, check=False
    )


def modules_after(*arguments: str) -> set[str]:
    """The packages that a command has imported when it is done."""
    script = f"""
import json, sys
from studio.cli import main
try:
    main({list(arguments)!r})
except SystemExit:
    pass
sys.stdout.flush()
print("\\n" + json.dumps(sorted({{name.split(".")[0] for name in sys.modules}})))
"""
    done = subprocess.run([sys.executable, "-c", script], capture_output=True, check=True)
    return set(json.loads(done.stdout.splitlines()[-1]))


def test_help_and_version_import_nothing_heavy():
    for option in ("--help", "--version"):
        assert not modules_after(option) & (HEAVY | {"xacro", "msgspec"})


def test_xacro_imports_neither_the_view_nor_the_server(tmp_path: Path):
    found = modules_after("xacro", str(ROBOT), "--data-dir", str(tmp_path))
    assert "xacro" in found
    assert not found & HEAVY


def test_the_version_and_the_examples_are_said():
    assert run("--version").stdout == f"studio {studio.__version__}\n".encode()
    text = run("--help").stdout.decode()
    for word in ("demo", "open", "xacro", "examples:", "ur_type:=ur10e", ".zip"):
        assert word in text
    for option in ("--host", "--port", "--no-browser", "--package-path", "--data-dir", "--trust"):
        assert option in run("open", "--help").stdout.decode()


@pytest.mark.parametrize("arguments", [(), ("no-such",), ("check",), ("demo", "--port", "70000")])
def test_a_wrong_command_line_ends_with_2(arguments: tuple[str, ...]):
    done = run(*arguments)
    assert done.returncode == 2
    assert b"Traceback" not in done.stderr


def xacro_command(file: str, *arguments: str, cwd: Path) -> bytes:
    """What the `xacro` command prints."""
    command = Path(sys.executable).with_name("xacro")
    return subprocess.run(
        [command, file, *arguments], capture_output=True, check=True, cwd=cwd
    ).stdout


def test_xacro_prints_what_the_xacro_command_prints(tmp_path: Path):
    robot = tmp_path / "my -- robot.urdf.xacro"
    robot.write_text(
        '<?xml version="1.0"?>\n<!-- ü -->\n'
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="r">\n'
        '<xacro:arg name="name" default="x"/><link name="$(arg name) ${1/3} &lt; ä"/>\n\n</robot>',
        encoding="utf-8",
    )
    for arguments in ((), ("name:=y",), ("name:=a b", "other:=1"), ("name:= y ", "_hidden:=1")):
        expected = xacro_command(robot.name, *arguments, cwd=tmp_path)
        data = ("--data-dir", str(tmp_path / "data"))
        done = run("xacro", robot.name, *arguments, *data, cwd=tmp_path)
        assert done.stdout == expected, done.stderr


def test_xacro_writes_to_a_file(tmp_path: Path):
    output = tmp_path / "made" / "robot.urdf"
    done = run("xacro", str(ROBOT), "-o", str(output), "--data-dir", str(tmp_path))
    assert (done.returncode, done.stdout) == (0, b"")
    assert output.read_bytes() == xacro_command(str(ROBOT), cwd=tmp_path)


def test_xacro_hides_the_environment_unless_it_is_trusted(tmp_path: Path):
    robot = tmp_path / "leak.xacro"
    robot.write_text(
        '<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="$(optenv HOME hidden)"/>'
    )
    arguments = ("xacro", str(robot), "--data-dir", str(tmp_path / "data"))
    assert b'name="hidden"' in run(*arguments).stdout
    assert f'name="{os.environ["HOME"]}"'.encode() in run(*arguments, "--trust").stdout


def test_trust_opens_the_environment_and_nothing_else(tmp_path: Path):
    (tmp_path / "secret.yaml").write_text("k: found\n")
    folder = tmp_path / "own"
    folder.mkdir()
    robot = folder / "r.xacro"
    arguments = ("xacro", str(robot), "--trust", "--data-dir", str(tmp_path / "data"))
    for text in ("().__class__", "9**9**9", "xacro.load_yaml('../secret.yaml')"):
        robot.write_text(f'<robot xmlns:xacro="http://www.ros.org/wiki/xacro" name="${{{text}}}"/>')
        done = run(*arguments)
        assert (done.returncode, done.stdout) == (2, b"")
        assert b"Traceback" not in done.stderr


def one_sentence(done: subprocess.CompletedProcess[bytes]) -> str:
    """The sentence on stderr of a command that ended with 2."""
    assert done.returncode == 2
    assert done.stdout == b""
    (line,) = done.stderr.decode().splitlines()
    assert line.startswith("studio: ")
    return line


def test_every_mistake_is_one_sentence(tmp_path: Path):
    data = ("--data-dir", str(tmp_path / "data"))
    broken = tmp_path / "broken.xacro"
    broken.write_text("<robot")
    (tmp_path / "file").write_text("")
    assert "does not exist" in one_sentence(run("xacro", "no.xacro", *data))
    assert "broken.xacro" in one_sentence(run("xacro", str(broken), *data))
    assert "no such file" in one_sentence(run("open", str(tmp_path / "no"), *data))
    assert "name:=value" in one_sentence(run("open", str(ROBOT), "a:=b:=c", *data))
    unusable = str(tmp_path / "file" / "data")
    assert "choose --data-dir" in one_sentence(run("demo", "--data-dir", unusable))
    for words in (("--no-token",), ("--host", "0.0.0.0"), ("--share", "--host", "127.0.0.1")):
        refused = one_sentence(run("demo", "--trust", *words, *data))
        assert "--trust is for you alone" in refused


def test_a_taken_port_is_one_sentence(tmp_path: Path):
    with bind("127.0.0.1", 0) as held:
        port = port_of(held)
        done = run("demo", "--port", str(port), "--data-dir", str(tmp_path))
    assert f"Port {port} on 127.0.0.1 is taken" in one_sentence(done)


def test_arguments_may_stand_anywhere(tmp_path: Path):
    words = ["xacro", "name:=a", str(ROBOT), "b:=c", "--data-dir", str(tmp_path / "data"), "d:=e"]
    assert run(*words).returncode == 0


def test_a_reader_that_has_gone_is_no_error(tmp_path: Path):
    command = [sys.executable, "-m", "studio", "xacro", str(ROBOT), "--data-dir", str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        assert process.stdout is not None
        assert process.stderr is not None
        process.stdout.close()
        assert process.stderr.read() == b""
    assert process.returncode == 0


def test_check_says_what_is_wrong_and_its_exit_code_how_bad_it_is(tmp_path: Path):
    good, bad = tmp_path / "robots" / "good.urdf", tmp_path / "robots" / "bad.urdf"
    good.parent.mkdir()
    good.write_text('<robot name="r"><link name="a"/></robot>')
    bad.write_text('<robot name="r"><link name="a"/>')
    at = ("--data-dir", str(tmp_path / "data"))
    assert run("check", str(good), *at).returncode == 0
    done = run("check", "bad.urdf", *at, cwd=bad.parent)
    assert done.returncode == 1
    assert done.stdout.decode().startswith("bad.urdf:1:32: error: The file ends while <robot>")
    listed = run("check", str(bad.parent), "--json", *at)
    assert listed.returncode == 1
    assert "xml-open-element" in {row["code"] for row in json.loads(listed.stdout)}
    assert run("check", str(tmp_path / "gone.urdf"), *at).returncode == 2


@pytest.mark.parametrize("command", summaries())
def test_help_of_a_command_imports_nothing_heavy(command: str):
    found = modules_after(command, "--help")
    assert not found & (HEAVY | {"xacro", "zenoh", "rosbags", "scipy"})


def test_a_line_of_ros_imports_neither_the_view_nor_the_server():
    found = modules_after("topic", "list", "--connect", "tcp/127.0.0.1:1")
    assert "zenoh" in found
    assert not found & (HEAVY - {"numpy"})
