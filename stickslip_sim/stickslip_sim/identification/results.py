# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An identification as a folder: a scene, what is left open of it, and the report as HTML and JSON."""

import json
from collections.abc import Callable, Mapping
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from ..plots.characteristics import KnownFriction, plot_known_friction
from ..plots.identified_motion import FittedChannel, plot_correlations, plot_fit, plot_residuals
from ..report.html import figure
from ..runs import Run
from .identified import ChannelFit, Identification
from .identified_scene import IDENTIFIED_SCENE, identified_text, input_texts, posterior_text
from .measured_friction import known_friction, phases, slip_share, usual_cycles
from .prediction_report import draw_prediction
from .report import IDENTIFIED_VALUES, caption, report_page, report_values

POSTERIOR = 'posterior.yaml'
IDENTIFIED_PAGE = 'report.html'
_WHOLE = 0.99   # of a run: so long a stretch is all of it


def write_results(run: Run, found: Identification, start: str, folder: Path, name: str | None = None) -> None:
    """Write the four files into a folder that exists, and inputs that were measured beside them.

    `start` is the scene that was given, as it was named; `name` that of several runs, of which `run` is the first.

    Raises OSError when the disk refuses.
    """
    start, name = Path(start).name, name or run.name
    friction = known_friction(run, found)
    values = report_values(found, name, start, friction)
    page = report_page(found, name, start, _pictures(found, friction), values['versions'])
    for name, text in input_texts(found).items():
        (folder / name).write_text(text, encoding='utf-8')
    (folder / IDENTIFIED_SCENE).write_text(identified_text(found, name, start), encoding='utf-8')
    (folder / POSTERIOR).write_text(posterior_text(found, name), encoding='utf-8')
    (folder / IDENTIFIED_VALUES).write_text(json.dumps(values, indent=1, allow_nan=False) + '\n', encoding='utf-8')
    (folder / IDENTIFIED_PAGE).write_text(page, encoding='utf-8')


def _pictures(found: Identification, friction: Mapping[str, KnownFriction]) -> dict[str, str]:
    """Return the pictures as parts of a page, by their names."""
    channels = fitted_channels(found)
    names, window, share = [one.name for one in found.estimates], usual_cycles(found), slip_share(found)
    drawn: dict[str, Callable[[Path], None]] = {
        'fit': lambda path: plot_fit(channels, window, found.restarts, path),
        'residuals': lambda path: plot_residuals(channels, share, path),
        'friction': lambda path: plot_known_friction(friction, path),
        'correlations': lambda path: plot_correlations(names, found.correlation, path),
    }
    for k, one in enumerate(found.predictions):
        drawn[f'prediction_{k}'] = partial(draw_prediction, one)
    with TemporaryDirectory() as folder:
        return {name: _picture(Path(folder) / f'{name}.svg', draw) for name, draw in drawn.items()}


def fitted_channels(found: Identification) -> list[FittedChannel]:
    """Return the channels as they are drawn."""
    return [FittedChannel(one.name, one.unit, one.times, one.measured, one.fitted, one.residuals / one.resolution,
                          phases(found, one.times), misfit_spans(found, one), one.free) for one in found.channels]


def misfit_spans(found: Identification, channel: ChannelFit) -> list[tuple[float, float]]:
    """Return where a channel does not fit, s: the stretches; the whole run where no stretch by itself does not."""
    spans = sorted({(one.from_time, one.to_time) for one in found.misfits if one.channel == channel.name})
    whole = float(channel.times[-1] - channel.times[0])
    return [span for span in spans if span[1] - span[0] < _WHOLE * whole] or spans


def _picture(path: Path, draw: Callable[[Path], None]) -> str:
    draw(path)
    return figure(path, caption(path.stem))
