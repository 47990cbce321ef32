"""`$(...)` beside stock's own resolver."""

# pyright: reportUnknownMemberType=false, reportUnknownVariableType=false
from __future__ import annotations

from typing import TYPE_CHECKING, Any
from unittest.mock import patch

import pytest
from hypothesis import given
from hypothesis import strategies as st
from xacro import substitution_args

from studio.description.evaluator.substitution import auto_typed, substitute
from studio.description.faults import Fault, Refusal

if TYPE_CHECKING:
    from collections.abc import Iterable, Iterator

ARGUMENTS = {"n": "2", "t": "left", "p": "$(find pkg)/x", "f": "0.5", "b": "true"}
ENVIRONMENT = {"SHOWN": "yes"}
PACKAGES = {"pkg": "/packages/pkg"}


class Context:
    """Fixed args, packages and environment."""

    environment = ENVIRONMENT

    def argument(self, name: str) -> str:
        if name not in ARGUMENTS:
            raise Fault("undefined-argument", name)
        return ARGUMENTS[name]

    def find_package(self, name: str) -> str:
        if name not in PACKAGES:
            raise Fault("package-not-found", name)
        return PACKAGES[name]

    def steps(self, items: Iterable[Any]) -> Iterator[Any]:
        return iter(items)


def by_stock(command: str) -> str | None:
    with (
        patch.object(substitution_args, "_eval_find", PACKAGES.__getitem__),
        patch.dict("os.environ", ENVIRONMENT),
    ):
        try:
            return substitution_args.resolve_args(f"$({command})", {"arg": dict(ARGUMENTS)})
        except (substitution_args.SubstitutionException, LookupError):
            return None


words = st.sampled_from(
    ["arg", "find", "env", "optenv", "dirname", "n", "t", "p", "pkg", "SHOWN", "NOT_SET", "$", "("]
)


@given(st.lists(words, max_size=4).map(" ".join))
def test_a_command_stands_for_what_xacro_says(command: str):
    expected = by_stock(command)
    if expected is None:
        with pytest.raises(Fault):
            substitute(command, Context())
    else:
        assert substitute(command, Context()) == expected


@pytest.mark.parametrize(
    "text",
    ["n + 1", "t + '!'", "sqrt(n * 2)", "b and 1", "arg", "n if true else f", "'%.2f' % pi"],
)
def test_eval_sees_args_and_mathematics(text: str):
    expected = by_stock(f"eval {text}")
    if "function" in str(expected):
        assert "method" in substitute(f"eval {text}", Context())
    else:
        assert substitute(f"eval {text}", Context()) == expected


@pytest.mark.parametrize("text", ["open", "exec", "eval", "__import__", "().__class__", "globals"])
def test_eval_sees_no_other_builtins(text: str):
    with pytest.raises((NameError, Refusal)):
        substitute(f"eval {text}", Context())


@pytest.mark.parametrize(
    ("text", "value"),
    [("1", 1), ("1.5", 1.5), ("True", True), ("false", False), ("a", "a"), ("1.5.2", "1.5.2")],
)
def test_an_arg_in_eval_has_a_type(text: str, value: object):
    assert auto_typed(text) == value
    assert substitution_args.convert_value(text, "auto") == value
