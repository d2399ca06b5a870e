# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How results are said: the model of a report, rendered as text, Markdown, HTML and JSON values.

Knows no run; what is said of one is in the `report` of each room.
"""
