# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Simulators that one might use instead of this one, each a `Peer` in a file of its own."""

from collections.abc import Callable

from ...axis.layout import STATIC_LAW
from ...core.errors import SolverError
from ...friction import StaticLawKind
from ..problem import Outcome, Peer, Problem, Setting
from . import dop853
from . import heyoka
from . import mujoco
from . import scipy_ivp
from . import sundials


def _within_its_equations(peer: Peer) -> Peer:
    """Return a peer that gives up on any friction but the one that `automaton` is written for."""
    def prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
        friction = problem.axis.friction
        if (friction.backward is not None or friction.static.scatter is not None
                or problem.parameters[STATIC_LAW] != StaticLawKind.EXPONENTIAL):
            raise SolverError('written here for a friction that is the same both ways, and an exponential mu_s '
                              'without scatter')
        return peer.prepare(problem, setting)

    return peer._replace(prepare=prepare)


PEERS: tuple[Peer, ...] = tuple(map(_within_its_equations, (
    heyoka.PEER, dop853.PEER, sundials.PEER, *scipy_ivp.SCIPY_PEERS, mujoco.PEER)))
