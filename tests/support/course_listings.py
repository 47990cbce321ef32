"""The course's listings, cut out of its texts and corrected as far as they need it to run.

STUDIO_COURSE names the folder of the texts, one file for each of the five seeds. What is here are
facts about them: which lines belong together, how deep a line that lost its indentation stands, and
which words are wrong. Where a text is too damaged to be cut, and wherever the texts are not there,
the studio's own demo of the same node is taken, written for rclpy.
"""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Final

from studio.course.demos import find_demo

_VARIABLE: Final = "STUDIO_COURSE"
_INDENT: Final = "    "

_SPINNING: Final = """

def main(args=None):
    rclpy.init(args=args)
    node = {}()
    rclpy.spin(node)
    rclpy.shutdown()


if __name__ == "__main__":
    main()
"""
_CALLED: Final = """

if __name__ == "__main__":
    main()
"""
_RCLPY: Final = "import rclpy\nfrom rclpy.node import Node\n"


@dataclass(frozen=True)
class Cut:
    """Where a listing stands, and what of it is mended.

    Attributes:
        seed: Its text.
        parts: First and last line, and how much deeper the part belongs.
        demo: The studio's node that does the same.
        levels: Of a listing that lost its indentation: how deep each line stands, a digit a line.
        edits: What is wrong, each time it is there, and the correction.
        before: Lines that are missing before it.
        after: Lines that are missing behind it.
    """

    seed: str
    parts: tuple[tuple[int, int, int], ...]
    demo: str
    levels: str = ""
    edits: tuple[tuple[str, str], ...] = ()
    before: str = ""
    after: str = ""


_RADIO_TYPE: Final = "radio_station_interfaces.srv import GetNowPlaying"
_MAIN_OF_4: Final = "011121212201"

CUTS: Final[dict[str, Cut]] = {
    # S0: the radio station
    "get_now_playing_server": Cut(
        "000",
        ((369, 376, 0), (387, 392, 1), (398, 405, 0)),
        "now_playing_server",
        before=_RCLPY,
        edits=(
            ("GetNowPlaying.srv import GetNowPlaying", _RADIO_TYPE),
            ("class GetNowPlaying(", "class SongServiceNode("),
            ("<Service Data Type>.", "GetNowPlaying,"),
            ("'<Service Name>'.", "'get_now_playing',"),
            ("self.<callback_function>", "self.handle_request)"),
        ),
    ),
    "get_now_playing_client": Cut(
        "000",
        ((435, 443, 1), (457, 457, 1), (461, 462, 2), (468, 480, 1), (488, 494, 0)),
        "now_playing_client",
        before=f"{_RCLPY}from {_RADIO_TYPE}\n\n\nclass NowPlayingClient(Node):\n",
        edits=(
            ("self.client\n         = self", "self.client = self"),
            ("<service_data_type>", "GetNowPlaying"),
            ("<service_name>", "get_now_playing"),
            ("reguest", "request"),
            ("Reguest", "Request"),
            ('artist_name}\\n"', 'artist_name}\\n")'),
        ),
    ),
    "action_server_node": Cut(
        "000",
        ((607, 611, 0), (632, 632, 0), (616, 623, 1), (636, 646, 1)),
        "radio_dj",
        edits=(
            ("ActionServerNode(Node)", "ActionServerNode(Node):"),
            ("<Action_Interface_Type>", "ChooseSong"),
            ("<Name_of_Action>", "choose_song"),
            ("<call_back_function_when_action_is_called>", "self.execute_cb"),
            ("await asyncio.sleep(1)", "time.sleep(STEP_S)"),
            ("goal_handle.succeed()", "goal_handle.succeed()\n        return res"),
            ("import time\n", "import time\n\nSTEP_S = 0.05  # printed: a second\n"),
        ),
        after=_SPINNING.format("ActionServerNode"),
    ),
    "action_client_node": Cut(
        "000",
        ((672, 675, 0), (681, 693, 1), (698, 708, 1), (716, 722, 0)),
        "song_requester",
        edits=(
            ("import ChooseSong\n", "import ChooseSong\n\n\nclass SongRequester(Node):\n"),
            (
                "        goal_handle = future.result()\n",
                "        goal_handle = future.result()\n"
                "        if not goal_handle.accepted:\n"
                "            return rclpy.shutdown()\n",
            ),
            (
                '       self.get_logger().info(f"DJ final',
                '        self.get_logger().info(f"DJ final',
            ),
        ),
    ),
    # S2: the first node, a timer, a number that is published and counted
    "my_first_node": Cut("002", ((111, 126, 0),), "my_first_node"),
    "my_tiny_node": Cut(
        "002", ((158, 171, 0),), "my_tiny_node", after=_SPINNING.format("MyFirstNode")
    ),
    "my_tiny_pub": Cut("002", ((188, 215, 0),), "number_publisher"),
    "my_tiny_sub": Cut(
        "002", ((227, 239, 0),), "number_counter", after=_SPINNING.format("FirstSub")
    ),
    # S3: hello, chatter, the adder and R2D2
    "node_helloworld": Cut("003", ((127, 149, 0),), "hello_world", after=_CALLED),
    "publisher_node": Cut("003", ((164, 192, 0),), "talker", after=_CALLED),
    "subscriber_node": Cut("003", ((198, 223, 0),), "listener", after=_CALLED),
    "client": Cut("003", ((242, 285, 0),), "adder_client", after=_CALLED),
    "server": Cut("003", ((291, 313, 0),), "adder_server", after=_CALLED),
    "state_publisher": Cut("003", ((341, 428, 0),), "state_publisher"),
    # S4: nothing of it is indented
    "my_node": Cut(
        "004", ((31, 38, 0),), "my_first_node", "00012222", after=_SPINNING.format("MyNode")
    ),
    "topic_publisher": Cut(
        "004",
        ((80, 97, 0),),
        "publisher_node",
        "000012222222122222",
        after=_SPINNING.format("TopicPublisherNode"),
    ),
    "topic_subscriber": Cut(
        "004",
        ((80, 82, 0), (98, 111, 0)),
        "subscriber_node",
        "00001222333322212",
        after=_SPINNING.format("TopicSubscriberNode"),
    ),
    "qos_topic_node": Cut(
        "004",
        ((80, 82, 0), (113, 123, 0)),
        "qos_topic_node",
        "00000122233322",
        after=_SPINNING.format("QoSTopicNode"),
    ),
    "service_server": Cut(
        "004",
        ((155, 172, 0),),
        "service_server_node",
        "000012223332212222",
        after=_SPINNING.format("ServiceServerNode"),
    ),
    "service_client": Cut(
        "004",
        ((155, 157, 0), (173, 204, 0)),
        "service_client_node",
        "000" + "0122222321222222" + "00" + "11111111" + "221211",
        after=_CALLED,
    ),
    "basic_node": Cut("004", ((364, 381, 0),), "basic_node", "000122" + _MAIN_OF_4),
    "publisher_of_4": Cut(
        "004", ((384, 413, 0),), "publisher_node", "000001222222122222" + _MAIN_OF_4
    ),
    "subscriber_of_4": Cut(
        "004", ((416, 442, 0),), "subscriber_node", "000012233332212" + _MAIN_OF_4
    ),
    "service_server_node": Cut(
        "004", ((445, 468, 0),), "service_server_node", "000012221222" + _MAIN_OF_4
    ),
    "service_client_node": Cut(
        "004", ((471, 504, 0),), "service_client_node", "000001222322122222" + "0111222221212201"
    ),
    "parameter_node": Cut(
        "004",
        ((533, 566, 0),),
        "parameter_node",
        "0001222222222222221232" + _MAIN_OF_4,
        edits=(("        self.declare_parameter('use_sim_time', False)\n", ""),),
    ),
    "timer_node": Cut("004", ((569, 600, 0),), "timer_node", "00001222222222122222" + _MAIN_OF_4),
}


def course_folder() -> Path | None:
    """The folder of the texts; None: STUDIO_COURSE names none."""
    named = os.environ.get(_VARIABLE)
    if not named:
        return None
    folder = Path(named)
    assert folder.is_dir(), f"{_VARIABLE} is {named}, which is no folder"
    return folder.resolve()


@cache
def seed_lines(seed: str) -> tuple[str, ...]:
    """The lines of a seed's text; the tests that need them are skipped without."""
    folder = course_folder()
    assert folder is not None, f"{_VARIABLE} names no folder of course texts"
    return tuple(next(folder.glob(f"{seed}_*.txt")).read_text(encoding="utf-8").splitlines())


def cut(name: str, *, corrected: bool = True) -> str:
    """A listing of the texts as a file; not corrected, only its indentation is."""
    found = CUTS[name]
    lines = seed_lines(found.seed)
    parts = [_INDENT * deeper + line for first, last, deeper in found.parts
             for line in lines[first - 1 : last]]  # fmt: skip
    if found.levels:
        assert len(found.levels) == len(parts), (name, len(found.levels), len(parts))
        parts = [
            _INDENT * int(level) + line.strip()
            for level, line in zip(found.levels, parts, strict=True)
        ]
    text = "\n".join(line.rstrip() for line in parts) + "\n"
    if not corrected:
        return text
    for wrong, right in found.edits:
        assert wrong in text, f"{name}: the text has no {wrong!r} any more"
        text = text.replace(wrong, right)
    return found.before + text + found.after


def demo_launch() -> str:
    """The launch file of S3, with the name of its executable corrected."""
    text = "\n".join(seed_lines("003")[433:469]) + "\n"
    wrong = "robot_state+_publisher"
    assert wrong in text
    return text.replace(wrong, "robot_state_publisher")


def listing(name: str) -> str:
    """A listing as a file: of the texts where they are, else the studio's node of the same kind."""
    if course_folder() is not None and name in CUTS:
        return cut(name)
    return for_rclpy(CUTS[name].demo if name in CUTS else name)


_MODULES: Final = {
    "Node": "rclpy.node",
    "Future": "rclpy.task",
    "QoSProfile": "rclpy.qos",
    "DurabilityPolicy": "rclpy.qos",
    "ReliabilityPolicy": "rclpy.qos",
    "MultiThreadedExecutor": "rclpy.executors",
    "ExternalShutdownException": "rclpy.executors",
    "ReentrantCallbackGroup": "rclpy.callback_groups",
    "ServerGoalHandle": "rclpy.action.server",
    "ActionServer": "rclpy.action",
    "ActionClient": "rclpy.action",
    "GoalResponse": "rclpy.action",
    "CancelResponse": "rclpy.action",
    "QoSOverridingOptions": "rclpy.qos_overriding_options",
    "QoSPolicyKind": "rclpy.qos_overriding_options",
}
_OF_THE_STUDIO: Final = re.compile(
    r"^( *)from studio\.ros\.(?:client|action|node\.\w+|parameters\.\w+) import (.+)$", re.M
)
_WITH: Final = re.compile(r"^    with until_stopped\(args\):\n((?:        .*\n|\n)+)", re.M)


def for_rclpy(demo: str) -> str:
    """A demo of the studio as somebody would write it for rclpy."""
    found = find_demo(demo)
    assert found is not None, demo
    path = Path(__file__).resolve().parents[2].joinpath(*found.module.split("."))
    text = path.with_suffix(".py").read_text(encoding="utf-8")
    text = text.replace("import studio.ros.client as rclpy\n", "import rclpy\n")
    text = text.replace("from studio.course.running import until_stopped\n", "")
    text = text.replace("from studio.tf2.broadcasters import", "from tf2_ros import")
    text = text.replace("from studio.ros.messages.", "from ")
    text = text.replace("from studio.errors import SettingsError\n", "")
    text = text.replace("raise SettingsError(", "raise SystemExit(")
    text = _OF_THE_STUDIO.sub(_imports, text)
    text = _WITH.sub(_main, text)
    assert not re.search(r"(?:import|from) studio\b", text), f"{demo} needs more than rclpy has"
    return text


def _imports(found: re.Match[str]) -> str:
    names = [name.strip() for name in found[2].strip("()").split(",")]
    return "\n".join(
        f"{found[1]}from {_MODULES.get(name, 'rclpy.parameter')} import {name}" for name in names
    )


def _main(found: re.Match[str]) -> str:
    body = found[1].rstrip("\n")
    return (
        "    from rclpy.executors import ExternalShutdownException\n\n"
        "    rclpy.init(args=args)\n"
        f"    try:\n{body}\n"
        "    except (KeyboardInterrupt, ExternalShutdownException):\n        pass\n"
        "    finally:\n        rclpy.try_shutdown()\n"
    )
