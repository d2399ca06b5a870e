# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Extended precision, in which the judges of linear motions calculate."""

import numpy as np

Long = np.longdouble
EPSILON = 2.0 ** -52    # of the numbers that are judged
PI = Long('3.14159265358979323846264338327950288')
