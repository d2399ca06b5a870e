# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison as a folder: pictures, `report.json` with all figures, `report.html` with everything."""

import json
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from ..core.callbacks import Progress
from ..runs import Run
from ..runs.receipt import versions
from .cycle_figures import figures_of
from .page import page
from .pictures import draw
from .statement import Finding, Statement, StatementOutcome
from .statements import findings_on

_OF_FINDINGS = 0.3   # of the time, about


class Compared(NamedTuple):
    """A run under the name that it has in the report, and what came of the paper's statements on it."""

    name: str
    run: Run
    findings: list[tuple[Statement, Finding]]

    @property
    def failed(self) -> list[str]:
        """The names of the statements that apply and do not hold."""
        return [statement.name for statement, finding in self.findings if finding.outcome == StatementOutcome.FAILS]


def write_report(runs: Mapping[str, Run], folder: Path, progress: Progress = None) -> list[Compared]:
    """Draw runs by their names, and hold them to the statements, into a folder that exists.

    Raises OSError when the disk refuses.
    """
    found = []
    for k, (name, run) in enumerate(runs.items()):
        found.append(Compared(name, run, findings_on(run)))
        if progress:
            progress(_OF_FINDINGS * (k + 1) / len(runs))
    report: dict[str, Any] = {'versions': versions(), 'runs': [figures_of(*each) for each in found]}
    pictures = draw(runs, folder, progress and (lambda share: progress(_OF_FINDINGS + (1.0 - _OF_FINDINGS) * share)))
    report['pictures'] = [picture._asdict() for picture in pictures]
    (folder / 'report.json').write_text(json.dumps(report, indent=1, allow_nan=False) + '\n', encoding='utf-8')
    (folder / 'report.html').write_text(page(report, pictures, folder), encoding='utf-8')
    return found
