"""The substitutions of launch and launch_ros."""

from __future__ import annotations

import math
import os
import shutil
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final

import yaml

from studio.errors import PackageNotFoundError, SubstitutionFailure
from studio.launch.vocabulary.texts import (
    SomeText,
    Substitution,
    TextSubstitution,
    described,
    is_unknown,
    perform,
    to_texts,
)

if TYPE_CHECKING:
    from collections.abc import Iterable

    from studio.launch.vocabulary.context import LaunchContext

_FILE_MAX_BYTES: Final = 4 << 20
_EXPRESSION_MAX: Final = 20_000


class LaunchConfiguration(Substitution):
    """The value of an argument, or of what SetLaunchConfiguration set."""

    def __init__(self, variable_name: SomeText, *, default: object = None) -> None:
        super().__init__()
        self.variable_name = to_texts(variable_name)
        self.default = None if default is None else _text_of_default(default)

    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.variable_name)
        if name in context.launch_configurations:
            return str(context.launch_configurations[name])
        if self.default is None:
            raise SubstitutionFailure(
                f"launch configuration '{name}' does not exist: declare it with "
                "DeclareLaunchArgument, and before it is used"
            )
        return perform(context, self.default)

    def describe(self) -> str:
        return f"$(var {described(self.variable_name)})"


def _text_of_default(default: object) -> object:
    """As ROS does it: what is no text becomes one."""
    if isinstance(default, str | Substitution | os.PathLike | list | tuple):
        return default  # pyright: ignore[reportUnknownVariableType]
    return str(default)


class EnvironmentVariable(Substitution):
    """A variable of the environment."""

    def __init__(self, name: SomeText, *, default_value: SomeText | None = None) -> None:
        super().__init__()
        self.name = to_texts(name)
        self.default_value = default_value

    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        if name in context.environment:
            return context.environment[name]
        if self.default_value is None:
            raise SubstitutionFailure(
                f"environment variable '{name}' does not exist: set it before, or give a default"
            )
        return perform(context, self.default_value)

    def describe(self) -> str:
        return f"$(env {described(self.name)})"


class PathJoinSubstitution(Substitution):
    """Parts of a path, joined as os.path.join does."""

    def __init__(self, substitutions: Iterable[SomeText]) -> None:
        super().__init__()
        self.substitutions = [to_texts(one) for one in substitutions]

    def perform(self, context: LaunchContext) -> str:
        return os.path.join(*(perform(context, one) for one in self.substitutions))  # noqa: PTH118

    def describe(self) -> str:
        return "/".join(described(one) for one in self.substitutions)


class PythonExpression(Substitution):
    """The text of what a Python expression gives."""

    def __init__(self, expression: SomeText, python_modules: SomeText = ("math",)) -> None:
        super().__init__()
        self.expression = to_texts(expression)
        self.python_modules = (
            [python_modules] if isinstance(python_modules, str) else list(python_modules)  # pyright: ignore
        )

    def perform(self, context: LaunchContext) -> str:
        text = perform(context, self.expression)
        if is_unknown(text):
            return text
        if len(text) > _EXPRESSION_MAX:
            raise SubstitutionFailure(f"an expression has more than {_EXPRESSION_MAX} letters")
        names: dict[str, Any] = {**vars(math), "math": math}
        for module in self.python_modules:
            one = __import__(perform(context, module))
            names |= {**vars(one), one.__name__: one}
        try:
            # A launch file is a program: what it computes runs in a process of its own.
            return str(eval(text, {"__builtins__": __builtins__}, names))
        except Exception as error:
            raise SubstitutionFailure(
                f"the expression {text!r} cannot be computed ({type(error).__name__}: {error})"
            ) from error

    def describe(self) -> str:
        return f"$(eval {described(self.expression)})"


class Command(Substitution):
    """What a command prints."""

    def __init__(self, command: SomeText, *, on_stderr: SomeText = "fail") -> None:
        super().__init__()
        self.command = to_texts(command)
        self.on_stderr = to_texts(on_stderr)

    def perform(self, context: LaunchContext) -> str:
        line = perform(context, self.command)
        return context.host.output_of(line, perform(context, self.on_stderr), self.where)

    def describe(self) -> str:
        return f"$(command '{described(self.command)}')"


class FindExecutable(Substitution):
    """The path of a program on the PATH; xacro is the studio's own where there is none."""

    def __init__(self, *, name: SomeText) -> None:
        super().__init__()
        self.name = to_texts(name)

    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        found = shutil.which(name)
        if found is None and name in ("xacro", "ros2"):
            return name
        if found is None:
            raise SubstitutionFailure(f"executable '{name}' not found on the PATH")
        return found

    def describe(self) -> str:
        return f"$(find-exec {described(self.name)})"


class ThisLaunchFile(Substitution):
    """The path of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        if not context.current_file:
            raise SubstitutionFailure("ThisLaunchFile used outside of a launch file (in a script)")
        return context.current_file

    def describe(self) -> str:
        return "$(filename)"


class ThisLaunchFileDir(Substitution):
    """The folder of the launch file."""

    def perform(self, context: LaunchContext) -> str:
        if not context.current_file:
            raise SubstitutionFailure(
                "ThisLaunchFileDir used outside of a launch file (in a script)"
            )
        return str(Path(context.current_file).parent)

    def describe(self) -> str:
        return "$(dirname)"


class FindPackagePrefix(Substitution):
    """The folder into which a package is installed."""

    def __init__(self, package: SomeText) -> None:
        super().__init__()
        self.package = to_texts(package)

    def perform(self, context: LaunchContext) -> str:
        return str(self.found(context))

    def found(self, context: LaunchContext) -> Path:
        """Find the folder.

        Raises:
            SubstitutionFailure: No package has that name.
        """
        name = perform(context, self.package)
        try:
            return context.host.prefix_of(name)
        except PackageNotFoundError as error:
            raise SubstitutionFailure(_no_package(name)) from error

    def describe(self) -> str:
        return f"$(find-pkg-prefix {described(self.package)})"


class FindPackageShare(FindPackagePrefix):
    """The folder of a package's files: where `share/NAME` would be."""

    def found(self, context: LaunchContext) -> Path:
        name = perform(context, self.package)
        try:
            return context.host.share_of(name)
        except PackageNotFoundError as error:
            raise SubstitutionFailure(_no_package(name)) from error

    def describe(self) -> str:
        return f"$(find-pkg-share {described(self.package)})"


class FindPackage(FindPackagePrefix):
    """As FindPackagePrefix."""


class ExecutableInPackage(Substitution):
    """The path of an executable of a package."""

    def __init__(self, executable: SomeText, package: SomeText) -> None:
        super().__init__()
        self.executable, self.package = to_texts(executable), to_texts(package)

    def perform(self, context: LaunchContext) -> str:
        package, name = perform(context, self.package), perform(context, self.executable)
        return str(FindPackagePrefix(package).found(context) / "lib" / package / name)

    def describe(self) -> str:
        return f"$(exec-in-pkg {described(self.executable)} {described(self.package)})"


def _no_package(name: str) -> str:
    return (
        f"package '{name}' was not found: open the workspace that holds it, or give --package-path"
    )


class LocalSubstitution(Substitution):
    """A value of the context, such as that of an event while its handler runs."""

    def __init__(self, expression: str, description: str | None = None) -> None:
        super().__init__()
        self.expression, self.description = expression, description

    def perform(self, context: LaunchContext) -> str:
        found: Any = context.locals
        try:
            for step in self.expression.split("."):
                found = getattr(found, step)
        except AttributeError as error:
            if context.host.plans:
                return f"$(unsupported {self.expression})"
            raise SubstitutionFailure(f"'{self.expression}' is not known here") from error
        return str(found)

    def describe(self) -> str:
        return f"$(local {self.expression})"


class AnonName(Substitution):
    """A name with something random behind it, the same one for the same name."""

    def __init__(self, name: SomeText) -> None:
        super().__init__()
        self.name = to_texts(name)

    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        key = f"anon{name}"
        if key not in context.launch_configurations:
            number = len(context.launch_configurations)
            context.launch_configurations[key] = f"{name}_{os.getpid()}_{number}"
        return str(context.launch_configurations[key])

    def describe(self) -> str:
        return f"$(anon {described(self.name)})"


class FileContent(Substitution):
    """The text of a file."""

    def __init__(self, path: SomeText) -> None:
        super().__init__()
        self.path = to_texts(path)

    def perform(self, context: LaunchContext) -> str:
        path = perform(context, self.path)
        if is_unknown(path):
            return f"$(unsupported file-content {path.translate({40: '[', 41: ']'})})"
        try:
            with Path(path).open("rb") as file:
                data = file.read(_FILE_MAX_BYTES + 1)
        except OSError as error:
            raise SubstitutionFailure(f"{path} cannot be read ({error.strerror})") from error
        if len(data) > _FILE_MAX_BYTES:
            raise SubstitutionFailure(f"{path} is larger than {_FILE_MAX_BYTES >> 20} MB")
        context.host.note_file(path)
        return data.decode(errors="replace")

    def describe(self) -> str:
        return f"$(file-content {described(self.path)})"


def truth_of(text: str) -> bool:
    """Return the truth of a text as conditions take it.

    Raises:
        SubstitutionFailure: It is none.
    """
    value = text.strip().lower()
    if value in ("true", "1", "yes", "on"):
        return True
    if value in ("false", "0", "no", "off"):
        return False
    raise SubstitutionFailure(f"'{text}' is no truth: true or false is expected")


class BooleanSubstitution(Substitution):
    """`true` or `false`."""

    def __init__(self, value: SomeText) -> None:
        super().__init__()
        self.value = to_texts(value)

    def perform(self, context: LaunchContext) -> str:
        text = perform(context, self.value)
        return text if is_unknown(text) else str(truth_of(text)).lower()


class _OfSeveral(Substitution):
    """A truth of several texts; unknown where a text is."""

    word = ""

    def __init__(self, *values: SomeText) -> None:
        super().__init__()
        self.values = [to_texts(one) for one in values]

    def perform(self, context: LaunchContext) -> str:
        texts = [perform(context, one) for one in self.values]
        unknown = [text for text in texts if is_unknown(text)]
        return unknown[0] if unknown else str(self.truth(texts)).lower()

    def truth(self, texts: list[str]) -> bool:
        """Return the truth of texts that are all known."""
        raise NotImplementedError(texts)

    def describe(self) -> str:
        return f"$({self.word} {' '.join(described(one) for one in self.values)})"


class NotSubstitution(_OfSeveral):
    """True where its text is false."""

    word = "not"

    def __init__(self, value: SomeText) -> None:
        super().__init__(value)

    def truth(self, texts: list[str]) -> bool:
        return not truth_of(texts[0])


class AndSubstitution(_OfSeveral):
    """True where both are."""

    word = "and"

    def __init__(self, left: SomeText, right: SomeText) -> None:
        super().__init__(left, right)

    def truth(self, texts: list[str]) -> bool:
        return all(map(truth_of, texts))


class OrSubstitution(_OfSeveral):
    """True where one of both is."""

    word = "or"

    def __init__(self, left: SomeText, right: SomeText) -> None:
        super().__init__(left, right)

    def truth(self, texts: list[str]) -> bool:
        return any(map(truth_of, texts))


class AnySubstitution(_OfSeveral):
    """True where one is."""

    word = "any"

    def truth(self, texts: list[str]) -> bool:
        return any(map(truth_of, texts))


class AllSubstitution(_OfSeveral):
    """True where all are."""

    word = "all"

    def truth(self, texts: list[str]) -> bool:
        return all(map(truth_of, texts))


class EqualsSubstitution(_OfSeveral):
    """True where both are the same: as truths, as numbers, or as texts."""

    word = "equals"

    def __init__(self, left: object, right: object) -> None:
        super().__init__(*(_text(one) for one in (left, right)))

    def truth(self, texts: list[str]) -> bool:
        left, right = (_plain(text) for text in texts)
        if isinstance(left, float) and isinstance(right, float):
            return math.isclose(left, right)
        return left == right


class NotEqualsSubstitution(EqualsSubstitution):
    """True where both differ."""

    word = "not-equals"

    def truth(self, texts: list[str]) -> bool:
        return not super().truth(texts)


def _text(value: object) -> object:
    return "" if value is None else str(value) if isinstance(value, bool | int | float) else value


def _plain(text: str) -> object:
    lower = text.strip().lower()
    if lower in ("true", "false"):
        return lower
    try:
        return float(text)
    except ValueError:
        return text


class IfElseSubstitution(Substitution):
    """One of two texts, by a truth."""

    def __init__(
        self, condition: SomeText, if_value: SomeText = "", else_value: SomeText = ""
    ) -> None:
        super().__init__()
        self.condition = to_texts(condition)
        self.if_value, self.else_value = to_texts(if_value), to_texts(else_value)

    def perform(self, context: LaunchContext) -> str:
        text = perform(context, self.condition)
        if is_unknown(text):
            return text
        return perform(context, self.if_value if truth_of(text) else self.else_value)

    def describe(self) -> str:
        parts = (self.condition, self.if_value, self.else_value)
        return f"$(if {' '.join(described(one) for one in parts)})"


class StringJoinSubstitution(Substitution):
    """Texts with a delimiter between them."""

    def __init__(self, substitutions: Iterable[SomeText], delimiter: SomeText = "") -> None:
        super().__init__()
        self.substitutions = [to_texts(one) for one in substitutions]
        self.delimiter = to_texts(delimiter)

    def perform(self, context: LaunchContext) -> str:
        parts = [perform(context, one) for one in self.substitutions]
        return perform(context, self.delimiter).join(parts)


class ParameterSubstitution(Substitution):
    """A parameter that SetParameter set: `$(param NAME)`."""

    def __init__(self, name: SomeText) -> None:
        super().__init__()
        self.name = to_texts(name)

    def perform(self, context: LaunchContext) -> str:
        name = perform(context, self.name)
        for kind, found in reversed(context.global_parameters):
            if kind == name:
                return str(found)
        raise SubstitutionFailure(f"parameter '{name}' is not set by SetParameter before")

    def describe(self) -> str:
        return f"$(param {described(self.name)})"


class ForLoopIndex(LaunchConfiguration):
    """The number of the round of a ForLoop."""


def value_of_yaml(text: str) -> Any:
    """Return what YAML makes of a text: how launch guesses the type of a parameter.

    Raises:
        yaml.YAMLError: It is no YAML.
    """
    return yaml.load(text, Loader=getattr(yaml, "CSafeLoader", yaml.SafeLoader))


__all__ = ["SomeText", "Substitution", "TextSubstitution"]
