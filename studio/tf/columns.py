"""TransformColumns: transforms as columns, as they come from the wire or from our own robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, TypeAlias

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

Floats: TypeAlias = "NDArray[np.float64]"
Numbers: TypeAlias = "NDArray[np.int64]"
Flags: TypeAlias = "NDArray[np.bool_]"


class TransformColumns(Protocol):
    """What a buffer takes; the codec of tf2_msgs/msg/TFMessage answers such columns."""

    @property
    def parents(self) -> tuple[str, ...]:
        """N names."""
        ...

    @property
    def children(self) -> tuple[str, ...]:
        """N names."""
        ...

    @property
    def stamps_ns(self) -> Numbers:
        """Shape (N,)."""
        ...

    @property
    def translations(self) -> Floats:
        """Shape (N, 3), m: the child's origin in the parent."""
        ...

    @property
    def rotations_wxyz(self) -> Floats:
        """Shape (N, 4)."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Transforms:
    """Columns of one's own; see `TransformColumns` for shapes and units."""

    parents: tuple[str, ...]
    children: tuple[str, ...]
    stamps_ns: Numbers
    translations: Floats
    rotations_wxyz: Floats
