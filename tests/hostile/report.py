# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What was found, as files that show it again, and as a table."""

import json
from pathlib import Path
from typing import Any

from stickslip_sim.inputs import load_scene

from .attack import Found, Tally
from .case import Case

SCENE, JUDGED = 'scene.yaml', 'judged.json'


def write(found: Found, folder: Path, reference: str | None) -> Path:
    """Write a scene that was judged wrong, and what was judged; return its folder."""
    place = folder / f'{found.generator}-{found.judge}-{found.seed.replace("/", "-")}'
    place.mkdir(parents=True, exist_ok=True)
    (place / SCENE).write_text(found.case.scene.text, encoding='utf-8')
    judged: dict[str, Any] = {'generator': found.generator, 'seed': found.seed, 'judge': found.judge,
                            'duration': found.case.duration, 'found': found.text,
                            'again': f'python3 -m tests.hostile --again {place}'}
    if reference is not None:
        judged['reference'] = reference
    (place / JUDGED).write_text(json.dumps(judged, indent=1) + '\n', encoding='utf-8')
    return place


def read(place: Path) -> tuple[Case, str]:
    """Return the scene of a folder that `write` made, and the seed of its judges."""
    judged = json.loads((place / JUDGED).read_text(encoding='utf-8'))
    scene = load_scene(str(place / SCENE))
    return Case(dict(scene.values), float(judged['duration'])), str(judged['seed'])


def table(tally: Tally) -> str:
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

