"""Options of how a bag is stored, named as ros2 names them, and what they come to."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any, Final, cast

from studio.errors import SettingsError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from studio.bags.mcap_writer import ChunkCompression, Chunking
    from studio.bags.writer import Storing

STORAGES: Final = ("mcap", "sqlite3")
"""Those of `bags.writer`, which takes its time to import; the first is the usual one."""
_ZSTD_LEVELS: Final[Mapping[str, int]] = {
    "Fastest": -5, "Fast": -3, "Default": 1, "Slow": 5, "Slowest": 19,
}  # fmt: skip
"""Levels of zstd's by the names of rosbag2's mcap storage."""
_PRESETS: Final = ("none", "fastwrite", "zstd_fast", "zstd_small", "resilient")
_COMPRESSIONS: Final[Mapping[str, ChunkCompression]] = {"None": "", "Zstd": "zstd", "Lz4": "lz4"}
_CHUNK_BYTES_MAX: Final = 1024**3


def add_storing_options(parser: argparse.ArgumentParser) -> None:
    """Add them."""
    group = parser.add_argument_group("how it is stored")
    group.add_argument("-s", "--storage", choices=STORAGES, default=STORAGES[0])
    group.add_argument(
        "-b", "--max-bag-size", type=int, default=0, metavar="BYTES", help="then another file"
    )
    group.add_argument(
        "-d", "--max-bag-duration", type=int, default=0, metavar="SECONDS",
        help="then another file",
    )  # fmt: skip
    group.add_argument(
        "--max-bag-files", type=int, default=0, metavar="N", help="remove the oldest beyond these"
    )
    group.add_argument("--compression-mode", choices=("none", "file", "message"), default="none")
    group.add_argument("--compression-format", choices=("", "zstd"), default="", metavar="zstd")
    group.add_argument(
        "--storage-preset-profile", choices=_PRESETS, default="none", metavar="PRESET",
        help="mcap: zstd_fast, zstd_small, fastwrite; sqlite3: resilient",
    )  # fmt: skip
    group.add_argument(
        "--storage-config-file", type=Path, metavar="FILE",
        help="YAML for mcap: chunkSize, compression, compressionLevel, noChunkCRC",
    )  # fmt: skip
    group.add_argument("--custom-data", nargs="*", default=[], metavar="KEY=VALUE")
    group.add_argument(
        "-f", "--serialization-format", choices=("", "cdr"), default="", help=argparse.SUPPRESS
    )


def storing_of(options: argparse.Namespace) -> Storing:
    """Read the options.

    Raises:
        SettingsError: They do not go together; the sentence says which.
    """
    from studio.bags.writer import Storing

    for name in ("max_bag_size", "max_bag_duration", "max_bag_files"):
        if getattr(options, name) < 0:
            raise SettingsError(f"--{name.replace('_', '-')}: give 0 or more.")
    if options.compression_format and options.compression_mode == "none":
        raise SettingsError("--compression-format is that of --compression-mode file or message.")
    made = Storing(
        storage=options.storage,
        chunking=_chunking(options),
        mode=options.compression_mode,
        max_bytes=options.max_bag_size,
        max_s=options.max_bag_duration,
        max_files=options.max_bag_files,
        resilient=options.storage_preset_profile == "resilient",
        custom_data=dict(_pair(one) for one in options.custom_data),
    )
    made.check()
    return made


def _pair(text: str) -> tuple[str, str]:
    key, _, value = text.partition("=")
    if not key:
        raise SettingsError(f'--custom-data "{text[:80]}": give KEY=VALUE.')
    return key, value


def _chunking(options: argparse.Namespace) -> Chunking:
    from studio.bags.mcap_writer import Chunking

    preset, file = options.storage_preset_profile, options.storage_config_file
    if (preset == "resilient") != (options.storage == "sqlite3") and preset != "none":
        raise SettingsError(f"--storage-preset-profile {preset} is none of {options.storage}.")
    if file is not None and options.storage != "mcap":
        raise SettingsError("--storage-config-file is read for mcap alone: leave it out.")
    if file is not None:
        return _configured(file)
    if preset == "zstd_fast":
        return Chunking(compression="zstd", level=_ZSTD_LEVELS["Fastest"], with_crc=False)
    if preset == "zstd_small":
        return Chunking(bytes=4 * 1024 * 1024, compression="zstd", level=_ZSTD_LEVELS["Slowest"])
    return Chunking(with_crc=preset != "fastwrite")


def _configured(file: Path) -> Chunking:
    """Read a file of rosbag2's for its mcap storage.

    Raises:
        SettingsError: It is none, or asks for what is not offered; the sentence names the key.
    """
    from studio.bags.mcap_writer import Chunking
    from studio.ros.types.yaml_texts import read_yaml

    try:
        found = read_yaml(file.read_text(encoding="utf-8"), str(file))
    except (OSError, ValueError) as error:
        raise SettingsError(f"{file} cannot be used: {error}.") from None
    if not isinstance(found, dict):
        raise SettingsError(f"{file} cannot be used: give keys such as compression: Zstd.")
    given = dict(cast("dict[str, Any]", found))
    size = given.pop("chunkSize", 1024 * 1024)
    if not isinstance(size, int) or not 1 <= size <= _CHUNK_BYTES_MAX:
        raise SettingsError(f"{file}: chunkSize is from 1 to {_CHUNK_BYTES_MAX} bytes.")
    chunking = Chunking(
        bytes=size,
        compression=_one_of(file, given, "compression", "None", _COMPRESSIONS),
        level=_one_of(file, given, "compressionLevel", "Default", _ZSTD_LEVELS),
        with_crc=not given.pop("noChunkCRC", False),
    )
    for key, value in given.items():
        if value:
            raise SettingsError(f"{file}: {key} is not offered here: leave it out.")
    return chunking


def _one_of(
    file: Path, given: dict[str, Any], key: str, default: str, values: Mapping[str, Any]
) -> Any:  # noqa: ANN401 - one of the values
    name = str(given.pop(key, default))
    if name not in values:
        raise SettingsError(f"{file}: {key} is one of {', '.join(values)}.")
    return values[name]
