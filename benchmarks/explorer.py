# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip explore` in a browser: its times, and the picture in README.md: `python3 -m benchmarks.explorer`.

Without a graphics card.  A frame goes from the input of the slider, by the run, to six drawn views.
"""

import tempfile
from pathlib import Path
from statistics import median, quantiles

from dev.browser import Browser
from stickslip_sim import load_scene
from stickslip_sim.explorer.page import page_of

PICTURE = Path('docs/images/explorer.png')
WIDTH, HEIGHT = 1280, 900
AT = 0.497   # of the width of the velocity: within a slip
FEED = 'input[data-path="drive.velocity"]'
OPENED, DRAGS, STEPS = 7, 6, 40


def main() -> None:
    """Open the page of paper_fig8, drag the slider of the feed, print the times; take the picture in a slip."""
    with tempfile.TemporaryDirectory() as name, Browser(Path(name), WIDTH, HEIGHT) as browser:
        page = Path(name) / 'explore.html'
        page.write_text(page_of(load_scene('paper_fig8')), encoding='utf-8')
        browser.scheme('light')
        opened = []
        for _ in range(OPENED):
            browser.open(page.as_uri())
            opened.append(browser.ask('explorer.opened'))
        for _ in range(DRAGS):
            browser.drag(FEED, 0.3, 0.7, STEPS)
        frames = browser.ask('explorer.costs.slice(1)')    # the first has fewer samples
        browser.open(page.as_uri())
        browser.until('explorer.stripCost')
        samples, strip = browser.ask('[explorer.views.velocity.run.time.length, explorer.stripCost]')
        print(f'opens in {median(opened):.0f} ms; {len(frames)} frames of up to {samples} samples: median '
              f'{median(frames):.1f} ms, p95 {quantiles(frames, n=20)[-1]:.1f} ms; critical feed {strip:.0f} ms')
        browser.mouse('Moved', *browser.place('#view_velocity .plot', AT))
        browser.ask('scrollTo(0, 0)')
        browser.picture(PICTURE)
    print(f'written: {PICTURE}')


if __name__ == '__main__':
    main()
