# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How well a fit knows its parameters, and whether its model is rejected."""
