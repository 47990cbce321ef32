"""Radio DJ: the action /choose_song plays a song; 21 steps of feedback, one a second.

Try: `studio run radio_station radio_dj`, then `studio run radio_station song_requester`, or
`studio action send_goal --feedback /choose_song radio_station_interfaces/action/ChooseSong
"{song_name: Clocks}"` and Ctrl-C, which cancels it. `--ros-args -p step_seconds:=0.1` plays faster.
"""

from __future__ import annotations

import time

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.action import ActionServer, CancelResponse, GoalResponse, ServerGoalHandle
from studio.ros.client import MultiThreadedExecutor, Node, ReentrantCallbackGroup
from studio.ros.messages.radio_station_interfaces.action import ChooseSong

THREADS = 32
"""Each song takes one while it plays."""


class ActionServerNode(Node):
    """Plays the requested song; one without a name is rejected, a cancelled one stops."""

    def __init__(self) -> None:
        super().__init__("action_server_node")
        self.declare_parameter("step_seconds", 1.0)
        self._srv = ActionServer(
            self,
            ChooseSong,
            "choose_song",
            self.execute_cb,
            goal_callback=self.goal_cb,
            cancel_callback=lambda _goal: CancelResponse.ACCEPT,
            callback_group=ReentrantCallbackGroup(),
        )

    def goal_cb(self, goal: ChooseSong.Goal) -> GoalResponse:
        """Accept a goal that names a song."""
        return GoalResponse.ACCEPT if goal.song_name else GoalResponse.REJECT

    def execute_cb(self, goal_handle: ServerGoalHandle) -> ChooseSong.Result:
        """Play the song in steps of 5 %; the executor has further threads for all else."""
        song = goal_handle.request.song_name
        for pct in range(0, 101, 5):
            if goal_handle.is_cancel_requested:
                goal_handle.canceled()
                return ChooseSong.Result(success=False, final_message=f"Stopped {song}")
            fb = ChooseSong.Feedback(progress_pct=float(pct), status_line=f"Playing {song}")
            goal_handle.publish_feedback(fb)
            self.play_on(goal_handle)
        goal_handle.succeed()
        return ChooseSong.Result(success=True, final_message=f"Finished {song}")

    def play_on(self, goal_handle: ServerGoalHandle) -> None:
        """Play one step, unless somebody cancels the song or ends the station."""
        end = time.monotonic() + self.get_parameter("step_seconds").value
        while time.monotonic() < end and rclpy.ok() and not goal_handle.is_cancel_requested:
            time.sleep(0.02)


def main(args: list[str] | None = None) -> None:
    """Play until stopped."""
    with until_stopped(args):
        rclpy.spin(ActionServerNode(), executor=MultiThreadedExecutor(THREADS))


if __name__ == "__main__":
    main()
