# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements to a scene: friction curves and the laws that fit them; runs, and the parameters that make them."""
