# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Write the unit, to look at it: `python3 -m hot_unit PACKAGE OUT.pyx`."""

import sys
from pathlib import Path

from .errors import UnitError
from .unit import write_unit

if __name__ == '__main__':
    _package, _out = map(Path, sys.argv[1:])
    try:
        _out.write_text(write_unit(_package), encoding='utf-8')
    except UnitError as error:
        sys.exit(f'error: {error}')
