# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip import`: a measured run as a run folder."""

import math
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from .arguments import allow_implausible, verb
from .files import FOLDER, new_folder, say_written, show

if TYPE_CHECKING:
    from ..recording import MeasuredRun

_NOISES = 2.0   # standard deviations, of the velocity
_TELLING = 10**6   # samples that say it
_ABOVE = 1.5    # of the noise: a threshold that it does not reach


@verb('import', short_help='Import a measurement from a file or a bag.')
@click.argument('data', metavar='DATA|BAG')
@click.option('--columns', multiple=True, required=True, metavar='time=T,position=X,...',
              help='Column of each quantity by name or number, or `row`; in a bag, joint_states:position[0].')
@click.option('--unit', multiple=True, metavar='position=mm,...',
              help='Units, with an optional factor: position="-0.05 um" [default: from the headings, or SI].')
@click.option('--lead', metavar='LENGTH', help='Travel per turn, such as "10 mm", to convert rpm, rad/s, deg and N m.')
@click.option('--rated', metavar='FORCE', help='Rated force or torque, such as "2.4 N m", to convert %.')
@click.option('--stiffness', metavar='STIFFNESS',
              help='Stiffness k of the spring that pulls the slider, such as "600 N/mm"; gives x = s - F/k.')
@click.option('--feed', metavar='VELOCITY', help='Velocity of the driven end of that spring, such as "2 mm/s".')
@click.option('--from', 'begin', type=float, default=-math.inf, metavar='SECONDS',
              help='First time to read.')
@click.option('--to', 'end', type=float, default=math.inf, metavar='SECONDS', help='Last time to read.')
@click.option('--every', type=click.IntRange(1), default=1, metavar='N', help='Read every Nth row.')
@click.option('--skip', type=click.IntRange(0), default=0, metavar='LINES', help='Skip the first lines.')
@click.option('--drop-bad-rows', 'drops_bad', is_flag=True, help='Drop rows with missing numbers or decreasing times.')
@click.option('--stick-velocity', type=float, metavar='SPEED',
              help='Speed of a slip in m/s; its peak must exceed 5 times that [default: 5 % of the highest].')
@allow_implausible('Accept an implausible speed or travel of this quantity.', metavar='QUANTITY')
@click.option('--out', type=FOLDER, required=True, metavar='FOLDER', help='New folder for the run.')
def import_(data: str, columns: tuple[str, ...], unit: tuple[str, ...], lead: str | None, rated: str | None,
            stiffness: str | None, feed: str | None, stick_velocity: float | None, meant: tuple[str, ...], out: str,
            **rows: Any) -> None:
    """Import a measurement as a run folder for identify, compare, plot, export and check.

    The quantities are time, position, velocity and acceleration of the slider, drive_position, drive_velocity,
    drive_force, friction_force and external_force.  Modes and cycles are derived from the speed (docs/runs.md).
    """
    from ..core.errors import InputError
    from ..figures.cycles import headline
    from ..inputs.csv_table import Rows
    from ..inputs.measurement import COLUMNS_OPTION, UNIT_OPTION, Measurement, check_plausible_motion, pairs_of
    from ..inputs.units import SPEEDS, STIFFNESSES, stated
    from ..report.model import NOTE, Section, Sentence

    if stick_velocity is not None and not 0.0 < stick_velocity < 1e6:
        raise InputError('--stick-velocity', stick_velocity, '> 0 and < 1e6 m/s', '0.1 mm/s is 1e-4')
    named = pairs_of(COLUMNS_OPTION, columns)
    units = pairs_of(UNIT_OPTION, unit) if unit else {}
    measured = Measurement.from_file(data, named, units, lead, Rows(**rows), rated)
    if stiffness or feed:
        measured = measured.with_spring(stated('--stiffness', stiffness or '', STIFFNESSES),
                                        None if feed is None else stated('--feed', feed, SPEEDS))
    check_plausible_motion(measured, meant)
    given = {'file': Path(data).name, 'columns': _joined(named), 'units': _joined(units), 'lead': lead, 'rated': rated,
             'stick_velocity': None if stick_velocity is None else repr(stick_velocity)}
    title = f'{len(measured.times)} rows, {measured.times[-1] - measured.times[0]:.6g} s: {", ".join(measured.columns)}'
    with new_folder('--out', out) as folder:
        inner = folder / Path(out).name
        measured.write(inner, {name: word for name, word in given.items() if word is not None})
        for path in inner.iterdir():
            path.rename(folder / path.name)
        inner.rmdir()
    run = measured.as_run(out)
    show([Section(f'{run.name}: {title}',
                  [headline(run.summary), *(Sentence(note, NOTE) for note in (*run.notes, *_of_noise(run)))])])
    say_written(out)


def _of_noise(run: 'MeasuredRun') -> Iterator[str]:
    """Yield what is wrong with the threshold of a slip where noise of the velocity reaches it."""
    from ..identification.readings import own_noise_of, quantum_of
    from ..report.quantity import quantity

    velocity = run.samples['velocity'][:_TELLING]
    quantum = quantum_of(velocity)
    noise = max(_NOISES * own_noise_of(velocity, quantum), quantum)
    if run.stick_velocity < noise:
        yield (f'the threshold of a slip, {quantity(run.stick_velocity, "m/s", 3)}, lies below the noise of the '
               f'velocity, {quantity(noise, "m/s", 3)}: slips, periods and times in stick may be noise; smooth it '
               f'before, or import it with --stick-velocity {_ABOVE * noise:.2g}')


def _joined(pairs: dict[str, str]) -> str:
    return ','.join(f'{name}={word}' for name, word in pairs.items())
