"""LaserScan: one turn of a lidar, as points in the plane of its beams."""

from __future__ import annotations

from functools import lru_cache
from typing import TYPE_CHECKING, Any, ClassVar, Final

import numpy as np

from studio.displays.cloud import Cloud, evenly_among
from studio.displays.cloud_display import CloudDisplay
from studio.displays.display import Status, TopicRole, stamp_ns_of
from studio.displays.drawing import Sweep
from studio.displays.selection import Fact, number_fact
from studio.errors import DisplayMessageError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from studio.displays.display import Limits, Received
    from studio.displays.selection import ItemKind

_BEAMS_MAX: Final = 4_000_000
_TURN_MAX_S: Final = 5.0


class LaserScanDisplay(CloudDisplay):
    """Draws every return between the least and the greatest range of the scan."""

    KIND: ClassVar[str] = "LaserScan"
    DOC: ClassVar[str] = "What a lidar met, one point for each beam that came back."
    ICON: ClassVar[str] = "radar"
    TOPICS: ClassVar[tuple[TopicRole, ...]] = (
        TopicRole("", ("sensor_msgs/msg/LaserScan",), reliable=False),
    )
    ITEM: ClassVar[ItemKind] = "beam"

    def read(self, received: Received, limits: Limits) -> Cloud:
        """Return the points of a scan.

        Raises:
            StudioError: It cannot be read, or has no angles.
        """
        scan = self.decode(received)
        _check(scan)
        # As laser_geometry: the least range counts, the greatest does not.
        with np.errstate(invalid="ignore"):
            returned = (scan.ranges >= scan.range_min) & (scan.ranges < scan.range_max)
        returned &= np.isfinite(scan.ranges)  # the least range may be infinite, too
        chosen = evenly_among(returned, limits.points)
        rays = _rays(float(scan.angle_min), float(scan.angle_increment), len(scan.ranges))
        positions = rays.take(chosen, axis=0) * scan.ranges[chosen, None]
        return Cloud(
            scan.header.frame_id, stamp_ns_of(scan.header), positions, chosen,
            int(np.count_nonzero(returned)), _Beams(scan), _nothing(scan, len(chosen)),
            _sweep_of(scan, chosen),
        )  # fmt: skip

    def channel_facts(self, cloud: Cloud, index: int) -> tuple[Fact, ...]:
        """Return what the beam of a point measured."""
        beams = cloud.channels
        return beams.facts(index) if isinstance(beams, _Beams) else ()


class _Beams:
    """Directions of the beams of a scan, and the like."""

    def __init__(self, scan: Any) -> None:  # noqa: ANN401 - a sensor_msgs/LaserScan
        self._angles_rad = float(scan.angle_min), float(scan.angle_increment)
        self._columns: dict[str, NDArray[np.float32]] = {"range": scan.ranges}
        if len(scan.intensities) == len(scan.ranges):
            self._columns["intensity"] = scan.intensities
        self.names: tuple[str, ...] = (*sorted(self._columns), "index")

    @property
    def size_bytes(self) -> int:
        return sum(column.nbytes for column in self._columns.values())

    def numbers(self, name: str, raw: NDArray[np.intp] | None) -> NDArray[np.float32] | None:
        if name == "index" and raw is not None:
            return raw.astype(np.float32)
        column = self._columns.get(name)
        if column is None:
            return None
        return (column if raw is None else column[raw]).astype(np.float32)

    def facts(self, index: int) -> tuple[Fact, ...]:
        """Return the range, the angle and the intensity of a beam."""
        first_rad, step_rad = self._angles_rad
        found = [
            number_fact("range", float(self._columns["range"][index]), "m"),
            number_fact("angle", first_rad + index * step_rad, "rad"),
        ]
        if (intensities := self._columns.get("intensity")) is not None:
            found.append(number_fact("intensity", float(intensities[index])))
        return tuple(found)

    def colours(self, raw: NDArray[np.intp] | None) -> None:
        del raw

    def float_colours(self, raw: NDArray[np.intp] | None) -> None:
        del raw


@lru_cache(maxsize=16)
def _rays(first_rad: float, step_rad: float, count: int) -> NDArray[np.float32]:
    """Directions of the beams, shape (N, 3), of length 1; lidars send the same ones each time."""
    angles = first_rad + step_rad * np.arange(count)
    rays = np.zeros((count, 3), dtype=np.float32)
    rays[:, 0], rays[:, 1] = np.cos(angles), np.sin(angles)
    rays.setflags(write=False)
    return rays


def _sweep_of(scan: Any, beams: NDArray[np.intp]) -> Sweep | None:  # noqa: ANN401
    """Return when the beams were sent, one after the other; None if all at once, or unknown."""
    count, stamp_ns = len(scan.ranges), stamp_ns_of(scan.header)
    took_s = float(scan.time_increment) * (count - 1)
    # The time of a turn is a part of a second; what is longer than all that is known is no time.
    if not stamp_ns or count < 2 or not 0.0 < abs(took_s) <= _TURN_MAX_S:
        return None
    shares = beams.astype(np.float32) / np.float32(count - 1)
    return Sweep(stamp_ns + round(took_s * 1e9), shares)


def _check(scan: Any) -> None:  # noqa: ANN401
    if not np.isfinite([scan.angle_min, scan.angle_increment]).all():
        raise DisplayMessageError("LaserScan", "its angle_min or angle_increment is no number")
    if len(scan.ranges) > _BEAMS_MAX:
        raise DisplayMessageError(
            "LaserScan", f"it has {len(scan.ranges):,} ranges, at most {_BEAMS_MAX:,} are drawn"
        )


def _nothing(scan: Any, shown: int) -> Status | None:  # noqa: ANN401
    count = len(scan.ranges)
    if shown:
        return None
    if not count:
        return Status("warn", "no_points", "The scan has no ranges.")
    if np.isnan(scan.ranges).all():
        return Status("warn", "not_finite", f"All {count:,} ranges are NaN.")
    beyond = int(np.isinf(scan.ranges).sum())
    free = f", {beyond:,} of them infinite: nothing came back" if beyond else ""
    return Status(
        "warn", "out_of_range",
        f"All {count:,} ranges are outside of {scan.range_min:g} to {scan.range_max:g} m, as the "
        f"scan itself names them{free}.",
    )  # fmt: skip
