# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip explore`: a scene as a page with sliders, for any browser."""

from pathlib import Path

import click

from .arguments import SceneChanges, recorded_run, scene_argument, scene_changes, verb
from .files import FILE, say_written, write_text


@verb(short_help='Write a scene as an interactive web page.')
@scene_argument
@click.option('--out', type=FILE, default='explore.html', metavar='FILE.html', help='Page to write [default: '
                                                                                   'explore.html].')
@click.option('--beside', metavar='RUN', help='Draw a measured run behind it: a run folder, a bag, or a CSV file '
                                              'with time, position, velocity or drive_force in SI units.')
@scene_changes('Change a parameter of the scene.')
def explore(scene: str, out: str, beside: str | None, changes: SceneChanges) -> None:
    """Write SCENE as one interactive HTML file that works in any browser, without a server or a network.

    Move a slider and the exact engine redraws the motion; "Copy scene" copies the scene for the tool and the node.
    """
    from ..core.errors import InputError
    from ..explorer.page import COLUMNS, page_of, thinned

    loaded = changes.load(scene)
    columns = None
    if beside is not None and Path(beside).suffix == '.csv':
        from ..inputs.csv_table import heading_of
        from ..inputs.measurement import Measurement
        from ..inputs.sources import check_run

        check_run(beside)
        names = heading_of(Path(beside))
        shown = [name for name in COLUMNS if name in names]
        if 'time' not in shown or len(shown) < 2:
            raise InputError('--beside', beside, f'a CSV file with the columns time and {", ".join(COLUMNS[1:-1])} or '
                             f'{COLUMNS[-1]}', 'name its columns so, or bring it in with stickslip import')
        measured = Measurement.from_file(beside, {name: name for name in shown})
        columns = thinned({'time': measured.times, **measured.columns})
    elif beside is not None:
        columns = thinned(recorded_run(beside).samples)
    write_text(out, [page_of(loaded, columns)])
    say_written(out)
