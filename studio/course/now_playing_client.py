"""Radio listener: asks /get_now_playing what plays, logs it and ends.

Try: `studio run radio_station service_client` before `studio run radio_station service_server`:
it waits for the station.
"""

from __future__ import annotations

from typing import Any

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Future, Node
from studio.ros.messages.radio_station_interfaces.srv import GetNowPlaying


class NowPlayingClient(Node):
    """Asks once; the answer's callback ends it."""

    def __init__(self) -> None:
        super().__init__("now_playing_client_sol")
        self.client = self.create_client(GetNowPlaying, "get_now_playing")
        while not self.client.wait_for_service(timeout_sec=1.0):
            self.get_logger().info("Waiting for now playing service...")
        self.request = GetNowPlaying.Request()
        self.send_request()

    def send_request(self) -> None:
        """Ask, and do not wait."""
        future = self.client.call_async(self.request)
        future.add_done_callback(self.handle_response)

    def handle_response(self, future: Future[Any]) -> None:
        """Log what plays."""
        response = future.result()
        self.get_logger().info(
            f"Now Playing:\nStation: {response.station_name}\n"
            f"Song: {response.song_title}\nArtist: {response.artist_name}"
        )
        self.get_logger().info("Shutting down client node.")
        rclpy.shutdown()


def main(args: list[str] | None = None) -> None:
    """Ask once."""
    with until_stopped(args):
        rclpy.spin(NowPlayingClient())


if __name__ == "__main__":
    main()
