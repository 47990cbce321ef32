"""The requests and answers of the robot worker, packed alike at both ends."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from studio.problems import Problem  # noqa: TC001 - msgspec reads it
from studio.worker_process import Codec


@dataclass(frozen=True, slots=True)
class MeshRequest:
    """Read a mesh and put it into the cache."""

    path: str
    roots: tuple[str, ...]
    cache_folder: str
    shape: str = ""
    """For an image: the primitive that it is put on; empty for a mesh file."""


@dataclass(frozen=True, slots=True)
class MeshAnswer:
    """The mesh as `pack_mesh` packs it; empty when it is in the cache under `name`."""

    name: str
    blob: bytes


@dataclass(frozen=True, slots=True)
class MeshFault:
    """Why a mesh cannot be shown; `kind` is the class name of the error."""

    kind: str
    subject: str
    reason: str


@dataclass(frozen=True, slots=True)
class CheckRequest:
    """Parse and validate an expanded URDF."""

    urdf: str


@dataclass(frozen=True, slots=True)
class CheckAnswer:
    """Names that yourdfpy reads in a URDF; empty when it cannot read it at all."""

    links: tuple[str, ...]
    actuated_joints: tuple[str, ...]
    base_link: str
    problems: tuple[Problem, ...]


CODEC: Final = Codec(MeshRequest, MeshAnswer, MeshFault, CheckRequest, CheckAnswer)
