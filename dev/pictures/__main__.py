# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`python3 -m dev.pictures` writes the pictures to docs/images/."""

from pathlib import Path

from . import axis, graph, rooms

ROOT = Path(__file__).parents[2]
PICTURES = {
    'docs/images/axis.svg': axis.picture,
    'docs/images/graph.svg': graph.picture,
    'docs/images/rooms.svg': rooms.picture,
}


def main() -> None:
    """Write every picture."""
    for name, picture in PICTURES.items():
        (ROOT / name).write_text(str(picture()), encoding='utf-8')


if __name__ == '__main__':
    main()
