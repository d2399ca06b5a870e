# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run as one thing: carried out offline, with its receipt and an estimate of its error."""
