"""Where an included launch file lies, and of which kind it is."""

from __future__ import annotations

from typing import Any

from studio.launch.vocabulary.places import here
from studio.launch.vocabulary.texts import SomeText, to_texts


class LaunchDescriptionSource:
    """A launch file by its path, or a description that is there already."""

    kind = ""
    """`python`, `xml`, `yaml`, or empty: as the file's name says."""

    def __init__(
        self, location: SomeText = "", *, launch_description: Any = None, method: str = "", **_: Any
    ) -> None:
        self.where = here()
        if launch_description is None and not isinstance(location, str | list | tuple):
            description = getattr(location, "entities", None)
            launch_description = location if description is not None else None
        self.launch_description = launch_description
        self.location = [] if launch_description is not None else to_texts(location)
        self.method = method

    def get_launch_description(self, context: Any) -> Any:
        """Return the description, read now."""
        from studio.launch.vocabulary.reading import description_of  # noqa: PLC0415

        return description_of(self, context)

    def try_get_launch_description_without_context(self) -> Any:
        return self.launch_description


class PythonLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file in Python."""

    kind = "python"


class FrontendLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file in XML or YAML, as its name says."""

    kind = "frontend"


class XMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """A launch file in XML."""

    kind = "xml"


class YAMLLaunchDescriptionSource(FrontendLaunchDescriptionSource):
    """A launch file in YAML."""

    kind = "yaml"


class AnyLaunchDescriptionSource(LaunchDescriptionSource):
    """A launch file of any kind, as its name says."""


def as_source(source: Any) -> LaunchDescriptionSource:
    """Return a source as it is, and a text or substitution as one of any kind."""
    if isinstance(source, LaunchDescriptionSource):
        return source
    if hasattr(source, "entities"):
        return LaunchDescriptionSource(launch_description=source)
    return AnyLaunchDescriptionSource(source)
