# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What the node reports about itself and its surroundings, and the node that asks whether an axis is well."""
