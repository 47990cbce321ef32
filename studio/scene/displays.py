"""Settings of the shared displays: their names, first values and what each may be."""

from __future__ import annotations

from typing import TypeAlias

from studio.errors import SceneError

Value: TypeAlias = bool | float | str

DISPLAY_DEFAULTS: dict[str, dict[str, Value]] = {
    "robot": {
        "visual": True,
        "collision": False,
        "frames": False,
        "names": False,
        "axes": False,
        "inertia": False,
        "com": False,
        "opacity": 1.0,
    },
    "grid": {
        "visible": True,
        "cell_m": 0.25,
        "extent_m": 0.0,
        "shadow": True,
        "under_robot": True,
    },
    "ghost": {"visible": False, "beside": False, "opacity": 0.35},
}
"""By display, then setting. `axes` are the joint axes, `com` the centres of mass; a grid of extent
0 has no end, and one that is not under the robot lies at the height of the root link. The ghost is
the robot that this one is compared with; it may stand beside it."""

_RANGES: dict[tuple[str, str], tuple[float, float]] = {
    ("robot", "opacity"): (0.0, 1.0),
    ("ghost", "opacity"): (0.05, 1.0),
    ("grid", "cell_m"): (0.001, 1000.0),
    ("grid", "extent_m"): (0.0, 100_000.0),
}


def checked(display: str, name: str, value: Value) -> Value:
    """The value as the display takes it: numbers within their range.

    Raises:
        SceneError: No such display or setting, or a value of another kind.
    """
    default = DISPLAY_DEFAULTS.get(display, {}).get(name)
    if default is None:
        raise SceneError(f'There is no setting "{name}" of a display "{display}".')
    if isinstance(default, bool):
        if not isinstance(value, bool):
            raise SceneError(f"{display} {name} is on or off, not {value!r}.")
        return value
    return _within(display, name, value)


def _within(display: str, name: str, value: Value) -> float:
    if isinstance(value, bool | str) or value != value:  # noqa: PLR0124 - NaN is not itself
        raise SceneError(f"{display} {name} is a number, not {value!r}.")
    low, high = _RANGES[display, name]
    return min(max(float(value), low), high)
