"""Forces, flows and guards of the axis in each mode of the automaton.

F_d = c w + h (v - u)                 drive force
R   = σ (F_d + F_e) - N mu_k(|u|)     driving surplus over the lower branch
B   = N E psi(|u|)                    height of the upper branch over the lower one
m σ u' = R - B (accelerating),  0 (coasting),  R (decelerating)
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

from mpmath import mp, mpf, sqrt

from .. import words
from .linear import A, D, F, Flow, G, Row, U, V, W, motion, row
from .problem import Line, Problem
from .series import Series, combine

ACCELERATE, COAST, DECELERATE = 'accelerate', 'coast', 'decelerate'


@dataclass(frozen=True)
class Stick:
    """Rest since an instant, entered with an age of the contact (0 after a slip)."""

    since: mpf
    age: mpf

    def rest_time(self, t: mpf) -> mpf:
        """Return the age of the contact at an instant."""
        return self.age + (t - self.since)


@dataclass(frozen=True)
class Slip:
    """Motion in a direction: sub-mode, excess E of this slip, table piece; ``silent``: an unlisted coast."""

    direction: int
    phase: str
    excess: mpf
    piece: int
    silent: bool = False


Mode = Stick | Slip
_WORDS = {ACCELERATE: words.Mode.ACCELERATING, COAST: words.Mode.COASTING, DECELERATE: words.Mode.DECELERATING}


def word(mode: Mode) -> words.Mode:
    """Return the product's name of a mode."""
    if isinstance(mode, Stick):
        return words.Mode.STICK
    return words.Mode.ACCELERATING if mode.silent else _WORDS[mode.phase]


@dataclass
class Physics:
    """The equations of one axis."""

    axis: Problem
    knots: list[mpf] = field(init=False)

    def __post_init__(self) -> None:
        self.knots = self.axis.knots()

    # ---- forces -------------------------------------------------------------------------------

    def drive_force(self, state: Sequence[mpf]) -> mpf:
        """F_d = c w + h (v - u)."""
        return self.axis.stiffness * state[W] + self.axis.damping * (state[V] - state[U])

    def net_force(self, state: Sequence[mpf]) -> mpf:
        """F_d + F_e."""
        return self.drive_force(state) + state[F]

    def net_series(self, series: list[Series]) -> Series:
        """F_d + F_e as a power series."""
        c, h = self.axis.stiffness, self.axis.damping
        return combine((c, series[W]), (h, series[V]), (-h, series[U]), (mpf(1), series[F]))

    def stick_force_series(self, series: list[Series]) -> Series:
        """Contact force as a power series: c_c d + h_c u, or F_d + F_e when the contact is rigid."""
        if self.axis.contact == 'rigid':
            return self.net_series(series)
        return combine((self.axis.contact_stiffness, series[D]), (self.axis.contact_damping, series[U]))

    def friction(self, mode: Mode, state: Sequence[mpf]) -> mpf:
        """Friction (slip) or contact force (stick), positive when it opposes positive motion."""
        if isinstance(mode, Stick) and self.axis.contact == 'compliant':
            return self.axis.contact_stiffness * state[D] + self.axis.contact_damping * state[U]
        if isinstance(mode, Stick) or mode.phase == COAST:
            return self.net_force(state)
        line = self.branch(mode)
        return mode.direction * self.axis.normal * line.at(mode.direction * state[U])

    def force_scale(self, state: Sequence[mpf]) -> mpf:
        """Return a force against which rounding is judged."""
        a = self.axis
        top = max(max(a.kinetic.values), a.static.initial, a.static.limit)
        return a.normal * top + abs(a.stiffness * state[W]) + abs(state[F]) + a.damping * abs(state[V])

    # ---- friction pieces ----------------------------------------------------------------------

    def lower_knot(self, piece: int) -> mpf:
        """Return the speed at which a piece begins."""
        return self.knots[piece - 1] if piece else mpf(0)

    def upper_knot(self, piece: int) -> mpf | None:
        """Return the speed at which a piece ends; None for the last one."""
        return self.knots[piece] if piece < len(self.knots) else None

    def locate(self, speed: mpf, rising: bool) -> int:
        """Return the piece of a speed; on a knot the sign of the acceleration decides."""
        tiny = mpf(10) ** (18 - mp.dps)
        side = tiny if rising else -tiny
        return sum(1 for k in self.knots if speed >= k * (1 - side))

    def kinetic_line(self, piece: int) -> Line:
        """Return mu_k(w) on a piece."""
        return self.axis.kinetic.piece_above(self.lower_knot(piece))

    def psi_line(self, piece: int) -> Line:
        """Return psi(w) on a piece."""
        if self.axis.excess is None:
            return Line(mpf(0), mpf(0))
        return self.axis.excess.piece_above(self.lower_knot(piece))

    def branch(self, slip: Slip) -> Line:
        """mu(w) of the accelerating or decelerating branch on the slip's piece."""
        kinetic = self.kinetic_line(slip.piece)
        if slip.phase != ACCELERATE or not slip.excess:
            return kinetic
        psi = self.psi_line(slip.piece)
        return Line(kinetic.offset + slip.excess * psi.offset, kinetic.slope + slip.excess * psi.slope)

    def surplus(self, direction: int, state: Sequence[mpf]) -> mpf:
        """R = σ (F_d + F_e) - N mu_k(|u|)."""
        w = abs(state[U])
        mu = self.kinetic_line(self.locate(w, True)).at(w)
        return direction * self.net_force(state) - self.axis.normal * mu

    def band(self, excess: mpf, speed: mpf) -> mpf:
        """B = N E psi(w)."""
        return self.axis.normal * excess * self.psi_line(self.locate(speed, True)).at(speed)

    def excess_at(self, static: mpf, speed: mpf) -> mpf:
        """E with mu_k(w) + E psi(w) = mu_b; 0 where psi = 0; never negative."""
        piece = self.locate(speed, True)
        psi = self.psi_line(piece).at(speed)
        if not psi > 0:
            return mpf(0)
        return max(mpf(0), (static - self.kinetic_line(piece).at(speed)) / psi)

    # ---- classification -----------------------------------------------------------------------

    def surplus_rate(self, direction: int, state: Sequence[mpf]) -> mpf:
        """First non-vanishing derivative of R at constant speed: σ (c (v-u) + h v' + F'), else σ c v'."""
        a = self.axis
        first = a.stiffness * (state[V] - state[U]) + a.damping * state[A] + state[G]
        time = sqrt(a.mass / a.stiffness) if a.stiffness else mpf(1)
        if abs(first) * time > self.tiny(state):
            return direction * first
        second = a.stiffness * state[A]
        return direction * second if abs(second) * time**2 > self.tiny(state) else mpf(0)

    def tiny(self, state: Sequence[mpf]) -> mpf:
        """Return the rounding of a force at the working precision."""
        return self.force_scale(state) * mpf(10) ** (18 - mp.dps)

    def phase(self, direction: int, excess: mpf, state: Sequence[mpf]) -> str:
        """Return the sub-mode of a slip; on a border the way R moves decides."""
        surplus, tiny = self.surplus(direction, state), self.tiny(state)
        band = self.band(excess, abs(state[U]))
        if surplus > band + tiny:
            return ACCELERATE
        if surplus < -tiny:
            return DECELERATE
        rate = self.surplus_rate(direction, state)
        if rate > 0 and surplus >= band - tiny:
            return ACCELERATE
        if rate < 0 and surplus <= tiny:
            return DECELERATE
        return COAST

    # ---- flows --------------------------------------------------------------------------------

    def flow(self, mode: Mode) -> Flow:
        """Return the linear dynamics of a mode."""
        if isinstance(mode, Slip):
            return self._slip_flow(mode)
        if self.axis.contact == 'rigid':
            return motion((), moves=False, deflects=False, rate=mpf(0))
        return self._ringing_flow()

    def _slip_flow(self, slip: Slip) -> Flow:
        """M u' = F_d + F_e - σ N (α + β σ u), or u' = 0 while coasting."""
        if slip.phase == COAST:
            return motion((), moves=True, deflects=False, rate=mpf(0))
        a, line = self.axis, self.branch(slip)
        damping = a.damping + a.normal * line.slope
        u_row: Row = row(
            w=a.stiffness / a.mass,
            u=-damping / a.mass,
            v=a.damping / a.mass,
            F=1 / a.mass,
            one=-slip.direction * a.normal * line.offset / a.mass,
        )
        rate = sqrt(a.stiffness / a.mass) + abs(damping) / a.mass
        return motion(u_row, moves=True, deflects=False, rate=rate)

    def _ringing_flow(self) -> Flow:
        """M u' = F_d + F_e - c_c d - h_c u."""
        a = self.axis
        damping = a.damping + a.contact_damping
        u_row = row(
            w=a.stiffness / a.mass,
            u=-damping / a.mass,
            d=-a.contact_stiffness / a.mass,
            v=a.damping / a.mass,
            F=1 / a.mass,
        )
        rate = sqrt((a.stiffness + a.contact_stiffness) / a.mass) + damping / a.mass
        return motion(u_row, moves=True, deflects=True, rate=rate)
