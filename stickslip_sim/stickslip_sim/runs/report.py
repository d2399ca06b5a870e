# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A run for people: its motion, the figures of its cycles, its energy and cost; its name, and a window of it."""

from collections.abc import Iterable, Iterator
from itertools import chain, count
from typing import NamedTuple

from ..core.errors import InputError
from ..figures.cycles import LABEL, miss_note, summary_report
from ..report.model import Part, facts
from ..report.quantity import quantity
from ..scene.values import file_name
from .run import Run
from .simulated import SimulatedRun


def run_report(run: SimulatedRun) -> Iterator[Part]:
    """Yield all that is said of a run that was simulated."""
    cost, energy, note = run.receipt['cost'], run.receipt['energy'], miss_note(run.scene)
    yield f'{run.scene.name}: {run.duration:g} s with the {run.scene.solver.name} solver'
    if note:
        yield facts([('note', note)], LABEL)
    yield from summary_report(run.summary)
    if energy is not None:
        yield facts([('energy', f'{quantity(energy["drive_work"], "J")} from the drive, '
                                f'{quantity(energy["friction_loss"], "J")} to friction; '
                                f'the balance closes to {energy["relative_residual"]:.1g} of the throughput')], LABEL)
    yield facts([('cost', f'{quantity(cost["cpu_time_s"], "s")} CPU, '
                          f'{quantity(cost["cpu_time_per_simulated_second"], "s")} per simulated second')], LABEL)


def file_stem(run: Run) -> str:
    """Return the name of a run as that of a file, without an ending: sweep_1.0 stays sweep_1.0."""
    return file_name(run.name.removesuffix('.mcap') if run.is_recorded else run.name)


def named_apart(runs: Iterable[Run]) -> dict[str, Run]:
    """Give each run a name of its own that is good for a file, too."""
    named: dict[str, Run] = {}
    for run in runs:
        stem = file_stem(run)
        named[next(name for name in chain([stem], (f'{stem}_{k}' for k in count(2))) if name not in named)] = run
    return named


_FIRST_COMMAND = 'first_command'


class Window(NamedTuple):
    """A part of a run, asked for in a `text`: from `begin` (s; None: the first command) to `end` (s, after that)."""

    text: str
    begin: float | None
    end: float

    @classmethod
    def of(cls, text: str) -> 'Window':
        """Return the window A:B or A:+B; raises InputError."""
        first, _, last = text.partition(':')
        try:
            begin = None if first == _FIRST_COMMAND else float(first)
            end = float(last) + (begin or 0.0 if last.startswith('+') else 0.0)
            is_good = end > (0.0 if begin is None else begin) and (begin is not None or last.startswith('+'))
        except ValueError:
            is_good = False
        if not is_good:
            raise InputError('--window', text, f'A:B or A:+B, times in s, A before B; or {_FIRST_COMMAND}:+B',
                             'for example 2.5:4')
        return cls(text, begin, end)

    def in_run(self, run: Run) -> tuple[float, float]:
        """Return the times of a run, s; raises InputError in one without the command that the window begins with."""
        if self.begin is not None:
            return self.begin, self.end
        from .picture import first_command  # matplotlib takes half a second

        first = first_command(run)
        if first is None:
            raise InputError('--window', self.text, 'A:B in a run without commands', 'give two times of the run, in s')
        return first, first + self.end
