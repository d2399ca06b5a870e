# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip uncertainty --of A.B`: how the critical value of a parameter spreads, and which others decide it."""

import json
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .count_words import counted
from .files import check_new_folder, new_folder, say_written, whole, write_text
from .progress import progress_bar
from .uncertainty_lines import Labels, index_lines, law_lines, percent_head

if TYPE_CHECKING:
    from ..core.arrays import Numbers
    from ..study.critical_sample import CriticalSpread, CriticalStudy
    from ..study.sample import Saltelli
    from ..study.workers import Workers

_TABLE, _RESULT = 'critical.csv', 'uncertainty.json'


def spread_critical(study: 'CriticalStudy', sample: 'Saltelli', labels: Labels, out: str, plot: str | None,
                    members: AbstractContextManager['Workers | None']) -> None:
    """Find the critical values of all points, write table and result into a new folder, and print the spread."""
    from ..study.critical_sample import ACCURACY, critical_values, spreads_of

    check_new_folder('--out', out)
    with members as workers, progress_bar('narrowing') as progress:
        values = critical_values(study, workers, progress)
    spreads = spreads_of(sample, values)
    with new_folder('--out', out) as folder:
        write_text(str(folder / _TABLE), _table(study, values))
        write_text(str(folder / _RESULT), [json.dumps(_plain(study, sample, spreads), indent=1, allow_nan=False), '\n'])
    if plot is not None:
        with whole(plot) as temporary:
            _draw(study, spreads, str(temporary))
    over = study.over
    print(f'{study.study.scene.name}: {sample.samples} samples of {counted(len(study.study.names), "parameter")}, '
          f'{study.study.count} points')
    print(f'critical {over.name} from {over.low:g} to {over.high:g} {over.unit}'.rstrip()
          + f', the highest one, to {ACCURACY:g} of the value')
    print('\n'.join([*law_lines(sample, labels), '', *_percentiles(study, spreads), '',
                     *index_lines(sample, labels, {_words(start): one.indices for start, one in spreads.items()}), '']))
    say_written(str(Path(out) / _RESULT), plot)


def _table(study: 'CriticalStudy', values: 'Numbers') -> Iterator[str]:
    """Yield a line of names, then a line for each point; a value that is not known stays empty."""
    import numpy as np

    from ..study.critical_sample import STARTS

    yield ','.join((*study.study.names, *(f'critical_{start}' for start in STARTS))) + '\n'
    for row in np.column_stack([study.study.points(0, study.study.count), values]).tolist():
        yield ','.join('' if number != number else repr(number) for number in row) + '\n'


def _plain(study: 'CriticalStudy', sample: 'Saltelli', spreads: Mapping[str, 'CriticalSpread']) -> dict[str, Any]:
    """Return all that was found as JSON values."""
    over = study.over
    return {
        'scene': study.study.scene.name, 'scene_hash': study.study.scene.hash, 'samples': sample.samples,
        'seed': sample.seed, 'critical': over.name, 'unit': over.unit, 'between': [over.low, over.high],
        'kept_of_distributions': {one.name: one.kept for one in sample.variations},
        **{start: _plain_spread(one) for start, one in spreads.items()},
    }


def _plain_spread(one: 'CriticalSpread') -> dict[str, Any]:
    from ..study.uncertainty import PERCENTS

    percentiles = None if one.percentiles is None else dict(zip(map(str, PERCENTS), one.percentiles))
    indices = None if one.indices is None else {name: index._asdict() for name, index in one.indices.items()}
    return {'points': one.points, 'all_over': one.all_over, 'nowhere': one.nowhere, 'unknown': one.unknown,
            'percentiles': percentiles, 'indices': indices}


def _percentiles(study: 'CriticalStudy', spreads: Mapping[str, 'CriticalSpread']) -> list[str]:
    from ..runs.wording import quantities

    lines = [percent_head(f'critical {study.over.name}')]
    for start, one in spreads.items():
        words = 'sticks and slips' if start == 'from_rest' else 'loses sliding'
        shown = quantities(one.percentiles, study.over.unit, 4) if one.percentiles else ['none']
        lines.append(f'{_words(start):22}' + ''.join(f'{text:>13}' for text in shown))
        others = [f'{count} {what}' for count, what in (
            (one.all_over, f'where it {words} all over the range'), (one.nowhere, f'where it nowhere {words}'),
            (one.unknown, 'where it is not decided')) if count]
        if others:
            lines.append(f'{"":22} of {one.points} independent points, but ' + ', '.join(others))
    return lines


def _words(start: str) -> str:
    return start.replace('_', ' ')


def _draw(study: 'CriticalStudy', spreads: Mapping[str, 'CriticalSpread'], path: str) -> None:
    from ..study.pictures import draw_critical_spread

    draw_critical_spread(study, spreads, path)
