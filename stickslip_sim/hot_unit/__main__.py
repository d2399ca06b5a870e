# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Write the unit, to look at it: `python3 -m hot_unit PACKAGE OUT.c`."""

import sys
from pathlib import Path

from .sources import UnitError
from .unit import ENTRIES, LOOPS, Unit

if __name__ == '__main__':
    _package, _out = map(Path, sys.argv[1:])
    try:
        _out.write_text(Unit(_package).text(ENTRIES | LOOPS), encoding='utf-8')
    except UnitError as error:
        sys.exit(f'error: {error}')
