# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The sections of the page on other methods, and on data of another model."""

from collections.abc import Mapping, Sequence
from statistics import median

from stickslip_sim.report.markdown import markdown_table

from .foreign import ForeignOutcome
from .mujoco_sysid import INSTALL, is_installed
from .outcomes import CLOSE
from .rivals import RivalOutcome

_FOREIGN_MARK = 5   # %
_STATEMENTS = 4     # of the misfit that are shown
_LEGEND = (
    '* Least squares: `scipy.optimize.least_squares` with its defaults, over the whole run, simulated by semi-implicit',
    '  Euler at 0.1 ms with the laws of the axis (`solver.name: fixed_step`).',
    '* `mujoco.sysid`, our laws: its optimizer with its defaults, on the same residuals.',
    '* `mujoco.sysid`, own friction: a slide joint with `frictionloss` and `damping`, which has no static limit that',
    '  grows with rest and no falling curve.  Only mass, stiffness and damping of the drive have an error, if free.',
)


def beside(rivals: Mapping[str, Sequence[RivalOutcome]]) -> list[str]:
    """Return the section on other methods."""
    missing = [] if is_installed() else [f'`mujoco.sysid` is not installed here: `{INSTALL}`.', '']
    return ['## Beside others', '', 'The same data, starts and ranges, one core, one after the other:', '',
            *markdown_table(('method', 'axes', f'parameters within {CLOSE:.0%}', 'error, median', 'error, largest',
                             'processor time, median', 'simulations, median'),
                            [_rival(name, of) for name, of in rivals.items()]), '', *missing, *_LEGEND, '']


def foreign_data(foreign: ForeignOutcome) -> list[str]:
    """Return the section on the LuGre axis."""
    single = [_row(title, foreign.differences_of_slips(name), f'{_FOREIGN_MARK} %')
              for title, name in (('break-away force', 'break_away_force'), ('stick time', 'stick_time'))]
    alone = [_row(f'{title}, the scene left to itself', foreign.differences(name), '')
             for title, name in (('break-away force', 'force'), ('stick time', 'stick_time'))]
    return [
        '## Data of another model', '',
        'An axis with LuGre friction, integrated by SciPy to a tolerance of 1e-9: bristles bend before the slider',
        'slides, and static friction knows no rest time.  Our laws cannot be right for it; the tool must say so.', '',
        f'* Said to fit: {"yes" if foreign.fits else "no"} (right: no).',
        *(f'* {statement}' for statement in foreign.statements[:_STATEMENTS]),
        *([f'* … and {more} more statements.'] if (more := len(foreign.statements) - _STATEMENTS) > 0 else []),
        f'* Slips: {foreign.true_slips} of the LuGre axis, {foreign.found_slips} of the scene found.',
        f'* Processor time: {foreign.seconds:.1f} s.', '',
        *markdown_table(('of the slips, each from the measured arrest before it', 'difference, median', 'largest',
                         'mark'), [*single, *alone]), '',
        'Left to itself the scene comes to the next change of the feed at another moment of its cycle, and the slip',
        'there is another one.', '']


def _row(title: str, of: Sequence[float], mark: str) -> list[str]:
    return [title, *([f'{100.0 * median(of):.1f} %', f'{100.0 * of[-1]:.1f} %'] if of else ['–', '–']), mark]


def share(part: float) -> str:
    """Return a share in %, with two digits."""
    return f'{100.0 * part:.0f} %' if part >= 0.995 else f'{100.0 * part:.2g} %'


def _rival(name: str, of: Sequence[RivalOutcome]) -> list[str]:
    errors = [error for each in of for error in each.errors]
    close = 100.0 * sum(error <= CLOSE for error in errors) / len(errors) if errors else 0.0
    return [name, str(len(of)), f'{close:.0f} % of {len(errors)}',
            *([share(median(errors)), share(max(errors))] if errors else ['–', '–']),
            f'{median(each.seconds for each in of):.1f} s', f'{median(each.runs for each in of):,.0f}']
