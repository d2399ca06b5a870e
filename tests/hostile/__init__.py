# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An attack on the engine: scenes near everything that may go wrong, and judges that share no formula with it."""
