# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Derivatives of figures by the numbers of a scene, and the most informative experiment.  Variants are in `study`.

The engine is right to about 1e-13 s, so that plain differences are: no adjoint is needed, and no formula for what a
transition does to a derivative.  They hold within one sequence of events; where that changes, there is none.
"""
