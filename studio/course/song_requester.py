"""Song requester: requests a song from the radio DJ, logs the feedback, and ends with the song.

Try: `studio run radio_station radio_dj`, then `studio run radio_station song_requester Clocks`.
"""

from __future__ import annotations

import sys
from typing import Any

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.action import ActionClient
from studio.ros.client import Future, Node
from studio.ros.messages.radio_station_interfaces.action import ChooseSong


class SongRequester(Node):
    """Sends one goal; each answer brings the next question."""

    def __init__(self, song: str) -> None:
        super().__init__("song_requester")
        self._action_client = ActionClient(self, ChooseSong, "choose_song")
        self._song = song
        self._action_client.wait_for_server()
        self.send_request()

    def send_request(self) -> None:
        """Send the goal."""
        goal = ChooseSong.Goal(song_name=self._song)
        self._send_future = self._action_client.send_goal_async(
            goal, feedback_callback=self.feedback_cb
        )
        self._send_future.add_done_callback(self.goal_response_cb)

    def feedback_cb(self, feedback_msg: ChooseSong.FeedbackMessage) -> None:
        """Log how far it is."""
        fb = feedback_msg.feedback
        self.get_logger().info(f"DJ says: {fb.status_line}")

    def goal_response_cb(self, future: Future[Any]) -> None:
        """Ask for the result, if the DJ accepts the goal."""
        goal_handle = future.result()
        if not goal_handle.accepted:
            self.get_logger().warn("The DJ does not play it.")
            rclpy.shutdown()
            return
        result_future = goal_handle.get_result_async()
        result_future.add_done_callback(self.result_cb)

    def result_cb(self, future: Future[Any]) -> None:
        """Log the result, and end."""
        result = future.result().result
        self.get_logger().info(f"DJ final: {result.final_message}")
        rclpy.shutdown()


def main(args: list[str] | None = None) -> None:
    """Request one song."""
    with until_stopped(args):
        song = sys.argv[1] if len(sys.argv) > 1 else "Bohemian Rhapsody"
        rclpy.spin(SongRequester(song))


if __name__ == "__main__":
    main()
