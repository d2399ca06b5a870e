# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""How all pictures look: colours, lines, files.  Without matplotlib's global state, so that no display is needed."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import contextmanager
from io import BytesIO
from pathlib import Path
from string import ascii_lowercase
from typing import Any, NamedTuple

import numpy as np
from matplotlib import rc_context
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.figure import Figure, SubFigure
from matplotlib.layout_engine import ConstrainedLayoutEngine

from ..core.arrays import Numbers
from ..core.types import Mode
from ..figures.catalogue import in_words, read_in

# Okabe and Ito's colours, which stay apart for colour-blind eyes
BLACK, ORANGE, SKY, GREEN = '#222222', '#E69F00', '#56B4E9', '#009E73'
BLUE, RED, PURPLE = '#0072B2', '#D55E00', '#CC79A7'
GREY = '#666666'
MODE_COLOURS = {Mode.STICK: SKY, Mode.ACCELERATING: ORANGE, Mode.COASTING: GREEN, Mode.DECELERATING: PURPLE,
                Mode.YIELDING: BLUE}
MILLI = 1e3          # m to mm
_UNDATED: dict[str, dict[str, Any]] = {'svg': {'Date': None}, 'pdf': {'CreationDate': None}}
_SAVED: dict[str, Any] = {   # the same picture is the same file, its text text, and no other layout is made
    'pdf.fonttype': 42, 'svg.hashsalt': 'stickslip', 'figure.autolayout': False,
    'figure.constrained_layout.use': False}
_POINTS_PER_INCH = 72.0
_POINTS = 8000       # per line: more than a picture can show
JOURNAL: dict[str, Any] = {   # for pictures that are printed at the width of one or two columns
    'font.size': 8.0, 'axes.labelsize': 8.0, 'legend.fontsize': 7.0, 'xtick.labelsize': 7.0, 'ytick.labelsize': 7.0,
    'axes.linewidth': 0.6, 'lines.linewidth': 1.0, 'xtick.major.width': 0.6, 'ytick.major.width': 0.6,
    'axes.spines.top': False, 'axes.spines.right': False, 'legend.frameon': False, 'legend.handlelength': 2.6,
    'axes.grid': True, 'grid.color': '#dddddd', 'grid.linewidth': 0.5, 'axes.axisbelow': True, 'savefig.dpi': 300,
}
SINGLE_COLUMN, DOUBLE_COLUMN = 3.5, 7.1   # in


class ShownFigure(Figure):
    """A figure that a notebook shows by itself, whether or not it has imported pyplot."""

    def _repr_png_(self) -> bytes:
        data = BytesIO()
        self.savefig(data, format='png')
        return data.getvalue()


def save(figure: Figure, *paths: Path | str) -> None:
    """Write a picture; the ending of each path (.png, .pdf, .svg) says how.  All have the layout of the first."""
    for path in map(Path, paths):
        kind = path.suffix[1:].lower()
        with rc_context(_SAVED):
            figure.savefig(path, format=kind, metadata=_UNDATED.get(kind))
            figure.set_layout_engine(None)   # unlike 'none' it spares the next one a drawing for a layout


@contextmanager
def journal(width: float, height: float, *paths: Path | str, pads: tuple[float, float] = (0.05, 0.05),
            **settings: Any) -> Iterator[Figure]:
    """Yield a figure for print, of that size (in) and with these paddings between panels, and write it at the end.

    `settings` are those of matplotlib in place of JOURNAL's.
    """
    with rc_context({**JOURNAL, **settings}):
        figure = Figure(figsize=(width, height), layout=ConstrainedLayoutEngine(w_pad=pads[0], h_pad=pads[1]))
        yield figure
        save(figure, *paths)


def thinned(time: Numbers, values: Numbers) -> tuple[Numbers, Numbers]:
    """Keep the lowest and the highest point of each bundle, so that no peak is lost."""
    size = len(values) // (_POINTS // 2)
    if size < 3:
        return time, values
    whole = len(values) // size * size
    bundles = values[:whole].reshape(-1, size)
    first = np.arange(0, whole, size)
    keep = np.concatenate([[0], first + bundles.argmin(axis=1), first + bundles.argmax(axis=1), [len(values) - 1]])
    keep = np.unique(keep)
    return time[keep], values[keep]


def legend_outside(figure: Figure | SubFigure, place: str, handles: Iterable[Artist], labels: Iterable[str],
                   **look: Any) -> None:
    """Explain lines beside all panels, at a `place` as `upper left`, where the figure has no other title.

    A blank title of the legend's height keeps room for it: `loc='outside ...'` came with matplotlib 3.7, and Ubuntu
    24.04 has 3.6.
    """
    legend = figure.legend(list(handles), list(labels), loc=place, **look)
    height = legend.get_window_extent().height / figure.dpi * _POINTS_PER_INCH
    keep = figure.suptitle if place.startswith('upper') else figure.supxlabel
    keep(' ', fontsize=height)


def lines_by_label(*panels: Axes) -> dict[str, Artist]:
    """Return the lines of panels that have a label, those of one label once."""
    return {label: line for panel in panels for line, label in zip(*panel.get_legend_handles_labels())}


def legend_of(figure: Figure | SubFigure, place: str, *panels: Axes, **look: Any) -> None:
    """Explain the lines of panels beside them all."""
    lines = lines_by_label(*panels)
    legend_outside(figure, place, lines.values(), lines, **look)


def shortened(name: str, most: int) -> str:
    """Return a name with at most so many letters: its middle goes."""
    half = (most - 1) // 2
    return name if len(name) <= most else f'{name[:half]}…{name[-half:]}'


def letter(panel: Axes, text: str) -> None:
    """Name a panel in its upper left corner, outside."""
    panel.annotate(f'({text})', (0.0, 1.0), xytext=(-26.0, 5.0), xycoords='axes fraction',
                   textcoords='offset points', fontweight='bold', fontsize=8.5)


def letters(panels: Iterable[Axes], names: Iterable[str] = ascii_lowercase) -> None:
    """Name panels in their order."""
    for panel, name in zip(panels, names):
        letter(panel, name)


# A panel over time: its lines, its look, the title above.

_KILO_FROM = 1e4     # N: larger forces are shown in kN
_LONGEST = 70        # letters of a heading


def force_unit(*forces: Numbers) -> tuple[float, str]:
    """Return the scale and the unit in which forces (N) are shown."""
    known = (force[np.isfinite(force)] for force in forces)
    largest = max((float(np.abs(force).max()) for force in known if len(force)), default=0.0)
    return (1e-3, 'kN') if largest >= _KILO_FROM else (1.0, 'N')


def line(panel: Axes, samples: Mapping[str, Numbers], name: str, scale: float, label: str, **look: Any) -> None:
    """Draw a column over time; one of NaN was not measured."""
    if np.isnan(samples[name]).all():
        return
    time, values = thinned(samples['time'], samples[name])
    panel.plot(time, values * scale, label=label, **look)


def dress(panel: Axes, has_legend: bool = True) -> None:
    """Give a panel over time its grid and legend."""
    if not panel.has_data():
        panel.text(0.5, 0.5, 'not measured', transform=panel.transAxes, ha='center', va='center', color=GREY)
    panel.spines[['top', 'right']].set_visible(False)
    panel.grid(axis='both', color='#dddddd', linewidth=0.6)
    panel.set_axisbelow(True)
    panel.margins(x=0.0)
    if has_legend and panel.get_legend_handles_labels()[0]:
        panel.legend(loc='lower right', bbox_to_anchor=(1.0, 0.98), ncols=4, frameon=False, fontsize=9,
                     borderaxespad=0.0, handlelength=2.2)


def head(first: Axes, title: str) -> None:
    """Write a title of up to three lines above the first panel; the first line is the heading."""
    heading, _, rest = title.partition('\n')
    first.set_title(shortened(heading, _LONGEST), loc='left', fontsize=14, fontweight='bold',
                    pad=(22, 42, 56)[min(title.count('\n'), 2)])
    first.annotate(rest, (0.0, 1.0), xytext=(0.0, 25.0), xycoords='axes fraction', textcoords='offset points',
                   fontsize=10, color=GREY, in_layout=False)


# An axis of a picture for any parameter: in the unit that people use, named as in a scene file.

_SHOWN = {'ms': ('ms', MILLI), 'N/m': ('N/µm', 1e-6)}   # but for those of all texts


def unit_read(unit: str, values: Numbers) -> str:
    """Return the unit that values (SI) are read in: ms for times most of which are below a second."""
    known = values[np.isfinite(values)]
    return 'ms' if unit == 's' and len(known) and float(np.median(known)) < 1.0 else unit


def labelled(words: str, unit: str) -> str:
    """Return words with the unit of their numbers, as at an axis or above a column: speed / (mm/s)."""
    return f'{words} / ({unit})' if '/' in unit or ' ' in unit else f'{words} / {unit}' if unit else words


class Scale(NamedTuple):
    """A parameter or a figure: its name, its SI unit, whether its axis is logarithmic.

    The unit `ms` means seconds that are read in ms.  `place` says where an element of a list is.
    """

    name: str
    unit: str
    log: bool = False
    place: str = ''

    def shown(self, values: Numbers | float) -> Numbers:
        """Return SI values in the unit of the picture."""
        return np.asarray(values) * self._read_in[1]

    def edges(self, values: Numbers) -> Numbers:
        """Return where the cells about increasing values begin and end, in the unit of the picture.

        They meet half way on this scale; the outermost end at their values.
        """
        places = np.log(self.shown(values)) if self.log else self.shown(values)
        edges = np.concatenate([places[:1], 0.5 * (places[1:] + places[:-1]), places[-1:]])
        return np.asarray(np.exp(edges)) if self.log else edges

    @property
    def label(self) -> str:
        """The text at the axis."""
        words = in_words(self.name.removeprefix('axis.')) + (f' at {self.place}' if self.place else '')
        return labelled(words, self._read_in[0])

    @property
    def _read_in(self) -> tuple[str, float]:
        return _SHOWN.get(self.unit) or read_in(self.unit)

    @property
    def kind(self) -> str:
        """The name of matplotlib for the scale."""
        return 'log' if self.log else 'linear'
