# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The contestants of the race: the solvers of stickslip, and the peers."""

from .own_solvers import own_solvers
from .peers import dop853, euler, heyoka, mujoco, scipy_ivp, sksundae, sundials
from .peers.peer import Peer

PEERS: tuple[Peer, ...] = (heyoka.PEER, dop853.PEER, sundials.PEER, sksundae.PEER, *scipy_ivp.PEERS, euler.PEER,
                           mujoco.PEER)


def contestants(*, quick: bool = False) -> list[Peer]:
    """Return all; quickly: the coarsest and the finest setting of each, without those that compile anew each time."""
    everyone = [*own_solvers(), *PEERS]
    if not quick:
        return everyone
    return [peer._replace(settings=tuple(dict.fromkeys((peer.settings[0], peer.settings[-1]))))
            for peer in everyone if peer.name != sundials.PEER.name]
