# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What an uncertain scene is, and which of its parameters decide, as lines for people."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..study.correlations import Correlations
    from ..study.sample import Saltelli
    from ..study.uncertainty import Index

Labels = Mapping[str, str]   # how parameters are printed, by name


def law_lines(sample: 'Saltelli', labels: Labels) -> list[str]:
    """Return a line for each parameter: its distribution, and the share that was cut off."""
    from ..study.distribution import LAWS

    lines = []
    for one in sample.variations:
        numbers = ', '.join(f'{name} {number:g}' for name, number in zip(LAWS[one.law].numbers, one.numbers))
        cut = f', cut to {one.low:g} .. {one.high:g} ({1.0 - one.kept:.2g} off)' if LAWS[one.law].ends else ''
        unit = f' ({one.unit})' if one.unit else ''
        lines.append(f'  {labels[one.name]}{unit}: {one.law}, {numbers}{cut}')
    return lines + ([] if sample.correlations is None else [_correlated_line(sample.correlations, labels)])


def _correlated_line(correlations: 'Correlations', labels: Labels) -> str:
    """Return the pair of parameters that is correlated most."""
    names = list(labels.values())
    size, number, first, second = max((abs(number), number, names[i], names[j]) for i, row in enumerate(correlations)
                                      for j, number in enumerate(row[:i]))
    return f'  correlated: most of all {first} with {second}, {number:+.3g}' if size else '  correlated: none'


def percent_head(title: str) -> str:
    """Return the head of a table of percentiles."""
    from ..study.uncertainty import PERCENTS

    return f'{title:22}' + ''.join(f'{f"{percent} %":>13}' for percent in PERCENTS)


def index_lines(sample: 'Saltelli', labels: Labels,
                indices: Mapping[str, 'Mapping[str, Index] | None']) -> list[str]:
    """Return a table of the first-order indices, a line for each figure that has them."""
    if sample.correlations:
        return ['share of the variance that one parameter explains: none of correlated ones, which vary together']
    names = [one.name for one in sample.variations]
    width = max(22, *map(len, labels.values())) + 2
    lines = ['share of the variance that one parameter explains by itself (and with its interactions)']
    for figure, of in indices.items():
        if of is None:
            lines.append(f'{figure:22} none: not every point has it, or all have the same')
            continue
        lines.append(figure)
        lines += [f'  {labels[name]:{width}}{_cell(of[name])}'
                  for name in sorted(names, key=lambda n: -of[n].first_order)]
    return lines


def _cell(index: 'Index') -> str:
    return f'{index.first_order:6.3f} ± {index.error:.3f}  ({index.total:.3f} ± {index.total_error:.3f})'
