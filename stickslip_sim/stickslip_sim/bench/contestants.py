# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The contestants of the race: the solvers of stickslip, and the peers."""

from collections.abc import Callable

from ..core.errors import SolverError
from .own_solvers import own_solvers
from .peers import dop853, euler, heyoka, mujoco, scipy_ivp, sksundae, sundials
from .peers.peer import Peer, Setting
from .problem import Outcome, Problem


def _with_one_friction(peer: Peer) -> Peer:
    """Return a peer that gives up where friction depends on the direction: its equations are those of one friction."""
    def prepare(problem: Problem, setting: Setting) -> Callable[[], Outcome]:
        if problem.axis.friction.backward is not None:
            raise SolverError('written here for a friction that is the same both ways')
        return peer.prepare(problem, setting)

    return peer._replace(prepare=prepare)


PEERS: tuple[Peer, ...] = tuple(map(_with_one_friction, (
    heyoka.PEER, dop853.PEER, sundials.PEER, sksundae.PEER, *scipy_ivp.SCIPY_PEERS, euler.PEER, mujoco.PEER)))


def contestants(*, quick: bool = False) -> list[Peer]:
    """Return all; quickly: the coarsest and the finest setting of each, without those that compile anew each time."""
    everyone = [*own_solvers(), *PEERS]
    if not quick:
        return everyone
    return [peer._replace(settings=tuple(dict.fromkeys((peer.settings[0], peer.settings[-1]))))
            for peer in everyone if peer.name != sundials.PEER.name]
