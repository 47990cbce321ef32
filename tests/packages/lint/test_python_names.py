from __future__ import annotations

from typing import TYPE_CHECKING

from tests.support.seeded_packages import (
    codes,
    finding,
    interface_package,
    mended,
    problems,
    sound,
    written,
)

if TYPE_CHECKING:
    from pathlib import Path

HEAD = "import rclpy\nfrom rclpy.node import Node\n"
SERVER = """\
from radio_station_interfaces.srv import GetNowPlaying
import rclpy
from rclpy.node import Node


class NowPlayingServer(Node):
    def __init__(self):
        super().__init__('now_playing')
        self.create_service(GetNowPlaying, 'get_now_playing', self.answer)

    def answer(self, request, response):
        response.station = 'one'
        return response


def main(args=None):
    rclpy.init(args=args)
    node = NowPlayingServer()
    rclpy.spin(node)
    rclpy.shutdown()
"""


def radio(folder: Path, before: str = "", after: str = "") -> Path:
    """Both packages of the radio station; a fault is seeded into the server."""
    interface_package(folder)
    package = sound(folder, "radio_station", "ament_python", "rclpy", "radio_station_interfaces")
    assert before in SERVER
    written(package, "radio_station/talker.py", SERVER.replace(before, after) if before else SERVER)
    return package


def test_the_corrected_server_of_the_course_has_no_fault(tmp_path: Path):
    radio(tmp_path)
    assert problems(tmp_path) == ()


def test_an_import_of_a_file_finds_the_package_of_the_type(tmp_path: Path):
    # A listing of the course, S0:369
    radio(tmp_path, "from radio_station_interfaces.srv", "from GetNowPlaying.srv")
    mended(tmp_path, "type-of-other-package", "talker.py", 1)
    assert codes(tmp_path) == set()


def test_a_type_of_the_wrong_package_is_found_in_the_right_one(tmp_path: Path):
    radio(tmp_path, "from radio_station_interfaces.srv", "from std_srvs.srv")
    mended(tmp_path, "type-of-other-package", "talker.py", 1)
    assert codes(tmp_path) == set()


def test_a_service_is_no_message(tmp_path: Path):
    radio(tmp_path, "radio_station_interfaces.srv", "radio_station_interfaces.msg")
    mended(tmp_path, "type-of-other-package", "talker.py", 1)


def test_a_misspelt_type_is_mended(tmp_path: Path):
    radio(tmp_path, "import GetNowPlaying", "import GetNowPlayin")
    finding(tmp_path, "type-unknown", "talker.py", 1)


def test_a_package_that_nobody_knows_is_told(tmp_path: Path):
    radio(
        tmp_path,
        "radio_station_interfaces.srv import GetNowPlaying",
        "no_such_msgs.srv import Quux",
    )
    finding(tmp_path, "type-unknown", "talker.py", 1)


def test_names_that_were_never_imported_are(tmp_path: Path):
    # A listing of the course, S0:369: import rclpy and Node missing
    radio(tmp_path, HEAD, "")
    mended(tmp_path, "name-not-imported", "talker.py")
    mended(tmp_path, "name-not-imported", "talker.py")
    assert codes(tmp_path) == set()


def test_a_class_that_nobody_made_is_the_one_that_is_there(tmp_path: Path):
    # A listing of the course, S0:369: SongServiceNode
    radio(tmp_path, "node = NowPlayingServer()", "node = SongServiceNode()")
    mended(tmp_path, "name-unknown", "talker.py", 18)
    assert codes(tmp_path) == set()


def test_misspelt_words_of_rclpy_and_of_services_are_mended(tmp_path: Path):
    # A listing of the course, S0:437: reguest, Reguest
    radio(tmp_path, "self.create_service(", "self.create_servise(")
    mended(tmp_path, "misspelt-name", "talker.py", 9)
    assert codes(tmp_path) == set()
    package = tmp_path / "radio_station"
    written(
        package,
        "radio_station/talker.py",
        SERVER.replace("response.station = 'one'", "self.last = GetNowPlaying.Reguest()"),
    )
    mended(tmp_path, "misspelt-name", "talker.py", 12)
    written(package, "radio_station/talker.py", SERVER.replace("rclpy.spin(", "rclpy.spinn("))
    mended(tmp_path, "misspelt-name", "talker.py", 19)
    assert codes(tmp_path) == set()


def test_a_word_behind_self_that_nobody_set_is_mended(tmp_path: Path):
    radio(
        tmp_path,
        "        response.station = 'one'\n",
        "        self.request = request\n        print(self.reguest)\n",
    )
    mended(tmp_path, "misspelt-name", "talker.py", 13)
    assert codes(tmp_path) == set()


def test_action_servers_are_objects(tmp_path: Path):
    # A listing of the course, S0:507
    radio(
        tmp_path,
        "self.create_service(GetNowPlaying, 'get_now_playing', self.answer)",
        "self.create_action_server(GetNowPlaying, 'x', self.answer)",
    )
    mended_text = tmp_path / "radio_station" / "radio_station" / "talker.py"
    one = finding(tmp_path, "no-such-method", "talker.py", 9)
    assert one.fix is not None
    assert "ActionServer(node" in one.sentence
    assert "create_action_server" in mended_text.read_text()


def test_what_is_no_python_is_one_sentence_with_its_line(tmp_path: Path):
    # A listing of the course, S0:471: the f-string call unclosed
    radio(tmp_path, "super().__init__('now_playing')", "super().__init__('now_playing'")
    finding(tmp_path, "python-broken", "talker.py")


def test_names_of_other_scopes_and_of_comprehensions_are_no_fault(tmp_path: Path):
    package = sound(tmp_path)
    text = "import sys as s\nfrom math import *\n\nprint(undefined_by_star, s)\n"
    written(package, "my_pkg/star.py", text)
    text = (
        "def outer(a, *b, c=1, **d):\n    def inner():\n        nonlocal a\n"
        "        a = [x for x in b]\n"
        "        return lambda y: (a, c, d, y, __file__)\n    try:\n        return inner\n"
        "    except ValueError as error:\n        print(error)\n    with open('f') as f:\n"
        "        print(f)\n    match a:\n        case {'k': v, **rest}:\n"
        "            print(v, rest)\n"
        "        case [q, *others] as whole:\n            print(q, others, whole)\n"
        "    if (walrus := 3):\n        print(walrus)\n"
    )
    written(package, "my_pkg/scopes.py", text)
    assert codes(tmp_path) == set()
