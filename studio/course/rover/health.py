"""Health: publishes battery and motors on /diagnostics and /battery_state."""

from __future__ import annotations

from typing import TYPE_CHECKING

from studio.ros.messages.diagnostic_msgs.msg import DiagnosticArray, DiagnosticStatus, KeyValue
from studio.ros.messages.sensor_msgs.msg import BatteryState

if TYPE_CHECKING:
    from studio.course.rover.drive import Drive
    from studio.ros.client import Node
    from studio.ros.messages.builtin_interfaces.msg import Time

FULL_V, EMPTY_V, LOW = 25.2, 21.0, 0.2
_LASTS_S = 1800.0


class Health:
    """A battery that lasts half an hour, then is charged; motors that warm as they work."""

    def __init__(self, node: Node) -> None:
        self._diagnostics = node.create_publisher(DiagnosticArray, "/diagnostics", 10)
        self._batteries = node.create_publisher(BatteryState, "battery_state", 10)
        self._motor_c = 25.0

    def publish(self, stamp: Time, drive: Drive, seconds: float, *, is_blocked: bool) -> None:
        """Publish the rover's health, once a second."""
        charge = 1.0 - seconds % _LASTS_S / _LASTS_S
        volts = EMPTY_V + (FULL_V - EMPTY_V) * charge
        self._motor_c += 0.02 * (25.0 + 40.0 * abs(drive.forward_m_s) - self._motor_c)
        array = DiagnosticArray(
            status=[
                _battery(charge, volts),
                _status("motors", _motors_level(is_blocked), temperature=f"{self._motor_c:.1f} C"),
                _status("lidar", (DiagnosticStatus.OK, "scanning"), rate="10 Hz"),
            ]
        )
        array.header.stamp = stamp
        self._diagnostics.publish(array)
        battery = BatteryState(voltage=volts, percentage=charge, present=True)
        battery.header.stamp, battery.header.frame_id = stamp, "base_link"
        battery.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
        self._batteries.publish(battery)


def _battery(charge: float, volts: float) -> DiagnosticStatus:
    state = (DiagnosticStatus.WARN, "low") if charge < LOW else (DiagnosticStatus.OK, "charged")
    return _status("battery", state, charge=f"{100 * charge:.0f} %", voltage=f"{volts:.2f} V")


def _motors_level(is_blocked: bool) -> tuple[bytes, str]:  # noqa: FBT001
    if is_blocked:
        return DiagnosticStatus.WARN, "a wall is in the way"
    return DiagnosticStatus.OK, "running"


def _status(name: str, state: tuple[bytes, str], **values: str) -> DiagnosticStatus:
    level, message = state
    pairs = [KeyValue(key=key, value=value) for key, value in values.items()]
    return DiagnosticStatus(
        level=level, name=f"rover: {name}", message=message, hardware_id="rover", values=pairs
    )
