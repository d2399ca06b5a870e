# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Put what `stickslip bench` wrote, and tick.py added to it, into docs/accuracy_tables.md, between its markers.

    python3 -m benchmarks.accuracy runs/bench
"""

import json
import pathlib
import shutil
import sys

from stickslip_sim.bench.report import markdown

from .page import replace_generated

PAGE = pathlib.Path('docs/accuracy_tables.md')
IMAGES = pathlib.Path('docs/images')


def main() -> None:
    """Replace the generated part and the pictures."""
    folder = pathlib.Path(sys.argv[1])
    replace_generated(PAGE, markdown(json.loads((folder / 'bench.json').read_text(encoding='utf-8'))))
    for name in ('trade', 'trade_scenes'):
        if (folder / f'{name}.png').is_file():
            shutil.copy(folder / f'{name}.png', IMAGES / f'{name}.png')


if __name__ == '__main__':
    main()
