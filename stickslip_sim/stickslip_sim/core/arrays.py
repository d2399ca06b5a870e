# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Arrays by what is in them."""

import numpy as np
from numpy.typing import NDArray

Numbers = NDArray[np.float64]
