# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The pictures of a comparison: what is drawn of each run, and of all side by side."""

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import NamedTuple

from ..axis import CompliantContact
from ..core.types import Progress
from ..figures.point_figures import Motion
from ..plots.characteristics import plot_characteristics
from ..plots.paper_panels import DrawnMotion, plot_motion, plot_side_by_side
from ..plots.stability_map import Pick
from ..runs import Run
from ..study import Study
from ..study.diagrams import Ending, ending_at, place_in_map, point_of
from ..study.table import TableColumns
from .characteristics import characteristics_beside, characteristics_of, scene_as_run
from .fresh import MAX_DRAWN_EVENTS, densely_sampled, simulate_densely
from .look import drawn_motion

PICTURE_KINDS = ('png', 'svg')
_OF_MOTION = (
    '(a) drive and friction force, (d) velocity and acceleration as the motion begins: the highest break-away after '
    'the longest rest, then cycles that repeat; (b), (e) the same over one slip: with a contact force is continuous '
    'from stick to slip and back, and small vanishing oscillations follow; (c) friction and, in slip, drive force '
    'over velocity: friction has two values at one velocity, one speeding up, one slowing down; (f) phase plane: a '
    'stable limit cycle.  Grey and dashed: at most 30 cycles from the start on, coloured: the last complete one.')
_OF_FRICTION = ('Friction characteristics as in Fig. 6 of the paper: (a) kinetic friction of both branches over '
                'velocity; (b) static friction over rest time, with the break-aways of this run.')
_OF_BACKWARDS = '  Motion backwards is at velocities below 0, its static friction is dashed.'
_OWN = ' (own)'   # behind the name of the row with the characteristics of the run itself
_OF_ROWS = 'forces and velocity over time, friction force over velocity, as in Fig. 4 of the paper.'


class Picture(NamedTuple):
    """A picture that was drawn: the name of its files without the ending, the run it belongs to, a caption."""

    name: str
    run: str
    caption: str


def draw(runs: Mapping[str, Run], folder: Path, progress: Progress = None) -> list[Picture]:
    """Draw all pictures of runs by their names into a folder, each as PNG and SVG."""
    pictures: list[Picture] = []
    motions: dict[str, DrawnMotion] = {}
    for k, (name, run) in enumerate(runs.items()):
        if progress:
            progress(2 * k / (2 * len(runs) + 1))
        motions[name] = drawn_motion(run)
        pictures.append(_motion(name, run, motions[name], folder))
        if progress:
            progress((2 * k + 1) / (2 * len(runs) + 1))
        pictures.append(_friction(name, run, folder))
    caption = f'The runs beside each other: {_OF_ROWS}'
    if len(runs) == 1:
        (alone,) = runs.values()
        motions = _beside(alone)
        caption = ('The same axis with the conventional characteristics and with acceleration dependence; '
                   f'(own): those of the run itself; {_OF_ROWS}')
    if motions:
        pictures.append(_drawn(Picture('side_by_side', '', caption), folder,
                               lambda *paths: plot_side_by_side(motions, *paths)))
    return pictures


def _motion(name: str, run: Run, motion: DrawnMotion, folder: Path) -> Picture:
    picture = Picture(f'{name}_motion', name, f'{_likeness(run)}: {_OF_MOTION}')
    return _drawn(picture, folder, lambda *paths: plot_motion(motion, *paths))


def _friction(name: str, run: Run, folder: Path) -> Picture:
    sides = characteristics_of(run)
    picture = Picture(f'{name}_friction', name, _OF_FRICTION + (_OF_BACKWARDS if len(sides) > 1 else ''))
    return _drawn(picture, folder, lambda *paths: plot_characteristics(sides, *paths))


def _beside(run: Run) -> dict[str, DrawnMotion]:
    """Return the same axis with other characteristics; nothing when the inputs of a recorded run are unknown."""
    scene = scene_as_run(run)
    if scene is None:
        return {}
    # the last cycle is like others
    duration = run.duration * min(1.0, 0.5 * MAX_DRAWN_EVENTS / max(len(run.events), 1))
    found = {}
    for name, other in characteristics_beside(scene).items():
        mark = _OWN if other.axis == scene.axis else ''
        found[f'{name}{mark}'] = drawn_motion(simulate_densely(other, duration))
    return found


def _drawn(picture: Picture, folder: Path, draw_to: Callable[..., None]) -> Picture:
    draw_to(*(folder / f'{picture.name}.{kind}' for kind in PICTURE_KINDS))
    return picture


def _likeness(run: Run) -> str:
    """Return which figure of the paper has this kind of axis."""
    axis = run.scene.axis
    if axis.friction.excess is None:
        return 'Conventional characteristics, in the manner of Fig. 7 of the paper'
    if isinstance(axis.contact, CompliantContact):
        return 'Compliant contact, as in Fig. 8 of the paper'
    return 'Rigid contact, as in Fig. 7 of the paper'


# Points picked from the map of a study.

_MOST_EVENTS = 10_000   # that a phase plane shows
_SWINGS_ON = 16.0       # times as long as it took to know that


def picked(study: Study, columns: TableColumns, text: str) -> Pick:
    """Return a point `A,B` of the map of a study with the motion that it ends in; raises InputError."""
    point = point_of(study, text)
    ending = ending_at(study, columns, point)
    shown = _time_shown(ending)
    is_known = shown == ending.run.duration
    motion = drawn_motion(densely_sampled(ending.run) if is_known else simulate_densely(ending.run.scene, shown))
    sticks = ending.motion == Motion.STICK_SLIP
    return Pick(*place_in_map(study, point), motion if sticks else motion._replace(cycle=None))


def _time_shown(ending: Ending) -> float:
    """Return how much of a motion a phase plane shows, s: all, longer where it swings on, less with many events."""
    run = ending.run
    return run.duration * min(_SWINGS_ON if ending.swings_on else 1.0, _MOST_EVENTS / max(len(run.events), 1))
