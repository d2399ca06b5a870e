# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Two axes of a scene under a real LinuxCNC: builds the component, runs examples/linuxcnc, prints the circle's figures.

Root installs the component (or sudo that asks for nothing), under a name of its own, and it is removed at the end;
LinuxCNC runs as an ordinary user, `nobody` where this is root.  One machine has room for one LinuxCNC.
"""

import csv
import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import NamedTuple

from stickslip_sim import load_scene
from stickslip_sim.cli.main import run as tool
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.plain_c.hal_files import hal_files
from stickslip_sim.scene import Scene

from .files import ROOT

NAME = 'stickslip_trial'
MODULES = Path('/usr/lib/linuxcnc/modules')
PACKAGES = 'linuxcnc-uspace linuxcnc-uspace-dev'
STILL = {'drive.course': 'constant', 'drive.velocity': 0.0}
PATIENCE = 120.0   # s
_ENVIRONMENT = {'PATH': '/usr/bin:/bin:/usr/sbin:/sbin', 'LANG': 'C.UTF-8'}   # the system's Python, no display
_MM = 1000.0
_AS_ROOT = [] if os.getuid() == 0 else ['sudo', '-n']


def obstacle() -> str:
    """Return why LinuxCNC cannot run here; '' where it can."""
    if not all(map(shutil.which, ('linuxcnc', 'halcompile'))):
        return f'LinuxCNC is not installed: apt install {PACKAGES}'
    if _AS_ROOT and (not shutil.which('sudo') or subprocess.run([*_AS_ROOT, 'true'], capture_output=True).returncode):
        return 'halcompile --install needs root: be root, or let sudo ask for nothing'
    if Path('/tmp/linuxcnc.lock').exists():
        return 'LinuxCNC runs already: end it (or remove /tmp/linuxcnc.lock)'
    return ''


@contextmanager
def installed(scene: Scene) -> Iterator[Path]:
    """Build and install the component of a scene; yield a folder for LinuxCNC to run in, which vanishes at the end."""
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made)
        folder.chmod(0o755)
        for name, text in hal_files(scene).items():
            (folder / name).write_text(text, encoding='utf-8')
        comp = (folder / 'stickslip.comp').read_text(encoding='utf-8')
        comp = comp.replace('component stickslip ', f'component {NAME} ')
        (folder / f'{NAME}.comp').write_text(comp, encoding='utf-8')
        subprocess.run([*_AS_ROOT, 'halcompile', '--install', f'{NAME}.comp'], cwd=folder, env=_ENVIRONMENT, check=True,
                       capture_output=True)
        try:
            yield folder
        finally:
            subprocess.run([*_AS_ROOT, 'rm', '-f', MODULES / f'{NAME}.so'], check=True)


def as_user(command: list[str], folder: Path) -> subprocess.CompletedProcess[str]:
    """Run a command of LinuxCNC in a folder as an ordinary user."""
    user = 'nobody' if os.getuid() == 0 else None
    if user:
        for path in (folder, *folder.rglob('*')):
            shutil.chown(path, user)
    return subprocess.run(command, cwd=folder, user=user, text=True, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                          stderr=subprocess.STDOUT, timeout=PATIENCE, check=False, extra_groups=[] if user else None,
                          env=_ENVIRONMENT | {'HOME': str(folder)})


class Ended(NamedTuple):
    """The exit code of LinuxCNC, what it said, and the samples."""

    code: int
    said: str
    rows: list[list[float]]


def machined(folder: Path, settings: Mapping[str, str] | None = None, program: str = '') -> Ended:
    """Run the example in a new folder inside, with other lines of its INI, or another program."""
    place = Path(tempfile.mkdtemp(dir=folder))
    shutil.copytree(ROOT / 'examples/linuxcnc', place, dirs_exist_ok=True)
    if program:
        (place / 'circle.ngc').write_text(program, encoding='utf-8')
    hal, ini = place / 'cnc.hal', place / 'cnc.ini'
    hal.write_text(hal.read_text().replace('loadrt stickslip ', f'loadrt {NAME} '))
    lines = ini.read_text().splitlines()
    for name, value in (settings or {}).items():
        lines = [f'{name} = {value}' if line.startswith(f'{name} =') else line for line in lines]
    ini.write_text('\n'.join(lines) + '\n')
    ended = as_user(['linuxcnc', 'cnc.ini'], place)
    said = ended.stdout + ''.join(log.read_text(errors='replace') for log in place.glob('linuxcnc_*.txt'))
    record = place / 'circle.csv'
    rows = list(csv.reader(record.read_text().splitlines()))[1:] if record.exists() else []
    return Ended(ended.returncode, said, [[float(word) for word in row] for row in rows])


def differing(scene: Scene, rows: list[list[float]], resolution: float = 0.0) -> int:
    """Return how many samples of both axes the engine does not repeat to the last bit from the recorded velocities."""
    grid, count = Grid(1000.0), 0
    for first in (1, 7):
        simulator, acting = scene.make_simulator(), 0.0
        for n, row in enumerate(rows, 1):
            _, velocity, *recorded = row[first:first + 6]
            if velocity / _MM != acting:
                acting = velocity / _MM
                simulator.inputs.command_drive(acting)
            simulator.advance(grid.instant(n))
            sample = simulator.sample()
            position = sample.position * _MM
            if resolution:
                position = resolution * ((position / resolution + 0.5) // 1.0)
            count += recorded != [position, sample.drive_position * _MM, sample.drive_force, float(sample.mode)]
    return count


def main() -> None:
    """Run the circle on two axes of ball_screw, and print its figures."""
    reason = obstacle()
    if reason:
        print(f'skipped: {reason}')
        return
    scene = load_scene('ball_screw', STILL)
    with installed(scene) as folder:
        code, said, rows = machined(folder)
        if code or not rows:
            raise SystemExit(said or 'LinuxCNC has recorded nothing')
        wrong = differing(scene, rows)
        print(f'{len(rows)} samples by LinuxCNC, {wrong} of them not those of the engine')
        record = next(folder.glob('*/circle.csv'))
        for axis in 'xy':
            tool(['import', str(record), '--columns', f'time=time [s],position={axis} position [mm],'
                  f'drive_position={axis} command [mm]', '--from', '0.85', '--out', str(folder / axis)])
        raise SystemExit(tool(['check', '--circle', str(folder / 'x'), str(folder / 'y')]) or wrong > 0)


if __name__ == '__main__':
    main()
