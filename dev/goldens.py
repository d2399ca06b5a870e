# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What every verb of the tool writes for every shipped scene, kept in a folder, and compared with that of another time.

    python3 -m dev.goldens runs/goldens/before
    python3 -m dev.goldens runs/goldens/after --against runs/goldens/before

A change of the house that changes no result changes none of it.  Times, versions and places are left out.  Bags are
kept as the hashes of their messages.  Exit code 1 when anything differs.
"""

import argparse
import hashlib
import os
import re
import shlex
import subprocess
import sys
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

from stickslip_sim.recording import open_bag

from .files import ROOT

SCENES = sorted(path.stem for path in (ROOT / 'stickslip_sim/stickslip_sim/scenes').glob('*.yaml'))
OF_A_SCENE = (
    'simulate {0} --duration 4',
    'simulate {0} --duration 4 --knots --events events.csv --samples samples.csv --sample-period 0.01'
    ' --receipt receipt.json --plot run.png --bag bag',
    'simulate {0} --duration 1 --set solver.name=fixed_step --set solver.step=1e-4 --receipt fixed_step.json',
    'simulate {0} --duration 1 --set solver.name=adaptive --receipt adaptive.json',
    'plot {0} --duration 3 --out scene.svg',
    'plot bag --out bag.png',
    'verify bag',
    'verify bag --set axis.mass=300 --out what_if',
    'export bag --csv states.csv',
    'check {0} --duration 4 --limits limits.yaml --junit limits.xml',
    'compare {0} --out compared',
    'sweep {0} --over axis.normal_force=2000:4000:7 --duration 5 --out swept',
    'sweep {0} --over axis.normal_force=2000:4000:5 --over axis.mass=100:400:4:log --duration 5 --out mapped',
    'map swept --out swept.png',
    'map mapped --out mapped.png',
    'critical {0} --of axis.normal_force --between 1000:5000 --accuracy 1e-6',
    'design {0} --for axis.mass,friction.static.initial --out designed',
)
ONCE = (
    'scenes',
    'friction friction_curve.csv --speed-unit mm/s --out law.yaml',
    'import identify/axis.csv --columns time=time,position=position,drive_force=drive_force --out axis',
    'identify axis --scene identify/start.yaml --free identify/free.yaml --out found',
    'compare axis found/identified.yaml --out beside',
    'uncertainty found/identified.yaml --with found/posterior.yaml --set drive.course=constant'
    ' --set drive.velocity=0.002 --samples 16 --out spread',
    'extremes --quick --only X1,X5,X9,X14 --out extremes.json',
    *(f'{verb} --help' for verb in (
        'simulate', 'import', 'call', 'plot', 'compare', 'export', 'check', 'verify', 'critical', 'sweep', 'map',
        'uncertainty', 'friction', 'identify', 'design', 'advise', 'bench')),
)
VARIES = re.compile(
    r'"(?:cost|versions?|platform|python|numpy|cpu\w*|wall\w*|seconds|hot_path|library|date|host)": '
    r'(?:\{[^{}]*\}|[^,\n}]+)|(?:cost|wall|time) +\S+ \S*s CPU.*|in [\d.e+-]+ (?:µs|us|ms|s|min)\b'
    r'|[\d.]+ (?:µs|us|ms|s) of CPU\b'
    r'|\d{4}-\d\d-\d\d[T ]\d\d:\d\d\S*')
_SHOWN = 100     # characters of a line
TEXT = {'.txt', '.json', '.yaml', '.csv', '.xml', '.html', '.svg'}


def commands() -> dict[str, list[str]]:
    """Return the commands by their place; those of a place need each other, in this order."""
    return {**{scene: [command.format(scene) for command in OF_A_SCENE] for scene in SCENES}, 'once': [*ONCE]}


def run(place: Path, words: list[str]) -> None:
    """Run the commands of a place one after the other, and keep what each prints."""
    place.mkdir(parents=True)
    for name in ('limits.yaml', 'friction_curve.csv', 'identify'):
        (place / name).symlink_to(ROOT / 'examples' / name)
    for k, command in enumerate(words):
        done = subprocess.run([sys.executable, '-m', 'stickslip_sim', *shlex.split(command)], cwd=place, text=True,
                              capture_output=True, check=False,
                              env={**os.environ, 'COLUMNS': '120', 'OPENBLAS_NUM_THREADS': '1'})
        said = f'$ stickslip {command}\n{done.stdout}-- {done.returncode}\n{done.stderr}'
        (place / f'said_{k:02}.txt').write_text(said.replace(str(place), '.'), encoding='utf-8')


def digests(folder: Path) -> dict[str, str]:
    """Return the hash of each file below a folder, as it is compared."""
    found: dict[str, str] = {}
    for path in sorted(path for path in folder.rglob('*') if path.is_file() and not path.is_symlink()):
        name = str(path.relative_to(folder))
        if path.suffix == '.mcap':
            found[name] = _of(repr([(m.topic, m.log_time, m.sequence, m.data.hex()) for m in open_bag(path).messages()
                                    if m.topic != '/run_info']))
        elif path.name not in {'metadata.yaml', 'timings.json'}:
            data = path.read_bytes()
            found[name] = _of(compared(data.decode()) if path.suffix in TEXT else data)
    return found


def compared(text: str) -> str:
    """Return a text without what differs from run to run."""
    return VARIES.sub('', text)


def differing(folder: Path, before: Path) -> Iterator[str]:
    """Yield what differs between two folders, a line each: the file, and its first lines that differ."""
    ours, theirs = digests(folder), digests(before)
    for name in sorted({*ours, *theirs}):
        if ours.get(name) == theirs.get(name):
            continue
        if name in ours and name in theirs:
            yield f'{name}: {_first_line(folder / name, before / name)}'
        else:
            yield f'{name}: {"new" if name in ours else "missing"}'


def main() -> int:
    """Make the folder, and compare it; return the exit code."""
    parser = argparse.ArgumentParser(prog='python3 -m dev.goldens', description=__doc__.splitlines()[0])
    parser.add_argument('folder', type=Path)
    parser.add_argument('--against', type=Path)
    options = parser.parse_args()
    with ThreadPoolExecutor(os.cpu_count()) as pool:
        list(pool.map(lambda of: run(options.folder.resolve() / of[0], of[1]), commands().items()))
    if options.against is None:
        return 0
    lines = list(differing(options.folder, options.against))
    sys.stdout.write('\n'.join(lines or ['nothing differs']) + '\n')
    return 1 if lines else 0


def _of(data: Any) -> str:
    return hashlib.sha256(data.encode() if isinstance(data, str) else data).hexdigest()


def _first_line(ours: Path, theirs: Path) -> str:
    if ours.suffix not in TEXT:
        return 'differs'
    pairs = zip(*(compared(path.read_text(encoding='utf-8')).splitlines() for path in (theirs, ours)))
    return next((f'{before.strip()[:_SHOWN]!r} is {after.strip()[:_SHOWN]!r}' for before, after in pairs
                 if before != after), 'differs')


if __name__ == '__main__':
    sys.exit(main())
