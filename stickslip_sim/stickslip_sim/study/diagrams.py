# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Studies as pictures: maps, bifurcation diagrams, spreads; the lines and points in them, in numbers."""

import math
from collections.abc import Mapping, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..core.arrays import Numbers
from ..core.errors import InputError
from ..core.types import Event, Instant, Progress
from ..figures.catalogue import unit_of
from ..figures.cycles import Cycle, cycle_figures
from ..figures.point_figures import Figures, Motion, figures_of_runs
from ..plots.stability_map import Field, Lines, Pick, plot_bifurcation, plot_stability
from ..plots.style import Scale, unit_read
from ..plots.uncertainty import Shares, Spread, plot_uncertainty
from ..runs import SimulatedRun, simulate_events
from ..scene import Scene
from .critical import CriticalSpread, CriticalStudy, feed_of_theory
from .points import runs_of_run, scene_at, sliding_slope, works_in_batches
from .sample import EvenGrid, Saltelli
from .study import Study
from .table import TableColumns, figures_among
from .uncertainty import SPREAD, Index, Uncertainty, spread_of
from .variation import Variation, place_of

_LAST = 40     # cycles of each point that are shown, or half of all
_REACH = 1.5   # times as long as they take on average: where that was not enough all of the run is looked at


class Bifurcation(NamedTuple):
    """`cycles`: a row (value, drive force at break-away and at arrest in N, jump in m) for each of the last cycles.

    `sliding`: a row (value, drive force of steady sliding in N, 1 where it is stable) for each value, NaN where the
    drive rests; empty for inputs that change with time.
    """

    cycles: Numbers
    sliding: Numbers


def bifurcation(study: Study, figures: Figures, progress: Progress = None) -> Bifurcation:
    """Return the last cycles of each point of a study of one parameter that sticks and slips.

    Such a point is run again, for the duration of its `figures`: the table has one round alone, without the arrest.
    Only its last cycles are looked at.
    """
    cycles, sliding = [], []
    values = study.points(0, study.count)[:, 0].tolist()
    for k, value in enumerate(values):
        scene = scene_at(study.values, study.names, np.array([value]))
        if figures.motion[k] == Motion.STICK_SLIP:
            cycles += [(value, cycle.break_away_drive_force, cycle.arrest_drive_force, cycle.jump)
                       for cycle in _last_cycles(scene, float(figures.duration[k]), int(figures.cycles[k]))]
        feed = scene.drive.values[0]
        if study.works_in_batches:
            friction = scene.axis.normal_force * scene.axis.friction.along(feed).kinetic.coefficient(abs(feed))
            slope = sliding_slope(scene.axis, {'drive_velocity': np.array([feed])})[0]
            force = np.copysign(friction, feed) - scene.force.values[0] if feed else np.nan
            sliding.append((value, force, float(slope >= 0.0)))
        if progress:
            progress((k + 1) / len(values))
    return Bifurcation(np.array(cycles).reshape(-1, 4), np.array(sliding).reshape(-1, 3))


def _last_cycles(scene: Scene, duration: float, count: int) -> list[Cycle]:
    """Return the last cycles of a scene that has so many in its duration (s)."""
    wanted = min(count - count // 2, _LAST)
    if works_in_batches(scene):
        begin = duration * (1.0 - _REACH * (wanted + 2) / count)
        found = cycle_figures(_events_from(scene, begin, duration)) if begin > 0.0 else []
        if len(found) >= wanted:
            return found[-wanted:]
    return cycle_figures(simulate_events(scene, duration).events)[-wanted:]


def _events_from(scene: Scene, begin: float, end: float) -> list[Event]:
    """Return the events of a scene from a time on (s); those before are not looked at, which takes most of the time."""
    simulator = scene.make_simulator()
    simulator.skip(Instant(math.floor(begin), begin % 1.0))
    return simulator.advance(Instant(math.floor(end), end % 1.0))


# Lines that the theory draws into a map of feed against another parameter.

FEED = 'drive.velocity'
_FINE = 300   # values of either parameter


def borders(study: Study) -> Lines | None:
    """Return the lines for a study of the feed and one more parameter, over that; None for any other study."""
    variations = {one.name: one for one in study.ranges}
    feed = variations.pop(FEED, None)
    if feed is None or len(variations) != 1 or not study.works_in_batches:
        return None
    (other,) = variations.values()
    others, feeds = _finely(other), _finely(feed)
    axes = [scene_at(study.values, [other.name], np.array([value])).axis for value in others]
    known = [feed_of_theory(axis) for axis in axes]
    critical = np.array([np.nan if value is None else value for value in known], dtype=float)
    slopes = np.array([sliding_slope(axis, {'drive_velocity': feeds}) for axis in axes])
    return Lines(others, critical, feeds, np.where(np.isnan(slopes), np.nan, slopes < 0.0))


def _finely(one: Variation) -> Numbers:
    return Variation(one.name, one.low, one.high, _FINE, one.log).grid()


# Points picked from the map of a study: where they stand, and the motion that they end in.

class Ending(NamedTuple):
    """The motion that a point ends in, and the events of the run after which that was known.

    `swings_on`: it slides, and still swung when its time was over.
    """

    motion: Motion
    swings_on: bool
    run: SimulatedRun


def point_of(study: Study, text: str) -> Numbers:
    """Return the values `A,B` of the two parameters of a study; raises InputError."""
    try:
        point = np.array([float(word) for word in text.split(',')])
    except ValueError:
        point = np.array([])
    variations = study.ranges
    if len(point) != len(variations) or any(not one.low <= value <= one.high for one, value in zip(variations, point)):
        ranges = ', '.join(f'{one.name} from {one.low:g} to {one.high:g}' for one in variations)
        raise InputError('--pick', text, f'a number for each of {ranges}', 'give them with a comma: A,B')
    return point


def place_in_map(study: Study, point: Numbers) -> tuple[float, float]:
    """Return where a point stands in the map: x, y."""
    first, second = point.tolist()
    return (second, first) if study.names[1] == FEED else (first, second)


def ending_at(study: Study, columns: TableColumns, point: Numbers) -> Ending:
    """Return the ending of a point; its motion is that of the table (`columns`) where the point stands in it."""
    scene = study.scene_at(point)
    stands = np.logical_and.reduce([columns[name] == value for name, value in zip(study.names, point)])
    known = np.flatnonzero(stands & (columns['motion'] != Motion.FAILED))
    if not len(known) and study.duration is not None:
        run = simulate_events(scene, study.duration)
        return Ending(Motion(int(figures_of_runs(runs_of_run(run)).motion[0])), False, run)
    if len(known):
        motion, duration = (float(columns[name][known[0]]) for name in ('motion', 'duration'))
    else:
        runs = study.runs(point[None, :])
        motion = float(figures_of_runs(runs).motion[0])
        duration = float(runs.duration[0])
    swings_on = study.duration is None and motion == Motion.SWINGS_ON
    return Ending(Motion(int(motion)), swings_on, simulate_events(scene, duration))


# The pictures of studies.

_DRAWABLE = (*SPREAD, 'cycles', 'duration')
_PLAIN = {Motion.AT_REST: 2, Motion.SMOOTH_SLIDING: 0, Motion.SWINGS_ON: 1, Motion.FAILED: 3,
          Motion.UNDECIDED: 4}


def check_drawable(study: Study, shown: str) -> None:
    """Raise InputError unless a study can be drawn, and the figure `shown` in colours."""
    if not isinstance(study.sample, EvenGrid) or len(study.names) > 2:
        raise InputError('--over', ', '.join(study.names), 'a grid of two parameters for a map, of one for a'
                         ' bifurcation diagram', 'read other studies from their table')
    if shown not in _DRAWABLE:
        raise InputError('--show', shown, 'one of ' + ', '.join(_DRAWABLE), 'leave it out for the amplitude')


def draw_bifurcation(study: Study, columns: TableColumns, paths: Sequence[str], progress: Progress = None) -> None:
    """Draw the last cycles over the one parameter of a study into each of `paths`."""
    found = bifurcation(study, figures_among(columns), progress)
    (over,) = study.ranges
    for path in paths:
        plot_bifurcation(_scale(study, over), found.cycles, found.sliding, path)


def draw_map(study: Study, columns: TableColumns, shown: str, picks: Sequence[Pick], paths: Sequence[str]) -> None:
    """Draw one figure over the two parameters of a study, the feed along x, into each of `paths`."""
    first, second = study.ranges
    turned = second.name == FEED
    x, y = (second, first) if turned else (first, second)

    def table(values: Numbers) -> Numbers:
        grid = values.reshape(first.count, second.count)
        return grid if turned else grid.T

    motion = table(columns['motion'])
    values = np.where(motion == Motion.STICK_SLIP, table(columns[shown]), np.nan)
    field = Field(x.grid(), y.grid(), values, _plain(motion, table(columns['settled'])))
    lines = borders(study)
    scales = _scale(study, x), _scale(study, y), Scale(shown, unit_read(unit_of(shown), values))
    for path in paths:
        plot_stability(scales, field, lines, picks, path)


def draw_uncertainty(study: Study, sample: Saltelli, columns: TableColumns, found: Uncertainty, path: str) -> None:
    """Draw how the figures of a sample spread, and the indices of those that have them."""
    spreads = [Spread(Scale(name, unit_read(unit_of(name), values)), values, found.percentiles[name] or ())
               for name, values in spread_of(sample, columns).items()]
    heading = ('of no point it is known' if found.stick_slip is None else
               f'{100.0 * found.stick_slip:.3g} % of {found.known} points stick and slip')
    _draw_spreads(study, spreads, heading, found.indices, path)


def draw_critical_spread(study: CriticalStudy, found: Mapping[str, CriticalSpread], path: str) -> None:
    """Draw how the critical values from rest and from sliding spread, and the indices of those that have them."""
    over = study.over
    spreads = [Spread(Scale(f'critical {over.name} {start}', unit_read(over.unit, one.values)), one.values,
                      one.percentiles or ()) for start, one in found.items()]
    heading = f'{next(iter(found.values())).points} independent points'
    _draw_spreads(study.study, spreads, heading, {start: one.indices for start, one in found.items()}, path)


def _draw_spreads(study: Study, spreads: Sequence[Spread], heading: str,
                  indices: Mapping[str, Mapping[str, Index] | None], path: str) -> None:
    shares = [Shares(figure, *np.array([of[name] for name in study.names]).T) for figure, of in indices.items() if of]
    labels = [Scale(name, '', place=place_of(study.values, name)).label for name in study.names]
    plot_uncertainty(spreads, heading, labels, shares, path)


def _scale(study: Study, one: Variation) -> Scale:
    return Scale(one.name, one.unit, one.log, place_of(study.values, one.name))


def _plain(motion: Numbers, settled: Numbers) -> NDArray[np.int64]:
    """Return the kind of motion where there is no stick-slip, as places in `plots.stability_map.PLAIN`."""
    plain = np.zeros(motion.shape, dtype=np.int64)
    for code, place in _PLAIN.items():
        plain[motion == code] = place
    plain[(motion == Motion.SMOOTH_SLIDING) & (settled == 0.0)] = 1   # of tables that had no word for it
    return plain
