# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What was found, for its reader: a scene, what is left open of it, a page and values, in one folder."""
