"""`studio bag reindex`: write the `metadata.yaml` of a bag anew, by what its files hold."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from studio.cli.bag_storing import STORAGES
from studio.cli.terminal import shown

if TYPE_CHECKING:
    import argparse

    from studio.cli.verbs import Verbs


def add(verbs: Verbs) -> None:
    """Add the verb."""
    reindex = verbs.add(
        "reindex",
        _run,
        "write the metadata of a bag anew, as after a recording that was cut off",
        "The files of messages stay as they are; a whole copy of damaged ones is made by "
        "studio bag cut.",
    )
    reindex.add_argument("bag", type=Path, help="its folder")
    reindex.add_argument("-s", "--storage", choices=STORAGES, help="of its files")


def _run(options: argparse.Namespace) -> int:
    from studio.bags.metadata import METADATA_NAME
    from studio.bags.metadata_text import metadata_text
    from studio.bags.opening import open_bag
    from studio.errors import BagNotWrittenError
    from studio.files import is_folder, write_whole

    folder: Path = options.bag
    if not is_folder(folder):
        raise BagNotWrittenError(str(folder), "metadata stands in the folder of a bag: name that")
    bag = open_bag(folder, by_files=True)
    try:
        if options.storage not in {None, bag.storage}:
            raise BagNotWrittenError(
                str(folder), f"its files are of {bag.storage}, and not of {options.storage}"
            )
        lost = [one for one in bag.troubles if METADATA_NAME not in one]
        for trouble in lost:
            print(shown(f"WARNING: {trouble}"), file=sys.stderr)
        try:
            write_whole(folder / METADATA_NAME, metadata_text(bag.description()).encode())
        except OSError as error:
            raise BagNotWrittenError(str(folder), error.strerror or str(error)) from None
        files = f"{len(bag.files)} file{'s' if len(bag.files) != 1 else ''}"
        print(shown(f"{folder / METADATA_NAME}: {bag.message_count} messages in {files}."))
        if lost:
            print(shown(f"A whole copy of what is left: studio bag cut {folder} NEW_FOLDER"))
    finally:
        bag.close()
    return 0
