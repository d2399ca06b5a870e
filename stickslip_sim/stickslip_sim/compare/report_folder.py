# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A comparison as a folder: pictures, `report.json` with all figures, `report.html` with everything."""

import json
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

from ..runs.receipt import versions
from .cycle_figures import figures_of
from .history import History
from .page import page
from .pictures import draw
from .statement import Finding, Outcome, Statement
from .statements import judged


class Judged(NamedTuple):
    """A run and what came of the paper's statements on it."""

    history: History
    findings: list[tuple[Statement, Finding]]

    @property
    def failed(self) -> list[str]:
        """The names of the statements that apply and do not hold."""
        return [statement.name for statement, finding in self.findings if finding.outcome == Outcome.FAILS]


def write_report(histories: Sequence[History], folder: Path) -> list[Judged]:
    """Draw and judge runs into a folder that exists; their names must differ.  Raises OSError when the disk refuses."""
    runs = [Judged(history, judged(history)) for history in histories]
    report: dict[str, Any] = {'versions': versions(), 'runs': [figures_of(*run) for run in runs]}
    pictures = draw(histories, folder)
    report['pictures'] = [picture._asdict() for picture in pictures]
    (folder / 'report.json').write_text(json.dumps(report, indent=1, allow_nan=False) + '\n', encoding='utf-8')
    (folder / 'report.html').write_text(page(report, pictures, folder), encoding='utf-8')
    return runs
