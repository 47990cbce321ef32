"""Conditions of actions."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.errors import SubstitutionFailure
from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.substitutions import truth_of
from studio.launch.vocabulary.texts import SomeText, described, is_unknown, perform, to_texts

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.launch.vocabulary.context import LaunchContext


class UnknownTruthError(Exception):
    """It depends on a value that planning does not know."""


class Condition:
    """Whether an action is done."""

    def __init__(self, *, predicate: Callable[[LaunchContext], bool] | None = None) -> None:
        self.where = here()
        self.predicate = predicate

    def evaluate(self, context: LaunchContext) -> bool:
        """Return whether it holds.

        Raises:
            UnknownTruthError: Planning does not know a value that it needs.
            SubstitutionFailure: It has no truth.
        """
        return self.predicate is None or bool(self.predicate(context))

    def describe(self) -> str:
        """Return it as a text."""
        return "a function"


class IfCondition(Condition):
    """Holds where a text is true."""

    def __init__(self, predicate_expression: SomeText) -> None:
        super().__init__()
        self.expression = to_texts(predicate_expression)

    def evaluate(self, context: LaunchContext) -> bool:
        text = perform(context, self.expression)
        if is_unknown(text):
            raise UnknownTruthError
        try:
            return truth_of(text)
        except SubstitutionFailure as error:
            raise InvalidConditionExpressionError(
                f"the condition {self.describe()} is '{text}', which is neither true nor false"
            ) from error

    def describe(self) -> str:
        return f"if {described(self.expression)}"


class UnlessCondition(IfCondition):
    """Holds where a text is false."""

    def evaluate(self, context: LaunchContext) -> bool:
        return not super().evaluate(context)

    def describe(self) -> str:
        return f"unless {described(self.expression)}"


class LaunchConfigurationEquals(Condition):
    """Holds where an argument has a value; None: where it is not set."""

    def __init__(self, launch_configuration_name: str, expected_value: SomeText | None) -> None:
        super().__init__()
        self.name = launch_configuration_name
        self.expected = None if expected_value is None else to_texts(expected_value)

    def evaluate(self, context: LaunchContext) -> bool:
        value = context.launch_configurations.get(self.name)
        if isinstance(value, str) and is_unknown(value):
            raise UnknownTruthError
        expected = None if self.expected is None else perform(context, self.expected)
        return value == expected

    def describe(self) -> str:
        return (
            f"if $(var {self.name}) == {'' if self.expected is None else described(self.expected)}"
        )


class LaunchConfigurationNotEquals(LaunchConfigurationEquals):
    """Holds where an argument has not that value."""

    def evaluate(self, context: LaunchContext) -> bool:
        return not super().evaluate(context)

    def describe(self) -> str:
        return super().describe().replace(" == ", " != ", 1)


class InvalidConditionExpressionError(SubstitutionFailure):
    """A condition's text is no truth; ROS's name."""


def evaluate_condition_expression(context: LaunchContext, expression: SomeText) -> bool:
    """Return the truth of a text, as IfCondition takes it."""
    return IfCondition(expression).evaluate(context)
