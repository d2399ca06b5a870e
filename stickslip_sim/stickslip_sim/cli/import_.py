# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip import`: a measured run as a run folder."""

from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from .arguments import verb
from .files import FOLDER, new_folder, say_written, show

if TYPE_CHECKING:
    from ..recording import MeasuredRun

_NOISES = 2.0   # standard deviations, of the velocity
_ABOVE = 1.5    # of the noise: a threshold that it does not reach


@verb('import', short_help='Make a run folder of a measurement, from a CSV file or a bag.')
@click.argument('data', metavar='DATA.csv|BAG')
@click.option('--columns', multiple=True, required=True, metavar='time=T,position=X,...',
              help='The column of each quantity; of a bag TOPIC:FIELD, as joint_states:position[0].')
@click.option('--unit', multiple=True, metavar='position=mm,...',
              help='Units of the columns [default: SI], with a factor if need be: position="-0.05 um".')
@click.option('--stick-velocity', type=float, metavar='V',
              help='A slip is faster than this, m/s, and at its peak than 5 times it [default: 5 % of the highest].')
@click.option('--meant', multiple=True, metavar='QUANTITY', help='It is meant as it was read, however fast or far.')
@click.option('--out', type=FOLDER, required=True, metavar='RUN_FOLDER', help='New folder of the run.')
def import_(data: str, columns: tuple[str, ...], unit: tuple[str, ...], stick_velocity: float | None,
            meant: tuple[str, ...], out: str) -> None:
    """Make a run folder of what was measured, for identify, compare, plot, export and check.

    There is nothing else in it.  The quantities are time, position, velocity and acceleration of the slider,
    drive_position, drive_velocity, drive_force, friction_force, external_force.  Modes and cycles are derived from the
    speed (docs/runs.md).
    """
    from ..core.errors import InputError
    from ..figures.wording import headline
    from ..inputs.measurement import COLUMNS_OPTION, UNIT_OPTION, check_plausible_motion, load_measurement, pairs_of
    from ..recording import MeasuredRun, read_run, write_measured
    from ..report.model import NOTE, Section, Sentence

    if stick_velocity is not None and not 0.0 < stick_velocity < 1e6:
        raise InputError('--stick-velocity', stick_velocity, '> 0 and < 1e6 m/s', '0.1 mm/s is 1e-4')
    named = pairs_of(COLUMNS_OPTION, columns)
    units = pairs_of(UNIT_OPTION, unit) if unit else {}
    measured = load_measurement(Path(data), named, units)
    check_plausible_motion(measured, meant)
    facts = {'file': Path(data).name, 'columns': _joined(named), 'units': _joined(units),
             **({} if stick_velocity is None else {'stick_velocity': repr(stick_velocity)}),
             **({'remark': measured.remark} if measured.remark else {})}
    with new_folder('--out', out) as folder:
        inner = folder / Path(out).name
        write_measured(inner, measured.times, measured.columns, facts)
        for path in inner.iterdir():
            path.rename(folder / path.name)
        inner.rmdir()
    run = read_run(out)
    assert isinstance(run, MeasuredRun)
    show([Section(f'{run.name}: {len(measured.times)} rows, {run.duration:.6g} s: {", ".join(measured.columns)}',
                  [headline(run.summary), *(Sentence(note, NOTE) for note in (*run.notes, *_of_noise(run)))])])
    say_written(out)


def _of_noise(run: 'MeasuredRun') -> Iterator[str]:
    """Yield what is wrong with the threshold of a slip where noise of the velocity reaches it."""
    from ..identification.readings import own_noise_of, quantum_of
    from ..report.quantity import quantity

    velocity = run.samples['velocity']
    quantum = quantum_of(velocity)
    noise = max(_NOISES * own_noise_of(velocity, quantum), quantum)
    if run.stick_velocity < noise:
        yield (f'the threshold of a slip, {quantity(run.stick_velocity, "m/s", 3)}, lies below the noise of the '
               f'velocity, {quantity(noise, "m/s", 3)}: slips, periods and times in stick may be noise; smooth it '
               f'before, or import it with --stick-velocity {_ABOVE * noise:.2g}')


def _joined(pairs: dict[str, str]) -> str:
    return ','.join(f'{name}={word}' for name, word in pairs.items())
