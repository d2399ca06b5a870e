# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measure what `stickslip identify` finds on axes whose truth is known: docs/data/identification.json.

    python3 -m benchmarks.identify [--axes 100] [--varied 200] [--rivals 5] [--seed 0] [--out FILE]

What is done is kept in runs/identify/, and a run that was ended goes on from there; `--again` begins anew.
"""

import argparse
import json
import sys
from pathlib import Path

from ..loop import machine
from ..measured import DATA, keep
from . import figures
from .axes import SyntheticAxis, axes
from .foreign import identify_lugre
from .measuring import OTHERS
from .outcomes import Outcome, load, outcome_of, save
from .rivals import METHODS, OURS, RivalOutcome, our_outcomes, rival_outcome
from .varied import varied_axes

KEPT = Path('runs/identify')


def main() -> None:
    """Measure, and keep the figures."""
    options = parse()
    drawn = axes(options.axes, options.seed)
    outcomes = identify_all(drawn, KEPT / f'seed_{options.seed}.json', options.again)
    others = {words: identify_all([axis._replace(sensors=sensors) for axis in drawn],
                                  KEPT / f'other_{k}_{options.seed}.json', options.again)
              for k, (words, sensors) in enumerate(OTHERS.items())}
    varied = identify_all(varied_axes(options.varied, options.seed), KEPT / f'varied_{options.seed}.json',
                          options.again)
    few = drawn[:options.rivals]
    kept = KEPT / f'rivals_{options.seed}.json'
    rivals = {OURS: our_outcomes(outcomes[:len(few)]), **rivals_on(few, kept, options.again)}
    foreign = identify_lugre()
    keep(options.out, command=f'python3 -m benchmarks.identify --axes {options.axes} --seed {options.seed}',
         machine=machine(), synthetic=figures.synthetic(outcomes), sensors=figures.by_sensors(others),
         by_model=figures.by_model(outcomes), by_parameter=figures.by_parameter(outcomes),
         varied=figures.of_every_kind(varied), not_right=figures.not_right([*outcomes, *varied]),
         rivals=figures.beside(rivals), foreign={
             'fits': foreign.fits, 'statements': foreign.statements, 'true_slips': foreign.true_slips,
             'found_slips': foreign.found_slips, 'cpu': foreign.seconds},
         foreign_slips=figures.foreign_slips(foreign))


def identify_all(drawn: list[SyntheticAxis], kept: Path, again: bool) -> list[Outcome]:
    """Return what came of each axis through its sensors, of those in a file what was found before."""
    done = {} if again else {outcome.axis: outcome for outcome in load(kept)}
    for axis in drawn:
        if axis.name not in done:
            done[axis.name] = outcome_of(axis)
            save(list(done.values()), kept)
        print(line(done[axis.name]), file=sys.stderr)
    return [done[axis.name] for axis in drawn]


def rivals_on(few: list[SyntheticAxis], kept: Path, again: bool) -> dict[str, list[RivalOutcome]]:
    """Return what came of each rival on a few axes, of those in a file what was found before."""
    known = json.loads(kept.read_text(encoding='utf-8')) if kept.exists() and not again else {}
    done = {(method, name): RivalOutcome(name, tuple(errors), *cost)
            for method, of in known.items() for name, errors, *cost in of}
    found: dict[str, list[RivalOutcome]] = {}
    for method in METHODS:
        found[method] = [done.get((method, axis.name)) or rival_outcome(method, axis) for axis in few]
        kept.write_text(json.dumps(known | found, indent=1) + '\n', encoding='utf-8')
        print(method, *found[method], sep='\n  ', file=sys.stderr)
    return found


def line(outcome: Outcome) -> str:
    """Return an outcome in a line."""
    lost = [f'{each.name} {each.value / each.true - 1.0:+.2%} (± {each.width:.2%})' for each in outcome.parameters
            if not each.is_found]
    return (f'{outcome.axis}: {", ".join(outcome.models)}: {outcome.seconds:.1f} s, {outcome.runs} simulations, '
            f'{"fits" if outcome.fits else "does not fit"}: {outcome.failure or ", ".join(lost) or "all found"}')


def parse() -> argparse.Namespace:
    """Return the options."""
    parser = argparse.ArgumentParser(prog='python3 -m benchmarks.identify', description=__doc__.splitlines()[0])
    parser.add_argument('--axes', type=int, default=100, help='[%(default)s]')
    parser.add_argument('--varied', type=int, default=200, help='axes of every kind [%(default)s]')
    parser.add_argument('--rivals', type=int, default=5, help='axes on which the others run [%(default)s]')
    parser.add_argument('--seed', type=int, default=0, help='[%(default)s]')
    parser.add_argument('--again', action='store_true', help='measure all again')
    parser.add_argument('--out', type=Path, default=DATA / 'identification.json', help='[%(default)s]')
    options = parser.parse_args()
    if not 1 <= options.axes <= 10_000 or min(options.varied, options.rivals) < 0 or options.seed < 0:
        parser.error('give --axes 1 to 10000, and --varied, --rivals and --seed of at least 0')
    return options


if __name__ == '__main__':
    main()
