"""XML and YAML as elements: without entities, aliases or anything that grows."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Any, Final, NoReturn, cast
from xml.parsers import expat

import yaml
from yaml.composer import ComposerError

from studio.errors import LaunchFileError
from studio.launch.plan import Where

ELEMENTS_MAX: Final = 50_000
DEPTH_MAX: Final = 100
_LISTS: Final = frozenset((
    "param", "remap", "env", "arg", "let", "choice", "composable_node", "extra_arg", "keep",
    "node", "group", "include", "executable", "set_env", "unset_env", "timer", "log",
    "push_ros_namespace", "push-ros-namespace", "set_parameter", "set_remap",
    "load_composable_node", "node_container", "for",
))  # fmt: skip
"""Keys of YAML whose values are elements, not attributes."""


@dataclass(slots=True)
class Element:
    """A tag with its attributes, and what stands in it.

    An XML attribute is a text; YAML's may be typed. `children` are elements of any tag.
    """

    tag: str
    where: Where
    attributes: dict[str, Any] = field(default_factory=dict[str, Any])
    children: list[Element] = field(default_factory=list["Element"])
    used: set[str] = field(default_factory=set[str])

    def get(self, name: str) -> Any:
        """Return an attribute, None without; it counts as read."""
        self.used.add(name)
        return self.attributes.get(name)

    def of(self, *tags: str) -> list[Element]:
        """Return the children of these tags."""
        return [one for one in self.children if one.tag in tags]


def read_xml(path: str, data: bytes) -> Element:
    """Read an XML launch file.

    Raises:
        LaunchFileError: It is no XML, declares an entity, or is too large.
    """
    return _XmlReader(path).read(data)


class _XmlReader:
    def __init__(self, path: str) -> None:
        self._path = path
        self._parser = expat.ParserCreate()
        self._parser.StartElementHandler = self._start
        self._parser.EndElementHandler = self._end
        self._parser.EntityDeclHandler = self._refuse
        self._open: list[Element] = []
        self._root: Element | None = None
        self._count = 0

    def read(self, data: bytes) -> Element:
        try:
            self._parser.Parse(data, True)  # noqa: FBT003
        except expat.ExpatError as error:
            reason = f"it is no XML ({expat.ErrorString(error.code)}): mend it there"
            raise LaunchFileError(self._path, error.lineno, reason) from None
        except ValueError as error:
            raise LaunchFileError(self._path, 0, f"it is no XML ({error})") from None
        assert self._root is not None  # expat refuses a text without an element
        return self._root

    def _start(self, tag: str, attributes: dict[str, str]) -> None:
        self._count += 1
        line = self._parser.CurrentLineNumber
        if self._count > ELEMENTS_MAX or len(self._open) > DEPTH_MAX:
            reason = f"it has more than {ELEMENTS_MAX} elements, or more than {DEPTH_MAX} levels"
            raise LaunchFileError(self._path, line, reason)
        one = Element(tag, Where(self._path, line), dict[str, Any](attributes))
        if self._open:
            self._open[-1].children.append(one)
        else:
            self._root = one
        self._open.append(one)

    def _end(self, _tag: str) -> None:
        self._open.pop()

    def _refuse(self, name: str, *_: object) -> NoReturn:
        raise LaunchFileError(
            self._path,
            self._parser.CurrentLineNumber,
            f'it declares the entity "{name}", which is not read: write its text out',
        )


class _Loader(yaml.SafeLoader):
    """YAML without references: they make a short text as large as one likes."""

    def compose_node(self, parent: Any, index: Any) -> Any:
        if self.check_event(yaml.AliasEvent):  # pyright: ignore[reportUnknownMemberType]
            event = self.peek_event()  # pyright: ignore
            raise ComposerError(
                None, None, "it refers to another part of it (*), which is not read: write it out",
                event.start_mark,  # pyright: ignore
            )  # fmt: skip
        return super().compose_node(parent, index)  # pyright: ignore


def read_yaml(path: str, data: bytes) -> Element:
    """Read a YAML launch file.

    Raises:
        LaunchFileError: It is no YAML, refers to parts of itself, or is no launch file.
    """
    try:
        loader = _Loader(data.decode())
        node = cast("yaml.Node | None", loader.get_single_node())  # pyright: ignore
    except yaml.MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        line = mark.line + 1 if mark else 0
        reason = f"it is no YAML that is read ({error.problem or error.context})"
        raise LaunchFileError(path, line, reason) from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:
        reason = f"it is no YAML that is read ({' '.join(str(error).split()) or 'too deep'})"
        raise LaunchFileError(path, 0, reason) from None
    reader = _YamlReader(path, loader)
    return reader.root(node)


class _YamlReader:
    def __init__(self, path: str, loader: _Loader) -> None:
        self._path, self._loader, self._count = path, loader, 0

    def root(self, node: yaml.Node | None) -> Element:
        if not isinstance(node, yaml.MappingNode) or len(node.value) != 1:
            self._fail(node, "it must begin with launch: and a list below it")
        key, value = node.value[0]
        root = Element(str(key.value), self._at(key))
        self._fill(root, value)
        return root

    def _fill(self, element: Element, node: yaml.Node) -> None:
        if isinstance(node, yaml.SequenceNode):
            for one in node.value:
                element.children += self._elements(one)
        elif isinstance(node, yaml.MappingNode):
            for key, value in node.value:
                self._attribute(element, str(key.value), value)
        elif node.value not in ("", "null", "~"):
            self._fail(node, f"{element.tag} needs names with values below it")

    def _attribute(self, element: Element, key: str, value: yaml.Node) -> None:
        is_list = isinstance(value, yaml.SequenceNode)
        if key == "children" and is_list:
            for one in value.value:
                element.children += self._elements(one)
        elif key in _LISTS and is_list:
            for one in value.value:
                child = self._new(key, one)
                self._fill(child, one)
                element.children.append(child)
        else:
            element.attributes[key] = self._loader.construct_object(value, deep=True)  # pyright: ignore

    def _elements(self, node: yaml.Node) -> list[Element]:
        if not isinstance(node, yaml.MappingNode):
            self._fail(node, "an action is expected here, such as node: with its names below")
        found: list[Element] = []
        for key, value in node.value:
            child = self._new(str(key.value), key)
            self._fill(child, value)
            found.append(child)
        return found

    def _new(self, tag: str, node: yaml.Node) -> Element:
        self._count += 1
        if self._count > ELEMENTS_MAX:
            self._fail(node, f"it has more than {ELEMENTS_MAX} elements")
        return Element(tag, self._at(node))

    def _at(self, node: yaml.Node) -> Where:
        return Where(self._path, node.start_mark.line + 1)

    def _fail(self, node: yaml.Node | None, reason: str) -> NoReturn:
        line = node.start_mark.line + 1 if node is not None else 0
        raise LaunchFileError(self._path, line, reason)
