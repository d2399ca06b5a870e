# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The schematic pictures of README and docs, as SVG made from text: one module for each."""
