# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The picture of `stickslip explore` in README.md, taken in a browser: `python3 -m benchmarks.explorer_picture`."""

import tempfile
from pathlib import Path

from dev.browser import Browser
from stickslip_sim import load_scene
from stickslip_sim.explorer.page import page_of

PICTURE = Path('docs/images/explorer.png')
WIDTH, HEIGHT = 1280, 900
AT = 0.497   # of the width of the velocity: within a slip


def main() -> None:
    """Open the page of paper_fig8, point into a slip, take the picture."""
    with tempfile.TemporaryDirectory() as name, Browser(Path(name), WIDTH, HEIGHT) as browser:
        page = Path(name) / 'explore.html'
        page.write_text(page_of(load_scene('paper_fig8')), encoding='utf-8')
        browser.scheme('light')
        browser.open(page.as_uri())
        browser.until('explorer.stripCost')
        browser.mouse('Moved', *browser.place('#view_velocity .plot', AT))
        browser.ask('scrollTo(0, 0)')
        browser.picture(PICTURE)
    print(f'written: {PICTURE}')


if __name__ == '__main__':
    main()
