"""What a user's program can import; each runs in a process of its own, for the finder stays."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from studio.importable.names import MODULES
from tests.support.student_programs import environment_at, python_package, studio_run

if TYPE_CHECKING:
    import subprocess
    from pathlib import Path


def ran(
    tmp_path: Path, text: str, *words: str, endpoint: str = "tcp/127.0.0.1:1", **variables: str
) -> subprocess.CompletedProcess[str]:
    """Run a program by `studio run`, in its folder."""
    (tmp_path / "program.py").write_text(text)
    words = (*words, "program.py") if words[:1] == ("--strict",) else ("program.py", *words)
    return studio_run(endpoint, *words, cwd=tmp_path, environment=variables)


def test_every_name_of_the_table_is_there(tmp_path: Path):
    text = "import importlib\n"
    for module, names in MODULES.items():
        text += f"m = importlib.import_module({module!r})\n"
        text += f"for name in {list(names)!r}: getattr(m, name)\n"
        text += f"assert sorted(m.__all__) == dir(m) == {sorted(names)!r}\n"
    found = ran(tmp_path, text)
    assert (found.returncode, found.stderr) == (0, "")


def test_messages_can_be_imported_before_rclpy(tmp_path: Path):
    text = (
        "from std_msgs.msg import String\nimport std_msgs.msg, geometry_msgs\n"
        "from example_interfaces.srv import AddTwoInts\nimport rclpy\nfrom rclpy.node import *\n"
        "print(String(data='x'), AddTwoInts.Request().a, rclpy.node.Node is Node)\n"
    )
    found = ran(tmp_path, text)
    assert (found.stdout, found.stderr) == ("std_msgs.msg.String(data='x') 0 True\n", "")


@pytest.mark.parametrize(
    ("line", "raised", "said"),
    [
        ("from rclpy.node import Nonsense", "ImportError",
         "not in the studio's rclpy: rclpy.node.Nonsense; the README says what is"),
        ("import rclpy.experimental", "ModuleNotFoundError",
         "not in the studio's rclpy: rclpy.experimental"),
        ("import rclpy; rclpy.nonsense", "AttributeError",
         "not in the studio's rclpy: rclpy.nonsense"),
        ("import no_such_package", "ModuleNotFoundError", "No module named 'no_such_package'"),
        ("from std_msgs.msg import Absent", "ImportError",
         'The type "std_msgs/msg/Absent" cannot be used'),
    ],
)  # fmt: skip
def test_what_is_not_there_is_said(tmp_path: Path, line: str, raised: str, said: str):
    found = ran(tmp_path, line)
    assert found.returncode == 1
    assert f"{raised}: " in found.stderr
    assert said in found.stderr


def test_asking_for_a_name_is_no_error(tmp_path: Path):
    found = ran(tmp_path, "import rclpy\nprint(hasattr(rclpy, 'x'), hasattr(rclpy, 'init'))\n")
    assert found.stdout == "False True\n"


def test_a_real_rclpy_wins_and_that_is_said(tmp_path: Path):
    real = tmp_path / "real" / "rclpy"
    real.mkdir(parents=True)
    (real / "__init__.py").write_text("NAME = 'real'\n")
    path = environment_at("tcp/127.0.0.1:1")["PYTHONPATH"]
    found = ran(
        tmp_path, "import rclpy\nprint(rclpy.NAME)\n", PYTHONPATH=f"{path}:{tmp_path / 'real'}"
    )
    assert found.stdout == "real\n"
    assert found.stderr == f"studio: the rclpy of {real} is used, not the studio's.\n"


FIELDS = """\
from std_msgs.msg import Int32, String, UInt8MultiArray, Int32MultiArray
from geometry_msgs.msg import Twist, PoseWithCovariance
from diagnostic_msgs.msg import DiagnosticStatus
def tried(act):
    try:
        act()
    except Exception as error:
        print(type(error).__name__, error)
def set_field(message, name, value):
    tried(lambda: setattr(message, name, value))
set_field(String(), 'data', 5)
set_field(Int32(), 'data', 2.5)
set_field(Int32(), 'data', 2**40)
set_field(Twist(), 'linear', 3)
set_field(Twist().linear, 'x', 1)
set_field(UInt8MultiArray(), 'data', 'text')
set_field(DiagnosticStatus(), 'level', 'x')
tried(lambda: String(nope=1))
tried(lambda: String('positional'))
a = Int32MultiArray(data=[1, 2])
a.data.append(3)
print(type(a.data).__name__, list(a.data), a.data[-1])
p = PoseWithCovariance()
p.covariance[0] = 2.0
print(p.covariance.shape, p.covariance[0])
print(DiagnosticStatus(level=DiagnosticStatus.ERROR).level)
from rclpy.serialization import serialize_message, deserialize_message
for m in (a, p, DiagnosticStatus(level=DiagnosticStatus.WARN, name='n')):
    assert deserialize_message(serialize_message(m), type(m)) == m, m
print(Twist.get_fields_and_field_types(), a.get_fields_and_field_types()['data'])
"""


def test_fields_are_checked_and_kept_as_rosidl_does(tmp_path: Path):
    found = ran(tmp_path, FIELDS)
    assert found.stderr == ""
    assert found.stdout.splitlines() == [
        "AssertionError The 'data' field must be of type 'str'",
        "AssertionError The 'data' field must be of type 'int'",
        "AssertionError The 'data' field must be an integer in [-2147483648, 2147483647]",
        "AssertionError The 'linear' field must be a sub message of type 'Vector3'",
        "AssertionError The 'x' field must be of type 'float'",
        "AssertionError The 'data' field must be a set or sequence and each value of type 'int'",
        "AssertionError The 'level' field must be of type 'bytes' or 'ByteString'",
        "AssertionError Invalid arguments passed to constructor: nope",
        "TypeError __init__() takes 1 positional argument but 2 were given",
        "array [1, 2, 3] 3",
        "(36,) 2.0",
        "b'\\x02'",
        "{'linear': 'geometry_msgs/Vector3', 'angular': 'geometry_msgs/Vector3'} sequence<int32>",
    ]


def test_an_action_that_returns_no_result_fails_as_in_ros(tmp_path: Path, endpoint: str):
    text = """\
import rclpy
from rclpy.action import ActionClient, ActionServer
from rclpy.node import Node
from example_interfaces.action import Fibonacci
rclpy.init()
node = Node('fib')
server = ActionServer(node, Fibonacci, 'fib', lambda handle: handle.succeed())
client = ActionClient(node, Fibonacci, 'fib')
client.wait_for_server()
future = client.send_goal_async(Fibonacci.Goal())
rclpy.spin_until_future_complete(node, future)
rclpy.spin_until_future_complete(node, future.result().get_result_async())
"""
    found = ran(tmp_path, text, endpoint=endpoint)
    assert found.returncode == 1
    assert "AssertionError: The 'result' field must be a sub message" in found.stderr
    assert "the execute callback returned NoneType, end it with return result" in found.stderr


AMENT = """\
import os
from ament_index_python.packages import (get_package_prefix, get_package_share_directory,
    get_package_share_path, get_packages_with_prefixes, PackageNotFoundError)
share = get_package_share_directory('own_pkg')
print(open(os.path.join(share, 'robot.urdf')).read())
print(os.path.exists(os.path.join(share, 'launch', 'a.launch.py')))
print(os.path.samefile(os.path.join(get_package_prefix('own_pkg'), 'share', 'own_pkg'), share))
print(str(get_package_share_path('own_pkg')) == share, 'own_pkg' in get_packages_with_prefixes())
try:
    get_package_share_directory('nope')
except PackageNotFoundError as error:
    print(error)
"""


def test_share_folders_of_packages_are_those_of_their_sources(tmp_path: Path):
    folder = python_package(tmp_path / "src", "own_pkg", {})
    for name in ("urdf/robot.urdf", "launch/a.launch.py"):
        (folder / name).parent.mkdir()
        (folder / name).write_text(name)
    found = ran(tmp_path / "src", AMENT, AMENT_PREFIX_PATH="")
    assert found.stderr == ""
    assert found.stdout == (
        "urdf/robot.urdf\nTrue\nTrue\nTrue True\npackage 'nope' not found, searching: []\n"
    )


ROSIDL = """\
from rosidl_runtime_py import (message_to_csv, message_to_ordereddict, message_to_yaml,
    set_message_fields)
from rosidl_runtime_py.utilities import get_action, get_interface, get_message, get_service
Point = get_message('geometry_msgs/msg/Point')
point = Point(x=1.0)
set_message_fields(point, {'y': 2})
print(dict(message_to_ordereddict(point)), message_to_csv(point))
print(message_to_yaml(point), end='')
print(get_service('std_srvs/srv/Trigger').name, get_interface('std_msgs/msg/String').__name__)
for call in (lambda: get_message('std_srvs/srv/Trigger'), lambda: get_message('no_such/msg/X'),
             lambda: set_message_fields(point, {'q': 1}), lambda: set_message_fields(point, {'x': 'a'})):
    try:
        call()
    except Exception as error:
        print(type(error).__name__)
"""  # noqa: E501


def test_messages_are_converted_by_the_names_of_rosidl_runtime_py(tmp_path: Path):
    found = ran(tmp_path, ROSIDL)
    assert found.stderr == ""
    assert found.stdout.splitlines() == [
        "{'x': 1.0, 'y': 2.0, 'z': 0.0} 1.0,2.0,0.0",
        "x: 1.0",
        "y: 2.0",
        "z: 0.0",
        "std_srvs/srv/Trigger String",
        "ValueError",
        "ModuleNotFoundError",
        "AttributeError",
        "AssertionError",
    ]


def test_a_workspace_that_defines_a_type_of_the_studio_comes_first(tmp_path: Path):
    package = tmp_path / "src" / "learning_interface"
    (package / "srv").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>learning_interface</name></package>")
    (package / "srv" / "AddTwoInts.srv").write_text("int64 mine\n---\nint64 sum\n")
    text = "from learning_interface.srv import AddTwoInts\nprint(AddTwoInts.Request())\n"
    found = ran(tmp_path / "src", text)
    assert found.stdout == "learning_interface.srv.AddTwoInts_Request(mine=0)\n"


def test_a_broken_text_of_an_interface_is_told_with_its_file(tmp_path: Path):
    package = tmp_path / "src" / "my_own"
    (package / "msg").mkdir(parents=True)
    (package / "package.xml").write_text("<package><name>my_own</name></package>")
    (package / "msg" / "Broken.msg").write_text("float64\n")
    found = ran(tmp_path / "src", "from my_own.msg import Broken\n")
    assert found.returncode == 1
    assert str(package / "msg" / "Broken.msg") in found.stderr


WITH = "import rclpy\nwith rclpy.init():\n    pass\nwith rclpy.init():\n    pass\nprint('end')\n"


def test_what_is_kinder_than_ros_is_warned_of_with_its_line(tmp_path: Path, endpoint: str):
    found = ran(tmp_path, WITH, endpoint=endpoint)
    assert (found.returncode, found.stdout) == (0, "end\n")
    assert [line.partition(": with")[0] for line in found.stderr.splitlines()] == [
        "studio: would fail in ROS 2: program.py:2",
        "studio: would fail in ROS 2: program.py:4",
    ]


AWAITED = """\
import asyncio
from rclpy.task import Future
async def wait(future):
    asyncio.get_running_loop().call_later(0.01, future.set_result, 5)
    return await future
print(asyncio.run(wait(Future())), asyncio.run(wait(Future())))
"""


def test_a_future_that_asyncio_awaits_is_warned_of(tmp_path: Path):
    found = ran(tmp_path, AWAITED)
    assert (found.returncode, found.stdout) == (0, "5 5\n")
    assert found.stderr == (
        "studio: would fail in ROS 2: program.py:5: asyncio cannot await a future of rclpy: await "
        "it in a coroutine that an executor runs, such as a callback.\n"
    )
    assert ran(tmp_path, AWAITED, "--strict").returncode == 1


def test_strict_makes_an_error_of_it(tmp_path: Path, endpoint: str):
    found = ran(tmp_path, WITH, "--strict", endpoint=endpoint)
    assert (found.returncode, found.stdout) == (1, "")
    assert "would fail in ROS 2: program.py:2: with rclpy.init() needs" in found.stderr


@pytest.mark.parametrize(
    ("name", "raised"), [("SIGINT", "KeyboardInterrupt"), ("SIGTERM", "ExternalShutdownException")]
)
def test_signals_end_a_program_as_they_end_rclpys(
    tmp_path: Path, endpoint: str, name: str, raised: str
):
    text = f"""\
import os, rclpy, signal, threading
rclpy.init()
node = rclpy.create_node('node')
threading.Timer(0.3, os.kill, (os.getpid(), signal.{name})).start()
try:
    rclpy.spin(node)
except BaseException as error:
    print(type(error).__name__)
try:
    rclpy.shutdown()
except RuntimeError as error:
    print(type(error).__name__, str(error).partition(':')[0])
print(rclpy.try_shutdown())
"""
    found = ran(tmp_path, text, endpoint=endpoint)
    assert found.stdout == f"{raised}\nRCLError failed to shutdown\nNone\n"


INTROSPECTED = """\
import rclpy
from rclpy.qos import qos_profile_system_default as qos
from rclpy.service_introspection import ServiceIntrospectionState as State
from std_srvs.srv import Empty
rclpy.init()
node = rclpy.create_node('introspected')
service = node.create_service(Empty, 'quiet', lambda request, response: response)
client = node.create_client(Empty, 'quiet')
for end in (service, client):
    end.configure_introspection(node.get_clock(), qos, State.OFF)
    for state in (State.METADATA, State.CONTENTS):
        try:
            end.configure_introspection(node.get_clock(), qos, introspection_state=state)
        except NotImplementedError as error:
            print(error)
"""


def test_introspection_of_calls_may_be_off_only(tmp_path: Path, endpoint: str):
    found = ran(tmp_path, INTROSPECTED, endpoint=endpoint)
    assert found.returncode == 0
    lines = found.stdout.splitlines()
    assert len(lines) == 4
    assert all("/quiet: leave out configure_introspection" in line for line in lines)
