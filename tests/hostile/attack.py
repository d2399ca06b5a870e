# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Rounds of made-up scenes: generated, run, judged, counted."""

import random
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from typing import NamedTuple

from stickslip_sim.core.errors import InputError, SolverError, UnsoundError

from .case import Case, Find, LastBits, Run, Undecided, run
from .generators import GENERATORS, PLAUSIBLE
from .judges import batch, bounds, brute, guards, images, parts, reference, smooth_load, touch

PER_ROUND = 10               # scenes of each generator
REFERENCE_SHARE = 0.02       # of the scenes; one takes a second
TIES = frozenset({'touching', 'ties', 'steady_at_breakpoint', 'equal_eigenvalues', 'grazing_ramp'})
TIES_SHARE = 5.0             # times that share, where nothing but exact arithmetic shows what is right
MOST_REFUSED = 0.03          # of plausible machines
ENOUGH = 200                 # scenes from which on that share means something


class Found(NamedTuple):
    """A scene that was judged wrong."""

    generator: str
    seed: str
    judge: str
    text: str
    case: Case


class Tally:
    """Scenes, refusals and finds, by generator and by judge."""

    def __init__(self) -> None:
        self.scenes: Counter[str] = Counter()
        self.events: Counter[str] = Counter()
        self.refused: Counter[str] = Counter()
        self.undecided: Counter[tuple[str, str]] = Counter()
        self.judged: Counter[str] = Counter()
        self.finds: Counter[tuple[str, str]] = Counter()
        self.refusals: dict[str, str] = {}

    def too_many_refused(self) -> Iterator[str]:
        """Return the plausible generators whose scenes were refused too often."""
        for name in PLAUSIBLE:
            if self.scenes[name] >= ENOUGH and self.refused[name] > MOST_REFUSED * self.scenes[name]:
                yield f'{name}: {self.refused[name]} of {self.scenes[name]} refused: {self.refusals[name]}'


def one_round(seed: str, tally: Tally, names: Sequence[str], count: int = PER_ROUND,
              share: float = REFERENCE_SHARE) -> list[Found]:
    """Make up `count` scenes with each generator and judge them; the same seed makes the same scenes."""
    made: list[tuple[str, str, Case, Run]] = []
    unsound: list[Found] = []
    for name in names:
        for k in range(count):
            tag = f'{seed}/{name}/{k}'
            case = GENERATORS[name](random.Random(tag))
            tally.scenes[name] += 1
            try:
                made.append((name, tag, case, run(case.parts)))
            except UnsoundError as error:
                tally.finds[name, 'itself'] += 1
                unsound.append(Found(name, tag, 'itself', str(error), case))
            except (InputError, SolverError) as error:
                tally.refused[name] += 1
                tally.refusals[name] = str(error)
    found = unsound
    for (name, tag, case, done), wrong in zip(made, _guards([done for *_, done in made])):
        tally.events[name] += done.size
        tally.judged['guards'] += 1
        texts = [('guards', wrong[0])] if wrong else []
        texts += list(_others(done, tag, share * (TIES_SHARE if name in TIES else 1.0), tally, name))
        for judge, text in texts:
            tally.finds[name, judge] += 1
            found.append(Found(name, tag, judge, text, case))
    return found


def judge_again(case: Case, tag: str, reference_too: bool = True) -> list[tuple[str, str]]:
    """Return what all judges find wrong with a scene."""
    try:
        done = run(case.parts)
    except UnsoundError as error:
        return [('itself', str(error))]
    return [('guards', text) for text in _guards([done])[0]] + list(
        _others(done, tag, float(reference_too), Tally(), ''))


def _guards(runs: Sequence[Run]) -> list[list[str]]:
    """Return for each run what is wrong with its guards; under a load that varies smoothly each is judged by itself."""
    linear = iter(guards.judge([run for run in runs if not smooth_load.is_for(run)]))
    return [smooth_load.judge(run) if smooth_load.is_for(run) else next(linear) for run in runs]


def _others(done: Run, tag: str, share: float, tally: Tally, name: str) -> Iterator[tuple[str, str]]:
    rng = random.Random(tag + '/judges')
    judges: dict[str, Callable[[], None]] = {
        'bounds': lambda: bounds.judge(done), 'images': lambda: images.judge(done, rng),
        'parts': lambda: parts.judge(done, rng), 'batch': lambda: batch.judge(done),
        'touch': lambda: touch.judge(done)}
    if done.parts.load is not None:
        judges['brute'] = lambda: brute.judge(done)
    if random.Random(tag + '/reference').random() < share:
        judges['reference'] = lambda: reference.judge(done)
    for judge, work in judges.items():
        tally.judged[judge] += 1
        try:
            work()
        except LastBits as find:
            yield 'bits', str(find)
        except Find as find:
            yield judge, str(find)
        except SolverError as error:
            yield judge, f'refused: {error}'
        except Undecided:
            tally.undecided[name, judge] += 1
