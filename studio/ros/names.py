"""Names of ROS 2: what rcl and rosidl allow, and how a short name becomes a full one."""

from __future__ import annotations

import re

from studio.errors import NamespaceError, NodeNameError, RosNameError, TopicNameError

NODE_NAME_CHARACTERS_MAX = 255
NAMESPACE_CHARACTERS_MAX = 245
TOPIC_NAME_CHARACTERS_MAX = 247

_ACTION = "/_action/"
_PART = re.compile(r"[A-Za-z_][A-Za-z0-9_]*", re.ASCII)
_SUBSTITUTION = re.compile(r"\{([^{}]*)\}")
_PACKAGE = re.compile(r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*", re.ASCII)
_TYPE = re.compile(r"[A-Z][A-Za-z0-9]*", re.ASCII)
_PARTS_OF_TYPES = {
    "msg": "",
    "srv": "Request|Response|Event",
    "action": "Goal|Result|Feedback|FeedbackMessage"
    "|(?:SendGoal|GetResult)(?:_(?:Request|Response|Event))?",
}
KINDS = tuple(_PARTS_OF_TYPES)
INTERFACES_VARIABLE = "STUDIO_INTERFACES"
"""The variable that names paths, as in PATH, whose types every node of the process knows."""


def check_node_name(name: str) -> str:
    """Return the name of a node, without its namespace.

    Raises:
        RosNameError: rcl would refuse it.
    """
    _check_length(name, NODE_NAME_CHARACTERS_MAX, NodeNameError)
    if not name:
        raise NodeNameError(name, "a node needs a name")
    _check_part(name, name, NodeNameError)
    return name


def check_namespace(namespace: str) -> str:
    """Return a namespace, which begins with a slash and ends with none unless it is `/`.

    Raises:
        RosNameError: rcl would refuse it.
    """
    _check_length(namespace, NAMESPACE_CHARACTERS_MAX, NamespaceError)
    if not namespace.startswith("/"):
        raise NamespaceError(namespace, "a namespace begins with a slash")
    if namespace != "/":
        _check_parts(namespace, namespace[1:], NamespaceError)
    return namespace


def as_namespace(text: str) -> str:
    """Make a namespace of what a user writes: empty is `/`, and a missing first slash is added."""
    return check_namespace(text if text.startswith("/") else f"/{text}")


def check_topic_name(name: str) -> str:
    """Return the name of a topic, service or action: absolute, relative or private with `~`.

    Raises:
        RosNameError: rcl would refuse it.
    """
    if not name:
        raise TopicNameError(name, "a topic needs a name")
    _check_length(name, TOPIC_NAME_CHARACTERS_MAX)
    rest = name.removeprefix("~")
    if rest != name and rest and not rest.startswith("/"):
        raise TopicNameError(name, "a slash follows ~")
    body = rest.removeprefix("/")
    if body or rest:
        _check_parts(name, _SUBSTITUTION.sub(lambda found: _known(name, found[1]), body))
    return name


def expand(name: str, namespace: str = "/", node: str = "node") -> str:
    """Make the fully qualified name of a topic, service or action of a node, nothing remapped.

    Raises:
        RosNameError: A name breaks a rule, also after `{node}` and `{ns}` were put in.
    """
    check_topic_name(name)
    values = {
        "node": check_node_name(node),
        "ns": check_namespace(namespace),
        "namespace": namespace,
    }
    filled = _SUBSTITUTION.sub(lambda found: values[found[1]].removeprefix("/"), name)
    if name.startswith(("{ns}", "{namespace}")):
        filled = "/" + filled.removeprefix("/")
    if filled.startswith("~"):
        filled = node_path(namespace, node) + filled[1:]
    elif not filled.startswith("/"):
        filled = f"{namespace.rstrip('/')}/{filled}"
    return check_full_name(filled)


def check_full_name(name: str) -> str:
    """Return a fully qualified name.

    Raises:
        RosNameError: It is not absolute, or a part of it breaks a rule.
    """
    _check_length(name, TOPIC_NAME_CHARACTERS_MAX)
    if not name.startswith("/"):
        raise TopicNameError(name, "a fully qualified name begins with a slash")
    _check_parts(name, name[1:])
    return name


def node_path(namespace: str, node: str) -> str:
    """Join a namespace and the name of a node: `/` and `talker` to `/talker`."""
    return f"{namespace.rstrip('/')}/{node}"


def logger_name(path: str) -> str:
    """Name the logger of a node by its path: `/ns/talker` to `ns.talker`."""
    return path.strip("/").replace("/", ".")


def action_part(action: str, part: str) -> str:
    """Return the full name of a part of an action, as `/turn/_action/feedback`."""
    return f"{action}{_ACTION}{part}"


def split_action_part(name: str) -> tuple[str, str] | None:
    """Return the action and the part, `/turn` and `feedback`; None: the name is none of a part."""
    action, _, part = name.rpartition(_ACTION)
    return (action, part) if action and part else None


def is_hidden(name: str) -> bool:
    """Whether a part of the name begins with an underscore, as `/turn/_action/feedback` does."""
    return any(part.startswith("_") for part in name.split("/"))


def check_package_name(name: str) -> str:
    """Return the name of a package of interfaces.

    Raises:
        RosNameError: rosidl would refuse it.
    """
    if not _PACKAGE.fullmatch(name):
        raise RosNameError(
            name, "a package is named in lower case letters, digits and single underscores"
        )
    return name


def split_type_name(name: str) -> tuple[str, str, str]:
    """Part `std_msgs/msg/String` into package, kind and type; parts as `Turn_Goal` are types too.

    Raises:
        RosNameError: It is no full name of a type.
    """
    package, kind, base = name.split("/") if name.count("/") == 2 else ("", "", "")
    if kind not in _PARTS_OF_TYPES:
        raise RosNameError(
            name, "a type is named package/msg/Type, package/srv/Type or package/action/Type"
        )
    check_package_name(package)
    stem, _, part = base.partition("_")
    if not _TYPE.fullmatch(stem) or (
        "_" in base and not re.fullmatch(_PARTS_OF_TYPES[kind] or r"(?!)", part)
    ):
        raise RosNameError(name, "a type is named in letters and digits, the first a capital")
    return package, kind, base


def full_type_name(name: str, kind: str = "msg") -> str:
    """Complete what users write: `std_msgs/String` or `std_msgs.msg.String`.

    Raises:
        RosNameError: It names no type; what was written is quoted.
    """
    parts = re.split(r"[./]", name)
    if len(parts) > 1 and parts[-1] in KINDS and parts[-2][:1].isupper():
        *folders, base, ending = parts
        full = "/".join(folders if len(folders) > 1 else [*(folders or ["package"]), ending])
        raise RosNameError(name, f"a type has no .{ending} at its end, write {full}/{base}")
    if len(parts) == 2:
        parts.insert(1, kind)
    full = "/".join(parts)
    try:
        split_type_name(full)
    except RosNameError as error:
        raise RosNameError(name, error.reason) from None
    return full


def _known(name: str, substitution: str) -> str:
    if substitution not in {"node", "ns", "namespace"}:
        raise TopicNameError(name, "only {node}, {ns} and {namespace} are filled in")
    return "x"


def _check_parts(name: str, body: str, error: type[RosNameError] = TopicNameError) -> None:
    for part in body.split("/"):
        if not part:
            raise error(name, "no slash stands at the end or beside another one")
        _check_part(name, part, error)


def _check_part(name: str, part: str, error: type[RosNameError] = TopicNameError) -> None:
    if part[0].isdigit():
        raise error(name, f'no part begins with a digit, as "{part}" does')
    if not _PART.fullmatch(part):
        raise error(name, f'only a-z, A-Z, 0-9 and _ are allowed, "{part}" has others')


def _check_length(
    name: str, characters_max: int, error: type[RosNameError] = TopicNameError
) -> None:
    if len(name) > characters_max:
        raise error(name, f"it is longer than {characters_max} characters")
