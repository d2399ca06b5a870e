# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How work that takes a while says how far it is."""

from collections.abc import Callable

Progress = Callable[[float], None] | None   # is given the share that is done, from 0 to 1
