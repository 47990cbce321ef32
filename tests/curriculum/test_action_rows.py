"""The course's rows on actions: A1 and A2, the radio DJ in a process of his own."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import pytest

from studio.ros.action import ActionClient, GoalStatus
from studio.ros.client import Node, action
from tests.support.demos import node_at, running_demo
from tests.support.patience import Stopwatch
from tests.support.wire import PATIENCE_S, wait_until

if TYPE_CHECKING:
    from studio.ros.action import ClientGoalHandle
    from studio.ros.client import Future

pytestmark = pytest.mark.network
CHOOSE_SONG = "radio_station_interfaces/action/ChooseSong"
FAST = ("--ros-args", "-p", "step_seconds:=0.05")
SLOW = ("--ros-args", "-p", "step_seconds:=0.5")


class Requester:
    """Wishes songs, and keeps what the DJ says."""

    def __init__(self, node: Node) -> None:
        self.client = ActionClient(node, action(CHOOSE_SONG), "choose_song")
        assert self.client.wait_for_server(PATIENCE_S)
        self.said: list[Any] = []

    def wish(self, song: str) -> ClientGoalHandle:
        goal = action(CHOOSE_SONG).Goal(song_name=song)
        sent = self.client.send_goal_async(
            goal, feedback_callback=lambda told: self.said.append(told.feedback)
        )
        return finished(sent)


def finished(future: Future[Any]) -> Any:  # noqa: ANN401
    wait_until("an answer", future.done)
    return future.result()


def test_a1_a_song_gives_21_feedbacks_and_a_result(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "radio_dj", *FAST):
        requester = Requester(node)
        answer = finished(requester.wish("Clocks").get_result_async())
        assert answer.status == GoalStatus.SUCCEEDED
        assert answer.result.success
        assert answer.result.final_message == "Finished Clocks"
        wait_until("all feedbacks", lambda: len(requester.said) == 21)
        assert [said.progress_pct for said in requester.said] == list(range(0, 101, 5))
        assert {said.status_line for said in requester.said} == {"Playing Clocks"}


def test_a1_the_requester_logs_the_feedback_and_ends_with_the_song(endpoint: str):
    with (
        running_demo(endpoint, "radio_dj", *FAST),
        running_demo(endpoint, "song_requester", "Clocks") as requester,
    ):
        assert requester.wait() == 0
    assert requester.printed.count("DJ says: Playing Clocks") == 21
    assert "DJ final: Finished Clocks" in requester.printed


def test_a2_a_goal_that_is_cancelled_ends_canceled_within_a_second(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "radio_dj", *SLOW):
        requester = Requester(node)
        goal = requester.wish("Clocks")
        wait_until("the song plays", lambda: bool(requester.said))
        watch = Stopwatch()
        assert finished(goal.cancel_goal_async()).goals_canceling
        answer = finished(goal.get_result_async())
        assert watch.s < 1.0
        assert answer.status == GoalStatus.CANCELED
        assert answer.result.final_message == "Stopped Clocks"


def test_a2_a_song_without_a_name_is_refused(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "radio_dj", *FAST):
        requester = Requester(node)
        assert not requester.wish("").accepted
        assert requester.wish("Clocks").accepted


def test_a2_two_songs_at_once_both_end(endpoint: str):
    with node_at(endpoint) as node, running_demo(endpoint, "radio_dj", *FAST):
        requester = Requester(node)
        goals = [requester.wish(song) for song in ("Clocks", "Yellow")]
        answers = [finished(goal.get_result_async()) for goal in goals]
        said = [answer.result.final_message for answer in answers]
        assert said == ["Finished Clocks", "Finished Yellow"]


def test_a2_one_of_many_songs_is_cancelled_while_the_others_play(endpoint: str):
    """More than the machine has cores: each is worked on nevertheless."""
    with node_at(endpoint) as node, running_demo(endpoint, "radio_dj", *SLOW):
        requester = Requester(node)
        goals = [requester.wish(f"Song {number}") for number in range(12)]
        playing = {f"Playing Song {number}" for number in range(12)}
        wait_until("all play", lambda: {said.status_line for said in requester.said} == playing)
        finished(goals[-1].cancel_goal_async())
        assert finished(goals[-1].get_result_async()).status == GoalStatus.CANCELED
        assert goals[0].status == GoalStatus.EXECUTING
