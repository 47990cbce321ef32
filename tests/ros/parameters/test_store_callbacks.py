from __future__ import annotations

from typing import cast

from studio.ros.parameters.parameter import Parameter, usual_messages
from studio.ros.parameters.store import ParameterCallbacks

RESULT = usual_messages().SetParametersResult
AGREED = RESULT(successful=True)
PARAMETERS = [Parameter("a", value=1)]


def test_the_first_refusal_counts():
    callbacks = ParameterCallbacks()
    callbacks.on_set = [
        lambda _: RESULT(successful=True),
        lambda _: RESULT(successful=False, reason="too fast"),
        lambda _: RESULT(successful=False, reason="never asked"),
    ]
    assert callbacks.ask(PARAMETERS, AGREED) == RESULT(successful=False, reason="too fast")


def test_a_callback_that_returns_nothing_refuses_and_says_so():
    callbacks = ParameterCallbacks()
    callbacks.on_set = [lambda _: cast("object", None)]
    assert "returned no SetParametersResult" in callbacks.ask(PARAMETERS, AGREED).reason


def test_callbacks_may_change_what_is_set_and_hear_what_was():
    callbacks = ParameterCallbacks()
    heard: list[list[Parameter]] = []
    callbacks.pre_set = [lambda given: [*given, Parameter("b", value=2)]]
    callbacks.post_set = [heard.append]
    callbacks.after(callbacks.before(PARAMETERS))
    assert heard == [[Parameter("a", value=1), Parameter("b", value=2)]]
