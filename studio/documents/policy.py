"""What the xacro worker of a document may read: derived from where the document was opened."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING

from studio.description.values import ReadPolicy
from studio.documents.edit_loop import Target
from studio.settings import XACRO_ENVIRONMENT

if TYPE_CHECKING:
    from studio.packages.workspace import Location


def target_of(location: Location, *, trusted: bool) -> Target:
    """The entry file of a location that has one, and the rules its expansion runs under.

    Trust shows the files the whole environment, and nothing else: expressions stay bounded, and
    what may be read is what is served. What came in an archive is never trusted.
    """
    assert location.entry is not None
    trusted = trusted and not location.is_unpacked
    environment = {
        name: value for name, value in os.environ.items() if trusted or name in XACRO_ENVIRONMENT
    }
    policy = ReadPolicy(
        roots=tuple(map(str, location.served.all)),
        packages=location.index.mapping_for(location.entry),
        environment=environment,
        trusted=trusted,
    )
    return Target(str(location.entry), policy)
