"""Radio station: the service /get_now_playing returns what plays.

Try: `studio run radio_station service_server`, then
`studio service call /get_now_playing radio_station_interfaces/srv/GetNowPlaying "{}"`.
"""

from __future__ import annotations

import studio.ros.client as rclpy
from studio.course.running import until_stopped
from studio.ros.client import Node
from studio.ros.messages.radio_station_interfaces.srv import GetNowPlaying


class SongServiceNode(Node):
    """Answers with the same song each time."""

    def __init__(self) -> None:
        super().__init__("get_now_playing")
        self.srv = self.create_service(GetNowPlaying, "get_now_playing", self.handle_request)

    def handle_request(
        self, request: GetNowPlaying.Request, response: GetNowPlaying.Response
    ) -> GetNowPlaying.Response:
        """Fill in station, title and artist; the request holds nothing."""
        response.station_name = "Radio Educativa 100.3 FM"
        response.song_title = "Bohemian Rhapsody"
        response.artist_name = "Queen"
        self.get_logger().info("Returned current track info.")
        return response


def main(args: list[str] | None = None) -> None:
    """Serve until stopped."""
    with until_stopped(args):
        rclpy.spin(SongServiceNode())


if __name__ == "__main__":
    main()
