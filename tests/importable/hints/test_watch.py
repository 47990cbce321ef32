"""Programs of beginners, each in a process of its own, and what is said about them."""

from __future__ import annotations

from contextlib import contextmanager
from typing import TYPE_CHECKING

import pytest

from tests.support.command_line import started
from tests.support.wire import running_router

if TYPE_CHECKING:
    from collections.abc import Generator
    from pathlib import Path

    from tests.support.demos import RunningDemo

HINT = "studio: hint: "
HEAD = """\
import time
import rclpy
from rclpy.executors import ExternalShutdownException
from rclpy.node import Node
from rclpy.qos import QoSProfile, ReliabilityPolicy
from std_msgs.msg import String


def spin(make):
    rclpy.init()
    try:
        rclpy.spin(make())
    except (KeyboardInterrupt, ExternalShutdownException):
        pass


"""


@pytest.fixture(scope="module")
def endpoint() -> Generator[str]:
    with running_router() as found:
        yield found


@contextmanager
def running(
    endpoint: str, tmp_path: Path, code: str, *words: str, name: str = "program.py"
) -> Generator[RunningDemo]:
    file = tmp_path / name
    file.write_text(HEAD + code)
    with started(endpoint, "run", *words, str(file)) as process:
        yield process


def line_of(text: str, code: str) -> int:
    """The line of a text in a file."""
    return (HEAD + code).split(text)[0].count("\n") + 1


UNSPUN = """\
class Lonely(Node):
    def __init__(self):
        super().__init__('lonely')
        self.timer = self.create_timer(0.1, print)


rclpy.init()
node = Lonely()
rclpy.shutdown()
"""


def test_a_node_that_is_never_spun_is_named_with_the_line_that_made_it(
    endpoint: str, tmp_path: Path
):
    with running(endpoint, tmp_path, UNSPUN) as process:
        assert process.wait() == 0
    assert process.printed == (
        f"{HINT}The program ended, and its node /lonely, made at "
        f"program.py:{line_of('node = Lonely', UNSPUN)}, was never spun: its timer's callback was "
        "never called; write rclpy.spin(node) behind it.\n"
    )


GOING_ON = """\
rclpy.init()
node = Node('going_on')
node.create_subscription(String, 'chatter', print, 10)
end_s = time.monotonic() + 7
while rclpy.ok() and time.monotonic() < end_s:
    time.sleep(0.1)
rclpy.shutdown()
"""


def test_a_node_that_is_not_spun_is_told_once_while_the_program_goes_on(
    endpoint: str, tmp_path: Path
):
    with running(endpoint, tmp_path, GOING_ON) as process:
        assert process.wait() == 0
    assert process.printed == (
        f"{HINT}The node /going_on, made at program.py:{line_of('node = Node', GOING_ON)}, is "
        "there for 5 s and was not spun: its callback for /chatter is not called before; write "
        "rclpy.spin(node) in place of a loop of your own, or rclpy.spin_once(node) in it.\n"
    )


CONSTRUCTING = """\
class Looping(Node):
    def __init__(self):
        super().__init__('looping')
        while rclpy.ok():
            time.sleep(0.1)


spin(Looping)
"""


@pytest.mark.sweep
def test_a_constructor_that_does_not_end_is_named(endpoint: str, tmp_path: Path):
    with running(endpoint, tmp_path, CONSTRUCTING) as process:
        process.wait_for(f"{HINT}The constructor of Looping has run for 5 s and is at program.py:")
        process.wait_for("do in a timer what is repeated")


BLOCKING = """\
class Blocking(Node):
    def __init__(self):
        super().__init__('blocking')
        self.create_timer(0.1, self.work)

    def work(self):
        self.helper()

    def helper(self):
        time.sleep(20)


spin(Blocking)
"""


def test_a_callback_that_does_not_return_is_named_with_the_line_where_it_is(
    endpoint: str, tmp_path: Path
):
    with running(endpoint, tmp_path, BLOCKING) as process:
        process.wait_for(
            f"{HINT}The callback work (program.py:{line_of('def work', BLOCKING)}) has run for 2 s "
            f"and is at program.py:{line_of('time.sleep(20)', BLOCKING)}: "
        )


UNSERVED = """\
from example_interfaces.srv import AddTwoInts


class Asking(Node):
    def __init__(self):
        super().__init__('asking')
        client = self.create_client(AddTwoInts, 'add_two_int')
        while not client.wait_for_service(timeout_sec=1.0):
            pass
        print('never')


class Serving(Node):
    def __init__(self):
        super().__init__('serving')
        self.create_service(AddTwoInts, 'add_two_ints', lambda _, response: response)


"""


def test_a_service_that_nobody_serves_is_named_with_one_of_its_type(endpoint: str, tmp_path: Path):
    with (
        running(endpoint, tmp_path, f"{UNSERVED}spin(Serving)\n", name="serving.py"),
        running(endpoint, tmp_path, f"{UNSERVED}spin(Asking)\n") as process,
    ):
        at = line_of("while not client", UNSERVED)
        process.wait_for(
            f"{HINT}Nobody serves the service /add_two_int (example_interfaces/srv/AddTwoInts), "
            f"for which the program waits at program.py:{at}: start the node that serves it, or "
            "write /add_two_ints, which is served with that type."
        )


PUBLISHING = """\
class Publishing(Node):
    def __init__(self):
        super().__init__('publishing')
        qos = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        self.create_publisher(String, 'words', qos)


class Hearing(Node):
    def __init__(self):
        super().__init__('hearing')
        self.create_subscription(String, 'words', print, 10)


"""


def test_qos_that_dds_would_not_match_is_named_on_both_sides(endpoint: str, tmp_path: Path):
    with (
        running(endpoint, tmp_path, f"{PUBLISHING}spin(Publishing)\n", name="source.py") as source,
        running(endpoint, tmp_path, f"{PUBLISHING}spin(Hearing)\n") as process,
    ):
        said = (
            f"{HINT}ROS 2 on DDS would deliver nothing on /words from /publishing to /hearing "
            "({}:{}): the publisher is best effort, the subscription wants reliable"
        )
        at = line_of("self.create_subscription", PUBLISHING)
        process.wait_for(said.format("program.py", at))
        source.wait_for(said.format("source.py", line_of("self.create_publisher", PUBLISHING)))


def test_two_nodes_of_one_name_are_named(endpoint: str, tmp_path: Path):
    code = "spin(lambda: Node('twin'))\n"
    with (
        running(endpoint, tmp_path, code),
        running(endpoint, tmp_path, code, name="second.py") as process,
    ):
        process.wait_for(f"{HINT}2 nodes are called /twin: ")


FREELY_NAMED = """\
class Mine(Node):
    token = "a word"

    def __init__(self):
        super().__init__("mine")
        self.was_spun, self.graph, self.wire = False, None, None
        self.create_publisher(String, "/chat", 1)
        self.create_subscription(
            String, "/chat", print,
            QoSProfile(depth=1, reliability=ReliabilityPolicy.RELIABLE),
        )
        self.create_publisher(
            String, "/chat", QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
        )


spin(Mine)
"""


def test_attributes_of_a_node_may_have_the_names_of_the_studio(endpoint: str, tmp_path: Path):
    with running(endpoint, tmp_path, FREELY_NAMED) as process:
        process.wait_for(f"{HINT}ROS 2 on DDS would deliver nothing on /chat")
        assert "Error" not in process.printed


@pytest.mark.parametrize(
    ("line", "said"),
    [
        (
            "from std_msgs.srv import AddTwoInts",
            "std_msgs.srv has no AddTwoInts, the service AddTwoInts is in example_interfaces: "
            "write from example_interfaces.srv import AddTwoInts.",
        ),
        (
            "from std_msgs.srv import Trigger",
            "std_msgs.srv has no Trigger, the service Trigger is in std_srvs: write "
            "from std_srvs.srv import Trigger.",
        ),
        (
            "from std_msgs.msg import String, Twist",
            "std_msgs.msg has no Twist, the message Twist is in geometry_msgs: write "
            "from geometry_msgs.msg import Twist.",
        ),
        (
            "from geometry_msgs.msg import Pose2d",
            "geometry_msgs.msg has no Pose2d, the message Pose2D is in geometry_msgs: write "
            "from geometry_msgs.msg import Pose2D.",
        ),
        (
            "from rclpy.nodes import Node",
            "there is no module rclpy.nodes: write from rclpy.node import Node.",
        ),
        ("import rclpyy", "there is no module rclpyy: write import rclpy."),
        (
            "from tf_transformations import quaternion_from_euler",
            "tf_transformations is a package of ROS that is not in the studio: quaternions are "
            "four numbers, and transforms3d of PyPI turns them.",
        ),
    ],
)
def test_a_type_of_another_package_is_named_behind_the_traceback(
    endpoint: str, tmp_path: Path, line: str, said: str
):
    with running(endpoint, tmp_path, f"{line}\n") as process:
        assert process.wait() == 1
    assert "Traceback" in process.printed
    at = line_of(line, f"{line}\n")
    assert process.printed.splitlines()[-1] == f"{HINT}program.py:{at}: {said}"


def test_a_file_whose_main_nobody_calls_is_named(endpoint: str, tmp_path: Path):
    code = "def main():\n    spin(Node)\n"
    with running(endpoint, tmp_path, code) as process:
        assert process.wait() == 0
    at = line_of("def main", code)
    assert process.printed.splitlines()[-1] == (
        f"{HINT}program.py:{at}: main is defined and never called: add "
        'if __name__ == "__main__": main() at the end.'
    )


SILENT = """\
from std_srvs.srv import Empty


class Silent(Node):
    def __init__(self):
        super().__init__('silent')
        self.create_service(Empty, 'quiet', self.serve)
        self.client = self.create_client(Empty, 'quiet')
        self.create_timer(0.1, lambda: self.client.call_async(Empty.Request()))

    def serve(self, request, response):
        pass


spin(Silent)
"""


def test_a_callback_that_returns_no_response_is_named(endpoint: str, tmp_path: Path):
    with running(endpoint, tmp_path, SILENT) as process:
        assert process.wait() == 1
    at = line_of("def serve", SILENT)
    assert process.printed.splitlines()[-1] == (
        f"{HINT}The callback serve (program.py:{at}) of the service /quiet returned None, and its "
        "caller waits for an answer: end it with return response."
    )


RIGHT = """\
from rclpy.executors import MultiThreadedExecutor
from rclpy.callback_groups import ReentrantCallbackGroup


class Right(Node):
    def __init__(self):
        super().__init__('right')
        group = ReentrantCallbackGroup()
        self.publisher = self.create_publisher(String, 'right', 10)
        self.create_subscription(String, 'right', self.hear, 10, callback_group=group)
        self.create_timer(0.05, self.say, callback_group=group)
        self.create_timer(0.2, self.last, callback_group=group)
        self.begin = time.monotonic()

    def say(self):
        self.publisher.publish(String(data='x'))

    def hear(self, message):
        pass

    def last(self):
        time.sleep(3.0)
        print('done', flush=True)
        self.executor.shutdown(0.0)


rclpy.init()
executor = MultiThreadedExecutor(4)
executor.add_node(Right())
executor.spin()
"""


@pytest.mark.sweep
def test_nothing_is_said_of_a_program_that_is_right(endpoint: str, tmp_path: Path):
    """Its long callback has a thread and a group of its own."""
    with running(endpoint, tmp_path, RIGHT) as process:
        process.wait_for("done")
    assert "hint" not in process.printed


def test_nothing_is_said_where_no_hints_are_wanted(endpoint: str, tmp_path: Path):
    with running(endpoint, tmp_path, UNSPUN, "--no-hints") as process:
        assert process.wait() == 0
    assert process.printed == ""
