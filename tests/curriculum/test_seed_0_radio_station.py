"""S0 as a student works through it: a description, a radio station, a song, and a launch file."""

from __future__ import annotations

from typing import TYPE_CHECKING

import pytest

from tests.support.course_workspaces import radio_station
from tests.support.student import student_in

if TYPE_CHECKING:
    from collections.abc import Generator

    from tests.support.student import Student

QUICK = "--ros-args -p step_seconds:=0.05"
"""The studio's own DJ plays a song in this time; that of the texts has it in its code."""
NOW_PLAYING = "radio_station_interfaces/srv/GetNowPlaying"
CHOOSE_SONG = "radio_station_interfaces/action/ChooseSong"


@pytest.fixture(scope="module")
def student(tmp_path_factory: pytest.TempPathFactory) -> Generator[Student]:
    with student_in(radio_station, tmp_path_factory.mktemp("s0")) as found:
        yield found


def test_the_packages_are_there_with_what_they_start(student: Student):
    listed = student.types("pkg executables radio_station").out.split("\n")
    assert "radio_station radio_dj" in listed
    assert "radio_station service_server" in listed
    shown = student.types(f"interface show {CHOOSE_SONG}").out
    assert "float32 progress_pct" in shown


def test_the_station_answers_what_plays(student: Student):
    with student.running("run radio_station service_server") as server:
        student.sees("node list", "/get_now_playing")
        student.sees("service type /get_now_playing", NOW_PLAYING)
        called = student.types(f'service call /get_now_playing {NOW_PLAYING} "{{}}"')
        assert "song_title='Bohemian Rhapsody'" in called.out, called
        with student.running("run radio_station service_client") as client:
            client.wait_for("Artist: Queen")
            client.wait_for("Shutting down client node.")
            client.wait()
        server.wait_for("track")


def test_a_song_is_played_with_feedback(student: Student):
    with student.running(f"run radio_station radio_dj {QUICK}"):
        student.sees("action list", "/choose_song")
        sent = student.types(
            f'action send_goal --feedback /choose_song {CHOOSE_SONG} "{{song_name: Clocks}}"'
        )
        assert "Finished Clocks" in sent.out, sent
        assert sent.out.count("Playing Clocks") == 21
        with student.running("run radio_station song_requester") as requester:
            requester.wait_for("DJ final: Finished Bohemian Rhapsody")
            requester.wait()
            assert requester.printed.count("DJ says: Playing") == 21


def test_the_robot_is_one_tree_with_four_wheels(student: Student):
    file = "src/my_robot_description/urdf/my_robot.xacro"
    expanded = student.expands(f"xacro {file} wheel_radius:=0.4")
    assert expanded.count('radius="0.4"') == 4
    checked = student.types(f"check {file}")
    assert checked.code == 0, checked


def test_the_station_and_a_dj_in_a_namespace_are_launched(student: Student):
    printed = student.types("launch radio_station radio.launch.py --print").out
    assert "/late/night_dj" in printed
    with student.launched("launch radio_station radio.launch.py") as launch:
        student.sees("node list", "/late/night_dj\n")
        student.sees("service list", "/get_now_playing\n")
        assert launch.stop() == 0, launch.printed
    student.sees_that("node list", lambda ran: "night_dj" not in ran.out)


def test_the_robot_is_launched_with_an_argument(student: Student):
    shown = student.types("launch my_robot_description robot_display.launch.py --show-args").out
    assert "'wheel_radius':" in shown
    line = "launch my_robot_description robot_display.launch.py wheel_radius:=0.4"
    with student.launched(line):
        student.sees("topic list", "/robot_description\n")
        student.sees(
            "topic echo --once --full-length --qos-durability transient_local /robot_description",
            "0.4",
        )
        student.sees("topic echo --once /tf", "front_left_link")
