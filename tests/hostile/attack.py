# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Rounds of made-up scenes: generated, run, judged, counted; and what was found, as files that show it again."""

import json
import random
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any, NamedTuple

from stickslip_sim.core.errors import InputError, SolverError, UnsoundError
from stickslip_sim.inputs import load_scene
from stickslip_sim.proof.judges import Find

from .case import Case, LastBits, Run, Undecided, run
from .generators import GENERATORS, PLAUSIBLE
from .judges import JUDGES, brute, guards, reference

PER_ROUND = 10               # scenes of each generator
REFERENCE_SHARE = 0.02       # of the scenes; one takes a second
TIES = frozenset({'touching', 'ties', 'steady_at_breakpoint', 'equal_eigenvalues', 'grazing_ramp'})
TIES_SHARE = 5.0             # times that share, where nothing but exact arithmetic shows what is right
MOST_REFUSED = 0.03          # of plausible machines
ENOUGH = 200                 # scenes from which on that share means something
_SCENE, _JUDGED = 'scene.yaml', 'judged.json'


class Found(NamedTuple):
    """A scene that was judged wrong."""

    generator: str
    seed: str
    judge: str
    text: str
    case: Case


class Counts:
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


def one_round(seed: str, tally: Counts, names: Sequence[str], count: int = PER_ROUND,
              share: float = REFERENCE_SHARE) -> list[Found]:
    """Make up `count` scenes with each generator and judge them; the same seed makes the same scenes.

    `share` of them is judged by the reference.  With 0 no slow judge is asked: the brute force only where `guards` are.
    """
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
    for (name, tag, case, done), wrong in zip(made, guards.judge([done for *_, done in made])):
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
    return [('guards', text) for text in guards.judge([done])[0]] + list(
        _others(done, tag, float(reference_too), Counts(), ''))


def _others(done: Run, tag: str, share: float, tally: Counts, name: str) -> Iterator[tuple[str, str]]:
    rng = random.Random(tag + '/judges')
    judges: dict[str, Callable[[], object]] = {judge: partial(work, done, rng) for judge, work in JUDGES.items()}
    if done.parts.load is not None or (done.parts.axis.friction.static.scatter is not None and share > 0.0):
        judges['brute'] = partial(brute.judge, done)
    if random.Random(tag + '/reference').random() < share:
        judges['reference'] = partial(reference.judge, done)
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


def write(found: Found, folder: Path, confirmed: str | None) -> Path:
    """Write a scene that was judged wrong, and what was judged; return its folder."""
    place = folder / f'{found.generator}-{found.judge}-{found.seed.replace("/", "-")}'
    place.mkdir(parents=True, exist_ok=True)
    (place / _SCENE).write_text(found.case.scene.text, encoding='utf-8')
    judged: dict[str, Any] = {'generator': found.generator, 'seed': found.seed, 'judge': found.judge,
                            'duration': found.case.duration, 'found': found.text,
                            'again': f'python3 -m tests.hostile --again {place}'}
    if confirmed is not None:
        judged['reference'] = confirmed
    (place / _JUDGED).write_text(json.dumps(judged, indent=1) + '\n', encoding='utf-8')
    return place


def read(place: Path) -> tuple[Case, str]:
    """Return the scene of a folder that `write` made, and the seed of its judges."""
    judged = json.loads((place / _JUDGED).read_text(encoding='utf-8'))
    scene = load_scene(str(place / _SCENE))
    return Case(dict(scene.values), float(judged['duration'])), str(judged['seed'])


def table(tally: Counts) -> str:
    """Return counts by generator and judge."""
    judges = sorted({judge for _, judge in tally.finds})
    lines = [f'{"":20}{"scenes":>8}{"events":>10}{"refused":>9}' + ''.join(f'{judge:>11}' for judge in judges)]
    for name in tally.scenes:
        lines.append(f'{name:20}{tally.scenes[name]:8}{tally.events[name]:10}{tally.refused[name]:9}'
                     + ''.join(f'{tally.finds[name, judge] or "":>11}' for judge in judges))
    lines.append('judged: ' + ', '.join(f'{judge} {count}' for judge, count in tally.judged.items())
                 + f'; undecided {sum(tally.undecided.values())}')
    lines += [f'refused of {name}: {text}' for name, text in tally.refusals.items()]
    return '\n'.join(lines)

