"""Options of `ros2` that are known and not offered: a sentence says why, and what to do instead."""

from __future__ import annotations

import argparse
from typing import TYPE_CHECKING, Any, NoReturn

from typing_extensions import override

if TYPE_CHECKING:
    from collections.abc import Mapping


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
