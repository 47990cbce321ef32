"""Elements of XML and YAML launch files as actions of the vocabulary."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING, Any, Final, cast

from studio.errors import LaunchFileError, StudioError
from studio.launch.frontends.texts import parse_text
from studio.launch.vocabulary import actions, ros
from studio.launch.vocabulary.conditions import IfCondition, UnlessCondition
from studio.launch.vocabulary.context import current_host
from studio.launch.vocabulary.parameters import ParameterFile, ParameterValue, typed
from studio.launch.vocabulary.places import placed
from studio.launch.vocabulary.processes import ExecuteProcess
from studio.launch.vocabulary.sources import AnyLaunchDescriptionSource
from studio.launch.vocabulary.texts import Substitution, TextSubstitution

if TYPE_CHECKING:
    from collections.abc import Callable

    from studio.launch.frontends.reading import Element

_TYPES: Final[dict[str, Any]] = {
    "int": int, "float": float, "bool": bool, "str": str,
    "list_of_int": list[int], "list_of_float": list[float],
    "list_of_bool": list[bool], "list_of_str": list[str],
}  # fmt: skip
_RESPAWN = ("respawn", "respawn_delay", "respawn_max_retries", "shell", "output", "sigterm_timeout",
            "sigkill_timeout", "emulate_tty")  # fmt: skip


def description_of_root(root: Element) -> actions.LaunchDescription:
    """Return what a launch file describes.

    Raises:
        LaunchFileError: Its root is no `launch`, or an element lacks what it needs.
    """
    if root.tag != "launch":
        raise LaunchFileError(
            root.where.file, root.where.line, f"it begins with {root.tag}: launch is expected"
        )
    with placed(root.where):
        return actions.LaunchDescription(actions_of(root.children))


def actions_of(elements: list[Element]) -> list[Any]:
    """Return the actions of elements, in their order; an unknown one is noted and left out."""
    found: list[Any] = []
    for one in elements:
        if (maker := _MAKERS.get(one.tag)) is None:
            current_host().unsupported(one.tag, _unknown_tag(one), one.where)
            continue
        with placed(one.where):
            try:
                found.append(maker(one))
            except (TypeError, ValueError) as error:
                raise _fault(one, str(error)) from error
            except StudioError as error:
                if isinstance(error, LaunchFileError):
                    raise
                raise _fault(one, str(error)) from error
        for name in sorted(set(one.attributes) - one.used):
            sentence = f'"{name}" of {one.tag} is not known: {_mend(one, name)}'
            current_host().failed(sentence, one.where)
    return found


def _mend(one: Element, name: str) -> str:
    if one.tag in ("node", "executable") and name == "type":
        return "this is a launch file of ROS 1, in ROS 2 write exec="
    if name in ("ns", "machine", "required", "clear_params", "pass_all_args"):
        return "it is of ROS 1" + (", write namespace=" if name == "ns" else "")
    return "it is left out"


def _unknown_tag(one: Element) -> str:
    if one.tag in ("rosparam", "param", "machine", "test", "remap"):
        return f"<{one.tag}> here is of ROS 1: in ROS 2 parameters and remaps stand within a node"
    return f"not supported: {one.tag} is no action that the studio knows, and is left out"


def _fault(one: Element, reason: str) -> LaunchFileError:
    return LaunchFileError(one.where.file, one.where.line, f"{one.tag}: {reason}")


def _need(one: Element, name: str) -> Any:
    value = one.get(name)
    if value is None:
        hint = ""
        if name == "exec" and "type" in one.attributes:
            hint = " (type= is of ROS 1)"
        raise _fault(one, f"it needs {name}={hint}")
    return value


def _text(value: Any) -> list[Substitution]:
    """Return a text with its substitutions; YAML's bools and numbers as it writes them."""
    if isinstance(value, bool):
        return [TextSubstitution(text=str(value).lower())]
    return parse_text(value if isinstance(value, str) else str(value))


def _maybe(one: Element, name: str) -> list[Substitution] | None:
    value = one.get(name)
    return None if value is None else _text(value)


def _condition(one: Element) -> Any:
    holds, fails = one.get("if"), one.get("unless")
    if holds is not None and fails is not None:
        raise _fault(one, "if and unless stand beside each other: use one of them")
    if holds is not None:
        return IfCondition(_text(holds))
    return None if fails is None else UnlessCondition(_text(fails))


def _arg(one: Element) -> Any:
    if "value" in one.attributes:
        one.get("value")
        current_host().failed(
            'arg with value= is of ROS 1: in ROS 2 write <let name="..." value="..."/>', one.where
        )
    choices = [str(_need(choice, "value")) for choice in one.of("choice")]
    return actions.DeclareLaunchArgument(
        str(_need(one, "name")),
        default_value=_maybe(one, "default"),
        description=one.get("description"),
        choices=choices or None,
        condition=_condition(one),
    )


def _let(one: Element) -> Any:
    return actions.SetLaunchConfiguration(
        _text(_need(one, "name")), _text(_need(one, "value")), condition=_condition(one)
    )


def _common(one: Element) -> dict[str, Any]:
    """Return what nodes and executables share."""
    found: dict[str, Any] = {"condition": _condition(one)}
    for name in _RESPAWN:
        value = one.get(name)
        if value is not None:
            found[name] = _text(value)
    for name, word in (("cwd", "cwd"), ("launch-prefix", "prefix"), ("launch_prefix", "prefix")):
        value = one.get(name)
        if value is not None:
            found[word] = _text(value)
    pairs = [(_text(_need(e, "name")), _text(_need(e, "value"))) for e in one.of("env")]
    if pairs:
        found["additional_env"] = _Pairs(pairs)
    on_exit = one.get("on_exit")
    if on_exit == "shutdown":
        found["on_exit"] = actions.Shutdown()
    return found


class _Pairs(dict[Any, Any]):
    """Names and values that are lists of substitutions, which no dict can have as keys."""

    def __init__(self, pairs: list[tuple[Any, Any]]) -> None:
        super().__init__((number, pair) for number, pair in enumerate(pairs))

    def items(self) -> Any:
        return list(self.values())


def _words(one: Element, name: str) -> list[Any] | None:
    """Return a line as words, each with its substitutions."""
    value = one.get(name)
    if value is None:
        return None
    if isinstance(value, list):
        return [_text(word) for word in cast("list[Any]", value)]
    return split_words(_text(value))


def split_words(texts: list[Substitution]) -> list[list[Substitution]]:
    """Part a line at blanks outside of substitutions and quotes."""
    words: list[list[Substitution]] = [[]]
    for one in texts:
        if not isinstance(one, TextSubstitution):
            words[-1].append(one)
            continue
        for number, part in enumerate(_parts(one.text)):
            if number:
                words.append([])
            if part:
                words[-1].append(TextSubstitution(text=part))
    return [word for word in words if word]


def _parts(text: str) -> list[str]:
    try:
        words = shlex.split(text, posix=True)
    except ValueError:  # a quote that is closed behind a substitution
        words = text.split()
    before = [""] if text[:1].isspace() else []
    after = [""] if text[-1:].isspace() and words else []
    return [*before, *words, *after] or [""]


def _remaps(one: Element) -> list[tuple[Any, Any]]:
    return [(_text(_need(r, "from")), _text(_need(r, "to"))) for r in one.of("remap")]


def _parameters(one: Element, tags: tuple[str, ...] = ("param",)) -> list[Any]:
    found: list[Any] = []
    for element in one.of(*tags):
        file = element.get("from")
        if file is not None:
            allowed = element.get("allow_substs")
            found.append(
                ParameterFile(
                    _text(file), allow_substs=False if allowed is None else _text(allowed)
                )
            )
        elif element.children:
            found.append(_nested(element))
        else:
            found.append({str(_need(element, "name")): _value(element)})
        kind = set(element.attributes) - element.used - {"type", "sep", "value-sep"}
        for name in sorted(kind):
            mend = "it is of ROS 1" if name in ("command", "textfile") else "it is left out"
            current_host().failed(f'"{name}" of param is not known: {mend}', element.where)
    return found


def _nested(element: Element) -> dict[str, Any]:
    inner: dict[str, Any] = {}
    for one in element.of("param"):
        inner |= _nested(one) if one.children else {str(_need(one, "name")): _value(one)}
    return {str(_need(element, "name")): inner}


def _value(element: Element) -> Any:
    value = element.get("value")
    if value is None:
        raise _fault(element, "it needs value=, or from= with a file of parameters")
    separator = element.get("value-sep") or element.get("sep")
    kind = _TYPES.get(str(element.get("type") or ""))
    if isinstance(value, str) and separator:
        parts = [part.strip() for part in value.split(str(separator))]
        return [
            typed(part, None, "a parameter") if "$(" not in part else _text(part) for part in parts
        ]
    if isinstance(value, str):
        return ParameterValue(_text(value), value_type=kind)
    if isinstance(value, list):
        values = cast("list[Any]", value)
        return [ParameterValue(_text(v)) if isinstance(v, str) and "$(" in v else v for v in values]
    return value


def _node_words(one: Element) -> dict[str, Any]:
    return {
        "package": _text(_need(one, "pkg")),
        "name": _maybe(one, "name"),
        "namespace": _maybe(one, "namespace"),
        "parameters": _parameters(one),
        "remappings": _remaps(one),
    }


def _node(one: Element, kind: type[ros.Node] = ros.Node) -> Any:
    words = _node_words(one)
    executable = _text(_need(one, "exec"))
    return kind(
        executable=executable,
        exec_name=_maybe(one, "exec_name"),
        arguments=_words(one, "args"),
        ros_arguments=_words(one, "ros_args"),
        **words,
        **_common(one),
    )


def _lifecycle(one: Element) -> Any:
    one.get("autostart")
    one.attributes.setdefault("namespace", "")
    return _node(one, ros.LifecycleNode)


def _container(one: Element) -> Any:
    one.attributes.setdefault("namespace", "")
    words = _node_words(one)
    return ros.ComposableNodeContainer(
        executable=_text(_need(one, "exec")),
        arguments=_words(one, "args"),
        composable_node_descriptions=_composables(one),
        **words,
        **_common(one),
    )


def _composables(one: Element) -> list[Any]:
    found: list[Any] = []
    for element in one.of("composable_node"):
        with placed(element.where):
            words = _node_words(element)
            plugin = _text(_need(element, "plugin"))
            found.append(ros.ComposableNode(plugin=plugin, condition=_condition(element), **words))
    return found


def _load(one: Element) -> Any:
    return ros.LoadComposableNodes(
        target_container=_text(_need(one, "target")),
        composable_node_descriptions=_composables(one),
        condition=_condition(one),
    )


def _executable(one: Element) -> Any:
    common = _common(one)
    line = _need(one, "cmd")
    shell = one.attributes.get("shell")
    is_shell = shell is True or str(shell).lower() == "true"
    words = [_text(line)] if is_shell and isinstance(line, str) else _words(one, "cmd")
    words = [*(words or []), *(_words(one, "args") or [])]
    return ExecuteProcess(cmd=words, name=_maybe(one, "name"), **common)


def _include(one: Element) -> Any:
    pairs = [
        (_text(_need(arg, "name")), _text(_need(arg, "value"))) for arg in one.of("arg", "let")
    ]
    return actions.IncludeLaunchDescription(
        AnyLaunchDescriptionSource(_text(_need(one, "file"))),
        launch_arguments=pairs,
        condition=_condition(one),
    )


def _group(one: Element) -> Any:
    scoped, forwarding = one.get("scoped"), one.get("forwarding")
    kept = {str(_need(e, "name")): _text(_need(e, "value")) for e in one.of("keep")}
    return actions.GroupAction(
        actions_of([e for e in one.children if e.tag != "keep"]),
        scoped=_is_true(scoped, default=True),
        forwarding=_is_true(forwarding, default=True),
        launch_configurations=kept,
        condition=_condition(one),
    )


def _is_true(value: Any, *, default: bool) -> bool:
    return default if value is None else str(value).strip().lower() in ("true", "1", "yes", "on")


def _timer(one: Element) -> Any:
    return actions.TimerAction(
        period=_text(_need(one, "period")),
        actions=actions_of(one.children),
        condition=_condition(one),
    )


def _log(one: Element) -> Any:
    text = one.get("message")
    level = _maybe(one, "level") or [TextSubstitution(text="info")]
    text = _need(one, "msg") if text is None else text
    return actions.Log(msg=_text(text), level=level, condition=_condition(one))


def _named(make: Callable[..., Any], *names: str) -> Callable[[Element], Any]:
    """Return a maker whose arguments are attributes, in this order."""

    def maker(one: Element) -> Any:
        return make(*(_text(_need(one, name)) for name in names), condition=_condition(one))

    return maker


def _set_parameter(one: Element) -> Any:
    return ros.SetParameter(_text(_need(one, "name")), _value(one), condition=_condition(one))


def _shutdown(one: Element) -> Any:
    reason = _maybe(one, "reason") or [TextSubstitution(text="reason not given")]
    return actions.Shutdown(reason=reason, condition=_condition(one))


def _reset(one: Element) -> Any:
    kept = {str(_need(e, "name")): _text(_need(e, "value")) for e in one.of("keep")}
    return actions.ResetLaunchConfigurations(kept, condition=_condition(one))


def _namespace(one: Element) -> Any:
    return ros.PushRosNamespace(_text(_need(one, "namespace")), condition=_condition(one))


def _append_env(one: Element) -> Any:
    return actions.AppendEnvironmentVariable(
        _text(_need(one, "name")),
        _text(_need(one, "value")),
        prepend=_is_true(one.get("prepend"), default=False),
        separator=str(one.get("separator") or ":"),
        condition=_condition(one),
    )


def _for(one: Element) -> Any:
    kept = one.children
    variables = [str(_need(e, "name")) for e in one.of("var")]

    def once(**values: str) -> list[Any]:
        sets = [actions.SetLaunchConfiguration(name, values.get(name, "")) for name in values]
        inner = actions_of([e for e in kept if e.tag != "var"])
        return [actions.GroupAction([*sets, *inner])]

    once.__doc__ = f"One round, with {variables}."
    return actions.ForLoop(str(_need(one, "values")), function=once, condition=_condition(one))


_MAKERS: Final[dict[str, Callable[[Element], Any]]] = {
    "arg": _arg,
    "let": _let,
    "node": _node,
    "lifecycle_node": _lifecycle,
    "node_container": _container,
    "load_composable_node": _load,
    "executable": _executable,
    "include": _include,
    "group": _group,
    "timer": _timer,
    "ros_timer": _timer,
    "log": _log,
    "set_env": _named(actions.SetEnvironmentVariable, "name", "value"),
    "unset_env": _named(actions.UnsetEnvironmentVariable, "name"),
    "append_env": _append_env,
    "push_ros_namespace": _namespace,
    "push-ros-namespace": _namespace,
    "set_remap": _named(ros.SetRemap, "from", "to"),
    "set_parameter": _set_parameter,
    "set_parameters_from_file": _named(ros.SetParametersFromFile, "filename"),
    "set_use_sim_time": _named(ros.SetUseSimTime, "value"),
    "shutdown": _shutdown,
    "reset": _reset,
    "push_env": lambda _: actions.PushEnvironment(),
    "pop_env": lambda _: actions.PopEnvironment(),
    "for_each": _for,
}
"""By the tag."""
