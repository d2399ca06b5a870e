# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""From measurements to a scene: friction curves and the laws that fit them; runs, and the parameters that make them.

The room bears the name of the function that users call, `stickslip.identify`: once it is imported, Python puts the room
in the place of that name.  So the room can be called, too.
"""

import sys
from types import ModuleType
from typing import Any


class _Room(ModuleType):
    def __call__(self, *arguments: Any, **options: Any) -> Any:
        """Do what `fit.identify` does."""
        from .fit import identify

        return identify(*arguments, **options)


sys.modules[__name__].__class__ = _Room
