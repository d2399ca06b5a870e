# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A loop about stick and about slip: Bode diagrams, step response, and what it does with friction."""

import math
from collections.abc import Mapping
from pathlib import Path
from typing import NamedTuple

import numpy as np
from matplotlib.axes import Axes
from numpy.typing import NDArray

from ..core.arrays import Flags, Numbers
from .style import BLACK, BLUE, DOUBLE_COLUMN, GREY, RED, SKY, journal, legend_of, letters, shortened, thinned

_COLOURS = {'stick': BLUE, 'slip': RED}
_LOOKS = {'stick': (0, (5.0, 2.0)), 'slip': 'solid'}
_HEIGHT = 6.2          # in
_TITLE = 60            # letters
_MICRO = 1e6
_JUMP = 180.0          # degrees
_DECADES = 4.0         # of frequencies


class BodeLines(NamedTuple):
    """Responses at `frequencies` (Hz) of the slider to the command (s) and of the open loop; step response or None."""

    frequencies: Numbers
    slider: NDArray[np.complex128]
    open: NDArray[np.complex128]
    step: tuple[Numbers, Numbers] | None


def plot_tuning(loops: Mapping[str, BodeLines], error: tuple[Numbers, Numbers, Flags],
                closer: tuple[float, float] | None, title: str, path: Path | str) -> None:
    """Draw loops by mode (stick, slip), and the slider's `error`: times (s), off the setpoint (m), whether it sticks.

    The error is drawn once more `closer`, from one time to another (s).
    """
    with journal(DOUBLE_COLUMN, _HEIGHT, path, pads=(0.06, 0.05)) as figure:
        (gain, step), (phase, swing), (plant, late) = figure.subplots(3, 2)
        for mode, lines in loops.items():
            lines = _readable(lines)
            look = {'color': _COLOURS[mode], 'linestyle': _LOOKS[mode], 'label': f'about {mode}'}
            _bode(gain, lines.frequencies, lines.open, look)
            _bode(plant, lines.frequencies, lines.slider, look)
            if np.any(lines.open):
                phase.semilogx(lines.frequencies, _phase(lines.open), **look)
            if lines.step is not None:
                step.plot(*lines.step, **look)
        gain.set(ylabel='open loop |L| / dB')
        phase.set(ylabel='phase of L / °', yticks=range(-360, 1, 90))
        plant.set(ylabel='slider / command / dB', xlabel='frequency / Hz')
        step.set(ylabel='slider / setpoint step', xlabel='time / s')
        _over_time(swing, *error)
        if closer is not None:
            times, off, sticks = error
            within = (times >= closer[0]) & (times <= closer[1])
            _over_time(late, times[within], off[within], sticks[within])
        for panel, level, missing in ((gain, 0.0, 'nothing linear'), (phase, -180.0, 'nothing linear'),
                                      (plant, None, 'nothing linear'), (late, None, 'no swing lasts'),
                                      (step, 1.0, 'no stable loop follows a setpoint')):
            if not panel.has_data():
                panel.text(0.5, 0.5, missing, transform=panel.transAxes, ha='center', va='center', color=GREY)
                panel.set(xticks=[], yticks=[])
            elif level is not None:
                panel.axhline(level, color=GREY, linewidth=0.8)
        letters((gain, phase, plant, step, swing, late))
        legend_of(figure, 'upper right', gain, swing, ncols=3)
        figure.text(0.01, 0.99, shortened(title, _TITLE), va='top', fontweight='bold', fontsize=9.0)


def _readable(lines: BodeLines) -> BodeLines:
    shown = lines.frequencies >= lines.frequencies[-1] * 10.0 ** -_DECADES
    return BodeLines(lines.frequencies[shown], lines.slider[shown], lines.open[shown], lines.step)


def _bode(panel: Axes, frequencies: Numbers, response: NDArray[np.complex128], look: Mapping[str, object]) -> None:
    if np.all(response):
        panel.semilogx(frequencies, 20.0 * np.log10(np.abs(response)), **look)


def _phase(response: NDArray[np.complex128]) -> Numbers:
    """Return the phase in degrees from −360 to 0, nothing where it jumps."""
    phase: Numbers = (np.degrees(np.angle(response)) - 360.0) % -360.0
    phase[1:][np.abs(np.diff(phase)) > _JUMP] = math.nan
    return phase


def _over_time(panel: Axes, times: Numbers, error: Numbers, sticks: Flags) -> None:
    panel.plot(*thinned(times, _MICRO * error), color=BLACK, linewidth=0.8)
    panel.fill_between(times, 0.0, 1.0, where=sticks.tolist(), transform=panel.get_xaxis_transform(), color=SKY,
                       alpha=0.35, linewidth=0.0, label='the slider sticks')
    panel.set(ylabel='slider − setpoint / µm', xlabel='time / s')
    panel.margins(x=0.0)
