"""What was meant by a line that `studio` does not know: misspelt, of the shell, or only of ros2."""

from __future__ import annotations

import argparse
import difflib
import re
from typing import TYPE_CHECKING, Any, Final, NoReturn

from typing_extensions import override

from studio.cli.terminal import harmless

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

_WRONG: Final = re.compile(
    r"argument (?:COMMAND|VERB): invalid choice: '(.*)' \(choose from (.*)\)"
)
_BUILT: Final = (
    "nothing is built here, nodes run from their source files and interfaces are read as they are "
    "saved; in ROS it makes build, install and log in the root of the workspace"
)
_ENVIRONMENT: Final = "the studio needs no ROS in its environment"
_PAGE: Final = "studio open shows it in the page"
_INSTEAD: Final = {
    "colcon": _BUILT,
    "rosdep": "nothing is installed to run a node; in ROS it installs what package.xml depends on",
    "source": _ENVIRONMENT,
    "rqt_graph": f"{_PAGE}, in Node graph",
    "rqt_plot": f"{_PAGE}, in Plot",
    "rqt_console": f"{_PAGE}, in Log",
    "rqt_image_view": f"{_PAGE}, in Image",
    "rqt": _PAGE,
    "rviz2": f"{_PAGE}, with its displays",
    "gazebo": "the studio has no physics",
    "gz": "the studio has no physics",
    "apt": "the studio needs no ROS to be installed",
}
"""Commands of a shell that courses print, and what there is here."""
_BAG_INSTEAD: Final = {
    "burst": (
        "studio bag play BAG --start-paused waits, and the service /rosbag2_player/burst "
        "(rosbag2_interfaces/srv/Burst) plays as many messages as num_messages says"
    ),
    "convert": (
        "studio bag cut IN OUT writes the whole bag anew, with the storage and the compression of "
        "its options, as -s sqlite3"
    ),
    "list": (
        "there are no plugins to list, mcap and sqlite3 are read and written, and studio bag info "
        "BAG says what a bag is"
    ),
}
"""Verbs of `ros2 bag` that are not offered."""


class MendingParser(argparse.ArgumentParser):
    """A parser whose sentence about an unknown word ends with the one that is most like it."""

    def error(self, message: str) -> NoReturn:
        """Print the usage and the sentence, and end with code 2."""
        super().error(message + _meant(self.prog, message))


def without_ros2(arguments: Sequence[str]) -> list[str]:
    """Return a line without `ros2`, with which it was pasted: `studio ros2 topic list`."""
    words = list(arguments)
    return words[1:] if words[:1] == ["ros2"] else words


def instead_of(arguments: Sequence[str]) -> str | None:
    """Return a sentence about a line that is none of `studio`; None: nothing is known of it."""
    words = list(arguments)
    word = words[0] if words else ""
    if word == "doctor" and "--include-dds" in words:
        return "doctor has no --include-dds, nor has that of ROS 2: studio doctor --report."
    if words[:3] == ["run", "lifecycle", "lifecycle_service_client"]:
        return (
            "the demo lifecycle_service_client is not here: studio lifecycle get NODE says the "
            "state of a node, and studio lifecycle set NODE configure changes it (ros2 has both)."
        )
    if word == "bag" and (instead := _BAG_INSTEAD.get(words[1] if len(words) > 1 else "")):
        return f"bag {words[1]} is not here: {instead}."
    instead = _INSTEAD.get(word)
    return None if instead is None else f"{word} is no command of the studio: {instead}."


def _meant(prog: str, message: str) -> str:
    found = _WRONG.search(message)
    if found is None:
        return ""
    choices = re.findall(r"[\w-]+", found[2])
    nearest = difflib.get_close_matches(found[1].strip("_"), choices, n=1, cutoff=0.6)
    return f"\n{prog}: did you mean: {harmless(prog)} {nearest[0]}" if nearest else ""


class _Refusal(argparse.Action):
    """Ends with a sentence as soon as the option is met."""

    def __init__(self, option_strings: list[str], dest: str, sentence: str, **more: Any) -> None:  # noqa: ANN401 - what argparse gives
        super().__init__(option_strings, dest, nargs="*", help=argparse.SUPPRESS, **more)
        self._sentence = sentence

    @override
    def __call__(self, parser: argparse.ArgumentParser, *_: object) -> NoReturn:
        parser.error(f"{self.option_strings[0]}: {self._sentence}.")


def refuse_options(parser: argparse.ArgumentParser, sentences: Mapping[str, str]) -> None:
    """Refuse options, each with a sentence that has no dot; they are not in the help."""
    for option, sentence in sentences.items():
        parser.add_argument(option, action=_Refusal, sentence=sentence, default=argparse.SUPPRESS)
