"""The nested scene dictionary, checked and turned into exact multiple-precision values.

Every number is taken as the binary double it is: mpf(float).
"""

from __future__ import annotations

import itertools
from bisect import bisect_right
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from mpmath import inf, mpf

from .statics import LAWS, StaticLaw


@dataclass(frozen=True)
class Line:
    """One straight piece of a table: offset + slope * w."""

    offset: mpf
    slope: mpf

    def at(self, w: mpf) -> mpf:
        return self.offset + self.slope * w


@dataclass(frozen=True)
class Table:
    """Piecewise-linear function of speed, constant beyond the last knot."""

    speeds: tuple[mpf, ...]
    values: tuple[mpf, ...]

    def piece_above(self, w: mpf) -> Line:
        """Return the straight piece that starts at, or contains, the speed w."""
        i = sum(1 for k in self.speeds if k <= w) - 1
        if i == len(self.speeds) - 1:
            return Line(self.values[-1], mpf(0))
        slope = (self.values[i + 1] - self.values[i]) / (self.speeds[i + 1] - self.speeds[i])
        return Line(self.values[i] - slope * self.speeds[i], slope)


@dataclass(frozen=True)
class Segment:
    """An input from one instant on: value + slope (t - start)."""

    start: mpf
    value: mpf
    slope: mpf

    def at(self, t: mpf) -> mpf:
        return self.value + self.slope * (t - self.start)


@dataclass(frozen=True)
class Course:
    """A piecewise-linear input with jumps; right-continuous."""

    segments: tuple[Segment, ...]

    def segment(self, t: mpf) -> Segment:
        return self.segments[bisect_right(self.segments, t, key=lambda s: s.start) - 1]


@dataclass(frozen=True)
class Axis:
    """Everything the automaton needs."""

    mass: mpf
    stiffness: mpf
    damping: mpf
    normal: mpf
    contact: str
    contact_stiffness: mpf
    contact_damping: mpf
    static: StaticLaw
    kinetic: Table
    excess: Table | None
    drive: Course
    force: Course
    position: mpf
    velocity: mpf
    rest_time: mpf

    def knots(self) -> list[mpf]:
        """Return the speeds above zero at which a friction table bends."""
        speeds = set(self.kinetic.speeds) | set(self.excess.speeds if self.excess else ())
        return sorted(k for k in speeds if k > 0)

    def breakpoints(self) -> list[mpf]:
        """Return the instants after the start at which an input changes its law."""
        starts = {s.start for s in self.drive.segments} | {s.start for s in self.force.segments}
        return sorted(t for t in starts if t > 0)


def parse(parameters: Mapping[str, Any]) -> Axis:
    """Build the axis from the nested dictionary; raise ValueError when it is not a valid model."""
    axis, contact = parameters["axis"], parameters.get("contact", {"model": "rigid"})
    friction, initial = parameters["friction"], parameters.get("initial", {})
    kinetic = _table(friction["kinetic"], "coefficients")
    result = Axis(
        mass=_positive(axis["mass"], "mass"),
        stiffness=_not_negative(axis["drive_stiffness"], "drive_stiffness"),
        damping=_not_negative(axis["drive_damping"], "drive_damping"),
        normal=_not_negative(axis["normal_force"], "normal_force"),
        contact=contact["model"],
        contact_stiffness=_not_negative(contact.get("stiffness", 0.0), "contact stiffness"),
        contact_damping=_not_negative(contact.get("damping", 0.0), "contact damping"),
        static=_static(friction["static"]),
        kinetic=kinetic,
        excess=_excess(friction, kinetic),
        drive=_course(parameters.get("drive")),
        force=_course(parameters.get("force")),
        position=mpf(initial.get("position", 0.0)),
        velocity=mpf(initial.get("velocity", 0.0)),
        rest_time=mpf(initial.get("rest_time", inf)),
    )
    _check(result)
    return result


def _check(axis: Axis) -> None:
    if axis.contact not in ("rigid", "compliant"):
        raise ValueError(f"unknown contact model {axis.contact!r}")
    if axis.contact == "compliant":
        _positive(axis.contact_stiffness, "contact stiffness")
    if axis.kinetic.values[0] > axis.static.value(mpf(0)):
        raise ValueError("kinetic friction at rest lies above static friction at zero rest time")
    axis.static.value(axis.rest_time)


def _static(data: Mapping[str, Any]) -> StaticLaw:
    law = data["law"]
    if law not in LAWS:
        raise ValueError(f"unknown static law {law!r}")
    initial = mpf(data["initial"])
    limit = initial if law == "constant" else mpf(data["limit"])
    if limit < initial:
        raise ValueError("the static coefficient must not fall with rest time")
    tau = mpf(1) if law == "constant" else _positive(data["time_constant"], "time_constant")
    return StaticLaw(law, initial, limit, tau, _positive(data.get("exponent", 1.0), "exponent"))


def _excess(friction: Mapping[str, Any], kinetic: Table) -> Table | None:
    """Return psi, or None without acceleration dependence; linear to the last kinetic knot by default."""
    if not friction.get("acceleration_dependence", False):
        return None
    if "excess" in friction:
        psi = _table(friction["excess"], "fractions")
    else:
        psi = Table((mpf(0), kinetic.speeds[-1]), (mpf(1), mpf(0)))
    if psi.values[0] != 1 or psi.values[-1] != 0 or psi.speeds[-1] <= 0:
        raise ValueError("the excess must fall from 1 at speed 0 to 0 at its last knot")
    return psi


def _table(data: Mapping[str, Sequence[float]], values: str) -> Table:
    speeds = tuple(mpf(s) for s in data["velocities"])
    if speeds[0] != 0 or any(b <= a for a, b in itertools.pairwise(speeds)):
        raise ValueError("table velocities must start at 0 and increase")
    if len(speeds) != len(data[values]):
        raise ValueError("a table needs as many values as velocities")
    return Table(speeds, tuple(_not_negative(c, values) for c in data[values]))


def _course(data: Sequence[Sequence[float]] | None) -> Course:
    rows = data if data else [(0.0, 0.0, 0.0)]
    segments = tuple(Segment(mpf(t), mpf(v), mpf(k)) for t, v, k in rows)
    starts = [s.start for s in segments]
    if starts[0] != 0 or any(b <= a for a, b in itertools.pairwise(starts)):
        raise ValueError("input segments must start at 0 and follow each other")
    return Course(segments)


def _positive(number: Any, name: str) -> mpf:
    if not mpf(number) > 0:
        raise ValueError(f"{name} must be positive")
    return mpf(number)


def _not_negative(number: Any, name: str) -> mpf:
    if not mpf(number) >= 0:
        raise ValueError(f"{name} must not be negative")
    return mpf(number)
