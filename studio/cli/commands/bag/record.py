"""`studio bag record`: record topics into a bag."""

from __future__ import annotations

import argparse
import sys
import threading
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path
from typing import TYPE_CHECKING, Final

from studio.cli.bag_storing import add_storing_options, storing_of
from studio.cli.graph import full_name
from studio.cli.keys import watching_keys
from studio.cli.mending import refuse_options
from studio.cli.numbers import whole
from studio.cli.own_node import LOG_LEVELS, own_node, set_log_level
from studio.cli.wire import add_wire_options
from studio.errors import SettingsError
from studio.ros.names import full_type_name

if TYPE_CHECKING:
    from collections.abc import Callable, Generator

    from studio.bags.writer import Written
    from studio.cli.own_node import OwnNode
    from studio.cli.verbs import Verbs
    from studio.nodes.bag_recorder import BagRecorder, RecordSettings
    from studio.nodes.recorded_topics import TopicChoice

_CACHE_BYTES: Final = 256 * 1024 * 1024
_LEFT_OUT: Final = {
    "compression_queue_size": "messages wait by their bytes: give --max-cache-size",
    "compression_threads": "one thread compresses, and what it is too slow for is counted as lost",
    "compression_threads_priority": "one thread compresses, with the priority of the process",
}
"""Options that are accepted and change nothing, with the reason."""
_OF_LATER_DISTROS: Final = {
    "--actions": "name the topics of an action, as --topics /turn/_action/feedback",
    "--all-actions": "actions are hidden topics: --include-hidden-topics -e _action/ records them",
    "--exclude-actions": "leave their topics out, as -x _action/",
    "--static-topics-path": "topics are found by themselves; name them with --topics",
    "--repeat-transient-local": "only the first file of a split bag has what is latched; "
    "`studio bag cut` takes out a part with it",
    "--stats_max_publishing_rate": "what is lost of each topic is said at the end",
}
"""Options of distributions after Jazzy."""


def add(verbs: Verbs) -> None:
    """Add the verb."""
    record = verbs.add("record", _run, "record topics into a bag", "It ends with Ctrl-C.")
    record.add_argument("topics_positional", metavar="TOPIC", nargs="*", help="topics to record")
    record.add_argument("-o", "--output", type=Path, metavar="FOLDER", help="default: the time")
    _add_choice(record)
    _add_discovery(record)
    _add_manner(record)
    add_storing_options(record)
    refuse_options(record, _OF_LATER_DISTROS)
    record.set_defaults(takes_late=("topics_positional", []))
    add_wire_options(record)


def _add_choice(record: argparse.ArgumentParser) -> None:
    group = record.add_argument_group("which topics")
    group.add_argument("-a", "--all", action="store_true", help="all, and events of services")
    group.add_argument("--all-topics", action="store_true", help="all topics")
    group.add_argument("--all-services", action="store_true", help="events of all services")
    group.add_argument("--topics", nargs="+", default=[], metavar="TOPIC")
    group.add_argument("--services", nargs="+", default=[], metavar="SERVICE")
    group.add_argument("--topic-types", nargs="+", default=[], metavar="TYPE")
    group.add_argument("-e", "--regex", default="", metavar="REGEX", help="found in their names")
    group.add_argument(
        "-x", "--exclude-regex", "--exclude", default="", metavar="REGEX", help="but not these"
    )
    group.add_argument("--exclude-topics", nargs="+", default=[], metavar="TOPIC")
    group.add_argument("--exclude-topic-types", nargs="+", default=[], metavar="TYPE")
    group.add_argument("--exclude-services", nargs="+", default=[], metavar="SERVICE")
    group.add_argument("--include-hidden-topics", action="store_true", help="hidden ones, too")
    group.add_argument(
        "--include-unpublished-topics", action="store_true", help="those without a publisher, too"
    )
    group.add_argument(
        "--ignore-leaf-topics", action="store_true", help="but not those without a subscription"
    )


def _add_discovery(record: argparse.ArgumentParser) -> None:
    group = record.add_argument_group("how they are found and subscribed")
    group.add_argument("--no-discovery", action="store_true", help="only those there at the start")
    group.add_argument(
        "-p", "--polling-interval", type=whole, default=100, metavar="MS",
        help="between two looks at the graph while it changes (default: 100)",
    )  # fmt: skip
    group.add_argument(
        "--qos-profile-overrides-path", type=Path, metavar="FILE", help="YAML: QoS by topic"
    )
    group.add_argument(
        "--use-sim-time", action="store_true", help="messages have the time of /clock"
    )
    group.add_argument("--node-name", default="rosbag2_recorder", metavar="NAME")


def _add_manner(record: argparse.ArgumentParser) -> None:
    group = record.add_argument_group("how it is recorded")
    group.add_argument("--start-paused", action="store_true", help="begin with a pause")
    group.add_argument(
        "--snapshot-mode", action="store_true",
        help="keep messages in memory, and write them when ~/snapshot is called",
    )  # fmt: skip
    group.add_argument(
        "--max-cache-size", type=whole, default=0, metavar="BYTES",
        help="what may wait, or is kept for snapshots (default: 268435456)",
    )  # fmt: skip
    group.add_argument(
        "--max-cache-duration", type=whole, default=0, metavar="SECONDS",
        help="how long messages are kept for snapshots (default: as many as fit)",
    )  # fmt: skip
    group.add_argument("--disable-keyboard-controls", action="store_true", help="no SPACE")
    group.add_argument("--log-level", choices=LOG_LEVELS, default="info", help="what is said of it")
    for name in _LEFT_OUT:
        group.add_argument(f"--{name.replace('_', '-')}", type=int, help=argparse.SUPPRESS)


def _run(options: argparse.Namespace) -> int:
    settings = _settings(options)
    for name, reason in _LEFT_OUT.items():
        if getattr(options, name) is not None:
            print(f"WARNING: --{name.replace('_', '-')} changes nothing: {reason}.",
                  file=sys.stderr)  # fmt: skip
    folder = options.output or Path(datetime.now().strftime("rosbag2_%Y_%m_%d-%H_%M_%S"))  # noqa: DTZ005 - as on the clock of who records
    with own_node(options, options.node_name, answers=True) as own:
        return _record(own, options, folder, settings)


def _record(
    own: OwnNode, options: argparse.Namespace, folder: Path, settings: RecordSettings
) -> int:
    from studio.nodes.bag_recorder import BagRecorder
    from studio.nodes.bag_recorder_services import serve_recorder
    from studio.ros.parameters.parameter import Parameter

    set_log_level(own, options)
    logger = own.node.get_logger()

    def say(sentence: str) -> None:
        if sentence.startswith("WARNING: "):
            logger.warning(sentence.removeprefix("WARNING: "))
        else:
            logger.info(sentence)

    if options.use_sim_time:
        own.node.set_parameters([Parameter("use_sim_time", value=True)])
    is_over = threading.Event()
    guard = own.node.create_guard_condition(lambda: None)

    def end() -> None:
        is_over.set()
        guard.trigger()

    recorder = BagRecorder(own.node, folder, settings, say, end)
    try:
        serve_recorder(own.node, recorder, end)
        with _keys(options, recorder, say):
            say("Recording...")
            own.work_until(is_over.is_set)
    except (KeyboardInterrupt, SystemExit):
        pass
    finally:
        written = recorder.close()
    return _report(recorder, written, say)


def _report(recorder: BagRecorder, written: Written, say: Callable[[str], None]) -> int:
    """Say what was lost; 1 where the bag ended by itself."""
    lost = [one for one in recorder.counts() if one.lost]
    for one in lost:
        say(f"WARNING: {one.lost} of {one.count + one.lost} messages of {one.name} were lost")
    say(f"Recording stopped: {written.messages} messages in {written.path.name}")
    if recorder.trouble:
        print(f"studio: {recorder.trouble}", file=sys.stderr)
        return 1
    return 0


@contextmanager
def _keys(
    options: argparse.Namespace, recorder: BagRecorder, say: Callable[[str], None]
) -> Generator[None]:
    """Let SPACE pause and resume, where there is a terminal."""
    if options.disable_keyboard_controls:
        yield
        return

    def take(key: str) -> None:
        if key == " ":
            toggle(recorder, say)

    with watching_keys(take) as there_are:
        if there_are:
            say("Press SPACE for pausing/resuming")
        yield


def toggle(recorder: BagRecorder, say: Callable[[str], None]) -> None:
    """Pause, or resume after a pause."""
    if recorder.is_paused:
        recorder.resume()
        say("Resuming recording.")
    else:
        recorder.pause()
        say("Pausing recording.")


def _settings(options: argparse.Namespace) -> RecordSettings:
    """Read the options.

    Raises:
        SettingsError: They do not go together; the sentence says which.
    """
    from studio.bags.qos_overrides import read_qos_overrides
    from studio.nodes.bag_recorder import RecordSettings

    if options.use_sim_time and options.no_discovery:
        raise SettingsError(
            "--use-sim-time waits for /clock to be there: leave --no-discovery out."
        )
    path = options.qos_profile_overrides_path
    settings = RecordSettings(
        topics=_choice(options),
        storing=storing_of(options),
        qos={} if path is None else read_qos_overrides(path),
        discovers=not options.no_discovery,
        polling_s=options.polling_interval / 1000,
        waiting_bytes_max=options.max_cache_size or _CACHE_BYTES,
        is_paused=options.start_paused,
        snapshots=options.snapshot_mode,
        snapshot_s=options.max_cache_duration,
        uses_node_time=options.use_sim_time,
    )
    settings.topics.check()
    return settings


def _choice(options: argparse.Namespace) -> TopicChoice:
    from studio.nodes.recorded_topics import TopicChoice

    topics = [*options.topics_positional, *options.topics]
    everything = options.all or options.all_topics
    some = topics or options.topic_types or options.regex
    if not (everything or some or options.all_services or options.services):
        raise SettingsError(
            "Say what to record: topics by name, -a for all, -e for a regular expression, "
            "--topic-types, --services or --all-services."
        )
    if topics and everything:
        print("WARNING: --all or --all-topics will override --topics", file=sys.stderr)
    if options.regex and everything:
        print("WARNING: --all or --all-topics will override --regex", file=sys.stderr)
    names = {
        name: frozenset(full_name(one) for one in getattr(options, name))
        for name in ("services", "exclude_topics", "exclude_services")
    }
    return TopicChoice(
        all=everything,
        all_services=options.all or options.all_services,
        topics=frozenset(full_name(one) for one in topics),
        types=frozenset(full_type_name(one) for one in options.topic_types),
        regex=options.regex,
        exclude_types=frozenset(full_type_name(one) for one in options.exclude_topic_types),
        exclude_regex=options.exclude_regex,
        hidden=options.include_hidden_topics,
        unpublished=options.include_unpublished_topics,
        ignore_leaves=options.ignore_leaf_topics,
        **names,
    )
