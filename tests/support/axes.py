# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Axes and runs that several tests use: those of the extremes suite."""

from stickslip_sim.proof.axes import (
    COMPLIANT,
    RIGID,
    Contact,
    instant,
    make,
    of_kind,
    paper_axis,
    random_axis,
    run_events,
)

__all__ = ['COMPLIANT', 'RIGID', 'Contact', 'instant', 'make', 'of_kind', 'paper_axis', 'random_axis', 'run_events']
