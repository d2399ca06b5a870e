# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Advice: what each part of a scene changes and costs, and the least scene and solver for a tolerance."""
