# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How a forked program ends: with all that libraries registered for it, and without the destructors of libraries.

That of LTTng, which ROS 2 Kilted loads, cancels a thread that a fork leaves behind: a segmentation fault, now and then.
To be imported before all that is to be destroyed: what is registered last is called first.
"""

import ctypes

_C = ctypes.CDLL(None)
_C.on_exit(_C._exit, None)    # with the exit code
