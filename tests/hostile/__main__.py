# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Attacks the engine for as long as asked for: `python3 -m tests.hostile --minutes 10`.

What is found is written to runs/hostile/, a scene and what was judged, and judged again by `--again FOLDER`.  The seed
is printed; `--seed` takes one.
"""

import argparse
import random
import sys
import time
from collections import Counter
from pathlib import Path

from tests.support.time_and_memory import limit_memory

from .attack import PER_ROUND, REFERENCE_SHARE, Counts, Found, judge_again, one_round, read, table, write
from .generators import GENERATORS
from .judges import reference

_MEMORY = 1500      # MiB beyond those of the start
_SHOWN = 3          # finds of a generator and judge that are written and shown; the others are counted
_EVERY = 30.0       # s between two lines of progress


def main() -> int:
    """Attack, or judge a find again; return 1 when something is found."""
    options = _options()
    if options.again:
        return _again(Path(options.again))
    limit_memory(_MEMORY)
    seed = options.seed if options.seed is not None else str(random.SystemRandom().randrange(10 ** 9))
    print(f'seed {seed}', flush=True)
    tally, begin = Counts(), time.monotonic()
    shown: Counter[tuple[str, str]] = Counter()
    names = options.only.split(',') if options.only else list(GENERATORS)
    last, k = begin, 0
    while (now := time.monotonic()) < begin + 60.0 * options.minutes and (not options.rounds or k < options.rounds):
        if now > last + _EVERY:
            last = now
            _progress(tally, now - begin)
        for found in one_round(f'{seed}/{k}', tally, names, options.count, options.reference):
            shown[found.generator, found.judge] += 1
            if shown[found.generator, found.judge] <= _SHOWN:
                _show(found, Path(options.out))
        k += 1
    _progress(tally, time.monotonic() - begin)
    print(table(tally))
    refused = list(tally.too_many_refused())
    for line in refused:
        print(line)
    return 1 if tally.finds or refused else 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog='hostile', description='Attack the engine with scenes near everything.')
    parser.add_argument('--minutes', type=float, default=10.0)
    parser.add_argument('--rounds', type=int, default=0, help='end after so many rounds (0: by the time alone)')
    parser.add_argument('--seed', help='the same scenes again')
    parser.add_argument('--only', help='these generators: ' + ', '.join(GENERATORS))
    parser.add_argument('--count', type=int, default=PER_ROUND, help='scenes of a generator in a round')
    parser.add_argument('--reference', type=float, default=REFERENCE_SHARE,
                        help='share of the scenes that the reference judges')
    parser.add_argument('--out', default='runs/hostile', help='folder of the finds')
    parser.add_argument('--again', help='folder of a find, to judge it again')
    return parser.parse_args()


def _show(found: Found, folder: Path) -> None:
    confirmed = reference.confirm(found.case.parts) if found.judge == 'guards' else None
    place = write(found, folder, confirmed)
    print(f'{found.generator}, {found.judge}: {found.text}\n    {place}', flush=True)
    if confirmed:
        print(f'    {confirmed}', flush=True)


def _progress(tally: Counts, seconds: float) -> None:
    scenes = sum(tally.scenes.values())
    print(f'{seconds / 60.0:.1f} min: {scenes} scenes, {60.0 * scenes / max(seconds, 1e-9):.0f} a minute, '
          f'{sum(tally.events.values())} events, {sum(tally.refused.values())} refused, '
          f'{sum(tally.finds.values())} finds', flush=True)


def _again(place: Path) -> int:
    case, seed = read(place)
    found = judge_again(case, seed)
    for judge, text in found:
        print(f'{judge}: {text}')
    if not found:
        print('nothing found')
    return 1 if found else 0


if __name__ == '__main__':
    try:
        sys.exit(main())
    except BrokenPipeError:
        sys.exit(1)
