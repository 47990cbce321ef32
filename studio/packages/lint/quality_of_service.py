"""Checks of QoS between nodes of a workspace: what one asks, and the other offers."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final

from studio.packages.lint.checked import WARNING, found
from studio.packages.sources.topic_ends import topic_ends

if TYPE_CHECKING:
    from collections.abc import Iterator

    from studio.packages.lint.checked import CheckedPackage
    from studio.problems import Problem


def findings(checked: CheckedPackage) -> Iterator[Problem]:
    """Yield subscriptions that can get nothing of a publisher of their topic."""
    publishers = checked.workspace.publishers
    asked = (one for python in checked.python_files for one in topic_ends(python))
    for one in asked:
        if one.publishes:
            continue
        for publisher in publishers.get(one.topic, ()):
            what = ""
            if one.is_reliable and not publisher.is_reliable:
                what = "reliable delivery, and the publisher offers best effort"
            elif one.is_latched and not publisher.is_latched:
                what = "transient local durability, and the publisher offers volatile"
            if what:
                at = one.python.span(one.call)[0]
                where = publisher.python.source.place(publisher.python.span(publisher.call)[0])
                file = where.file.rpartition("/")[2]
                sentence = (
                    f"This subscription of {one.topic} asks for {what} ({file}, "
                    f"line {where.line}): no message comes through."
                )
                yield found(WARNING, "qos-mismatch", sentence, one.python.source, at)
                break


WHY: Final = {
    "qos-mismatch": {
        "en": "A subscription must not ask for more than its publisher offers. DDS connects them "
        "then not at all, without an error; rmw_zenoh may.",
        "de": "Eine Subscription darf nicht mehr verlangen, als der Publisher bietet. DDS "
        "verbindet sie sonst gar nicht, ohne Fehlermeldung; rmw_zenoh vielleicht doch.",
    },
}
"""By code and language: why a finding matters, as the page explains it."""
