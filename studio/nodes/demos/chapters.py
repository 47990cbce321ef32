"""The demos as lessons: by chapter, in the order in which they are taught; plain data, not run."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Lesson:
    """One demo, as somebody meets it who learns.

    Attributes:
        demo: Its name in the table of demos.
        node: The full name of its node, while it runs.
        words: Of a command line that it cannot do without.
        has_keys: It is driven by key presses.
    """

    demo: str
    node: str
    words: tuple[str, ...] = ()
    has_keys: bool = False


CHAPTERS: dict[str, tuple[Lesson, ...]] = {
    "nodes": (
        Lesson("hello_world", "/node_helloworld_class"),
        Lesson("my_first_node", "/my_node_name"),
        Lesson("my_tiny_node", "/my_tiny_node"),
        Lesson("basic_node", "/basic_node"),
        Lesson("print_forever", "/print_forever"),
    ),
    "topics": (
        Lesson("talker", "/topic_helloworld_pub"),
        Lesson("listener", "/topic_helloworld_sub"),
        Lesson("publisher_node", "/publisher_node"),
        Lesson("subscriber_node", "/subscriber_node"),
        Lesson("timer_node", "/timer_node"),
        Lesson("quote_publisher", "/amazing_quote_publisher_node"),
        Lesson("quote_subscriber", "/amazing_quote_subscriber_node"),
        Lesson("number_publisher", "/my_tiny_pub"),
        Lesson("number_counter", "/my_tiny_sub"),
        Lesson("telemetry_publisher", "/telemetry_publisher"),
        Lesson("temperature_publisher", "/temperature_publisher"),
        Lesson("temperature_subscriber", "/temperature_subscriber"),
        Lesson("qos_topic_node", "/qos_topic_node"),
    ),
    "services": (
        Lesson("adder_server", "/service_adder_server"),
        Lesson("adder_client", "/service_adder_client", words=("41", "1")),
        Lesson("service_server_node", "/service_server_node"),
        Lesson("service_client_node", "/service_client_node"),
        Lesson("now_playing_server", "/get_now_playing"),
        Lesson("now_playing_client", "/now_playing_client_sol"),
        Lesson("add_points_server", "/add_points_service_server"),
        Lesson("add_points_client", "/add_points_service_client"),
    ),
    "actions": (
        Lesson("radio_dj", "/action_server_node"),
        Lesson("song_requester", "/song_requester"),
    ),
    "parameters": (Lesson("parameter_node", "/parameter_node"),),
    "turtlesim": (
        Lesson("turtlesim_node", "/turtlesim"),
        Lesson("turtle_teleop_key", "/teleop_turtle", has_keys=True),
    ),
    "jerry": (
        Lesson("jerry_robot", "/jerry_robot_node"),
        Lesson("jerry_command_publisher", "/command_publisher_node"),
        Lesson("jerry_client", "/client_node"),
    ),
    "robots": (
        Lesson("state_publisher", "/state_publisher"),
        Lesson("rover", "/rover"),
        Lesson("transform_point", "/transform_point"),
    ),
    "lifecycle": (Lesson("lifecycle_talker", "/lc_talker"),),
}
"""Every demo stands in one of them."""

LESSONS = {lesson.demo: lesson for chapter in CHAPTERS.values() for lesson in chapter}
"""By the demo's name."""
