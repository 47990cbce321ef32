"""`studio bag play`: play a bag onto its topics, so that real nodes hear it."""

from __future__ import annotations

import argparse
import contextlib
import math
import sys
import threading
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.cli.bag_storing import STORAGES
from studio.cli.keys import watching_keys
from studio.cli.mending import refuse_options
from studio.cli.numbers import count, whole
from studio.cli.own_node import LOG_LEVELS, own_node, set_log_level
from studio.cli.wire import STARTING, add_wire_options
from studio.errors import SettingsError
from studio.ros.duration import NANOSECONDS

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Sequence

    from studio.bags.bag import Bag
    from studio.cli.own_node import OwnNode
    from studio.cli.verbs import Verbs
    from studio.nodes.bag_player.options import PlayOptions
    from studio.nodes.bag_player.player import BagPlayer

_CLOCK_HZ: Final = 40.0
_READ_AHEAD: Final = 1_000
_RATE_STEP: Final = 0.1
_LATER_S: Final = 0.1
"""So long it stays after the last message, which would else be under way."""


def add(verbs: Verbs) -> None:
    """Add the verb."""
    play = verbs.add(
        "play",
        _run,
        "play a bag onto its topics",
        "Where no router answers, one is started for as long as it plays.\n"
        "Keys: SPACE pauses and goes on, RIGHT plays the next message of a paused bag, UP and DOWN "
        "change the rate.",
    )
    play.add_argument(
        "bag_path", metavar="BAG", type=_path, nargs="?",
        help="a folder of rosbag2, or a .mcap or .db3 file",
    )  # fmt: skip
    play.add_argument(
        "-i", "--input", action="append", nargs="+", default=[], metavar=("BAG", "STORAGE"),
        help="once for each of several bags, which are played together",
    )  # fmt: skip
    _add_choice(play)
    _add_times(play)
    _add_clock(play)
    _add_rest(play)
    add_wire_options(play, STARTING)


_NOT_OFFERED: Final = {
    "--message-order": "messages are played in the order in which they were received",
    "--progress-bar-separation-lines": "the line of progress stands alone; leave it out",
    "--actions": "name the topics of an action, as --topics /turn/_action/feedback",
    "--exclude-actions": "leave their topics out, as -x _action/",
    "--send-actions-as-client": "bag play sends no goals; what was told of them is played",
}
"""Options of distributions after Jazzy."""


def _add_choice(play: argparse.ArgumentParser) -> None:
    for option, metavar, text in (
        ("--topics", "TOPIC", "these alone"),
        ("--services", "SERVICE", "what these services told of their calls"),
        ("--exclude-topics", "TOPIC", "not these"),
        ("--exclude-services", "SERVICE", "not what these services told"),
    ):
        play.add_argument(option, nargs="+", default=[], metavar=metavar, help=text)
    play.add_argument(
        "-e", "--regex", default="", help="topics and services in whose names this is found"
    )
    play.add_argument("-x", "--exclude-regex", default="", metavar="REGEX", help="but not these")
    play.add_argument(
        "-m", "--remap", nargs="+", default=[], metavar="OLD:=NEW", help="play under other names"
    )
    play.add_argument(
        "--qos-profile-overrides-path", type=Path, metavar="FILE",
        help="YAML: the quality of service of topics, in place of what was recorded",
    )  # fmt: skip


def _add_times(play: argparse.ArgumentParser) -> None:
    play.add_argument("-r", "--rate", type=_above_zero, default=1.0, help="how fast (default: 1)")
    play.add_argument("-l", "--loop", action="store_true", help="begin again at the end")
    play.add_argument(
        "-d", "--delay", type=_from_zero, default=0.0, metavar="SECONDS", help="before each round"
    )
    play.add_argument(
        "--start-offset", type=_from_zero, default=0.0, metavar="SECONDS",
        help="begin so far into the bag; latched messages from before come first",
    )  # fmt: skip
    play.add_argument(
        "--playback-duration", type=_seconds, default=-1.0, metavar="SECONDS",
        help="play so much of it (default: -1, to the end)",
    )  # fmt: skip
    until = play.add_mutually_exclusive_group()
    until.add_argument(
        "--playback-until-sec", type=_seconds, default=-1.0, metavar="SECONDS",
        help="play until this time, since 1970; of this and the duration the later one counts",
    )  # fmt: skip
    until.add_argument(
        "--playback-until-nsec", type=int, default=-1, metavar="NANOSECONDS", help="the same"
    )
    play.add_argument("-p", "--start-paused", action="store_true", help="wait for SPACE")


def _add_clock(play: argparse.ArgumentParser) -> None:
    clock = play.add_mutually_exclusive_group()
    clock.add_argument(
        "--clock", type=_above_zero, nargs="?", const=_CLOCK_HZ, default=0.0, metavar="HZ",
        help=f"publish /clock so often ({_CLOCK_HZ:g} without a number), for nodes with "
        "use_sim_time; one that was recorded is left out",
    )  # fmt: skip
    clock.add_argument(
        "--clock-topics", nargs="+", default=None, metavar="TOPIC",
        help="publish /clock before each message of these",
    )  # fmt: skip
    clock.add_argument(
        "--clock-topics-all", action="store_true", help="publish /clock before each message"
    )


def _add_rest(play: argparse.ArgumentParser) -> None:
    play.add_argument(
        "--read-ahead-queue-size", type=count, default=_READ_AHEAD, metavar="N",
        help=f"messages that are read before they are due (default: {_READ_AHEAD})",
    )  # fmt: skip
    play.add_argument(
        "--disable-keyboard-controls", action="store_true", help="leave the keys alone"
    )
    play.add_argument(
        "--progress-bar-update-rate", type=_seconds, default=0.0, metavar="HZ",
        help="show so often how far it is (default: 0, never)",
    )  # fmt: skip
    play.add_argument(
        "--wait-for-all-acked", type=whole, default=None, metavar="MILLISECONDS",
        help="is taken, and changes nothing: Zenoh tells nobody what has arrived",
    )  # fmt: skip
    play.add_argument("--log-level", choices=LOG_LEVELS, default="info", help="what is said of it")
    play.add_argument("-s", "--storage", choices=STORAGES, help=argparse.SUPPRESS)
    play.add_argument("--storage-config-file", type=Path, help=argparse.SUPPRESS)
    play.add_argument("--disable-loan-message", action="store_true", help=argparse.SUPPRESS)
    play.add_argument("--publish-service-requests", action="store_true", help=argparse.SUPPRESS)
    play.add_argument("--service-requests-source", help=argparse.SUPPRESS)
    refuse_options(play, _NOT_OFFERED)


def _path(text: str) -> Path:
    path = Path(text).expanduser()
    if not path.exists():
        raise argparse.ArgumentTypeError(f"Bag path '{text}' does not exist!")
    return path


def _seconds(text: str) -> float:
    number = float(text)
    if not math.isfinite(number):
        raise argparse.ArgumentTypeError(f"{text} is no number of seconds")
    return number


def _from_zero(text: str) -> float:
    number = _seconds(text)
    if number < 0:
        raise argparse.ArgumentTypeError(f"Value {number} is less than zero.")
    return number


def _above_zero(text: str) -> float:
    number = _seconds(text)
    if number <= 0:
        raise argparse.ArgumentTypeError(f"{number} is not in the valid range (> 0.0)")
    return number


def _run(options: argparse.Namespace) -> int:
    from studio.bags.opening import open_together
    from studio.nodes.bag_player.services import NODE_NAME

    if options.publish_service_requests:
        raise SettingsError(
            "bag play sends no requests of services: leave --publish-service-requests out, and "
            "what they told of their calls is played on their topics."
        )
    paths = _paths(options)
    played = _play_options(options)
    with contextlib.closing(open_together(paths)) as bag:
        for trouble in bag.troubles:
            print(f"WARNING: {trouble}", file=sys.stderr)
        arguments = [word for rule in options.remap for word in ("--remap", rule)]
        with own_node(options, NODE_NAME, answers=True, arguments=arguments) as own:
            return _play(own, options, bag, played)


def _paths(options: argparse.Namespace) -> list[Path]:
    """Return the bags; the storages that may follow theirs are told by the files themselves.

    Raises:
        SettingsError: There is none, or one is not there.
    """
    if options.bag_path is not None and options.input:
        raise SettingsError("Give one BAG alone, or each bag with -i.")
    if options.bag_path is None and not options.input:
        raise SettingsError("Say what to play: a BAG, or several, each with -i.")
    try:
        return [options.bag_path] if options.bag_path else [_path(one[0]) for one in options.input]
    except argparse.ArgumentTypeError as error:
        raise SettingsError(str(error)) from None


def _play(own: OwnNode, options: argparse.Namespace, bag: Bag, played: PlayOptions) -> int:
    from studio.nodes.bag_player.player import BagPlayer
    from studio.nodes.bag_player.services import serve_player

    set_log_level(own, options)
    guard = own.node.create_guard_condition(lambda: None)
    player = BagPlayer(own.node, bag, played, guard.trigger, bag.splits)
    try:
        serve_player(own.node, player)
        with _keys(options, own, player), _progress(options.progress_bar_update_rate, player):
            player.play()
            own.work_until(lambda: not player.is_playing)
        own.work_until(lambda: False, _LATER_S)
    finally:
        player.stop()
    return 0 if player.failure is None else 1


def _play_options(options: argparse.Namespace) -> PlayOptions:
    from studio.bags.qos_overrides import read_qos_overrides
    from studio.nodes.bag_player.offers import Choice
    from studio.nodes.bag_player.options import PlayOptions

    choice = Choice(
        topics=tuple(options.topics),
        services=tuple(options.services),
        regex=options.regex,
        exclude_regex=options.exclude_regex,
        exclude_topics=tuple(options.exclude_topics),
        exclude_services=tuple(options.exclude_services),
    )
    choice.check()
    path = options.qos_profile_overrides_path
    until_ns = options.playback_until_nsec
    if options.playback_until_sec >= 0:
        until_ns = _ns(options.playback_until_sec)
    return PlayOptions(
        choice=choice,
        rate=options.rate,
        is_looping=options.loop,
        starts_paused=options.start_paused,
        delay_ns=_ns(options.delay),
        start_offset_ns=_ns(options.start_offset),
        duration_ns=_ns(options.playback_duration) if options.playback_duration >= 0 else None,
        until_ns=until_ns if until_ns >= 0 else None,
        read_ahead=options.read_ahead_queue_size,
        clock_hz=options.clock,
        clock_topics=() if options.clock_topics_all else _given(options.clock_topics),
        overrides={} if path is None else read_qos_overrides(path.expanduser()),
    )


def _given(topics: Sequence[str] | None) -> tuple[str, ...] | None:
    return None if topics is None else tuple(topics)


def _ns(seconds: float) -> int:
    return round(seconds * NANOSECONDS)


@contextmanager
def _keys(options: argparse.Namespace, own: OwnNode, player: BagPlayer) -> Generator[None]:
    """Let keys steer the player, where there is a terminal."""
    if options.disable_keyboard_controls:
        yield
        return
    actions: dict[str, Callable[[], object]] = {
        " ": player.toggle_paused,
        "right": player.play_next,
        "up": lambda: player.set_rate(player.rate + _RATE_STEP),
        "down": lambda: player.set_rate(player.rate - _RATE_STEP),
    }
    with watching_keys(lambda key: actions.get(key, lambda: None)()) as there_are:
        say = own.node.get_logger().info
        if there_are:
            say("Adding keyboard callbacks.")
            say("Press SPACE for Pause/Resume")
            say("Press CURSOR_RIGHT for Play Next Message")
            say("Press CURSOR_UP for Increase Rate 10%")
            say("Press CURSOR_DOWN for Decrease Rate 10%")
        yield


@contextmanager
def _progress(often_hz: float, player: BagPlayer) -> Generator[None]:
    """Show how far it is, in a line of its own that is written again and again."""
    if often_hz <= 0:
        yield
        return
    ended = threading.Event()

    def show() -> None:
        while not ended.wait(1 / often_hz):
            print(f"\r{progress_text(player)}", end="", flush=True)

    showing = threading.Thread(target=show, name="progress", daemon=True)
    showing.start()
    try:
        yield
    finally:
        ended.set()
        showing.join()
        print(f"\r{progress_text(player)}")


def progress_text(player: BagPlayer) -> str:
    """Write where a player is, as rosbag2 does: its time, how much was played, and its state."""
    now_ns = player.now_ns()
    begin_ns, end_ns = player.span_ns()
    state = "S" if not player.is_playing else "P" if player.is_paused else "R"
    done_s, all_s = (now_ns - begin_ns) / NANOSECONDS, (end_ns - begin_ns) / NANOSECONDS
    seconds, rest_ns = divmod(now_ns, NANOSECONDS)
    return f"[{seconds}.{rest_ns:09d}] Duration {done_s:.2f}/{all_s:.2f} [{state}]"
