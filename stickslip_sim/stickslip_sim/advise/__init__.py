# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice: the effect and the cost of each part of a scene, and the least scene and solver for a tolerance."""
