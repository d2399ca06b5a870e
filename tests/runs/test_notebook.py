# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a notebook shows of results: a line, a table, a picture; and refusals of what is no scene and no run."""

from collections.abc import Callable
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

import stickslip_sim as stickslip

SCENE = stickslip.load_scene('paper_fig8')
KNOWN = ['friction.static.time_constant']
FREE = {'axis.mass': {'distribution': 'uniform', 'low': 200.0, 'high': 500.0}}


def recorded(tmp_path: Path) -> stickslip.Run:
    measurement().write(tmp_path / 'run')
    return stickslip.read_run(tmp_path / 'run')


def measurement() -> stickslip.Measurement:
    times = np.arange(2000) * 1e-3
    return stickslip.Measurement.from_arrays(time=times, position=0.01 * np.sin(3.0 * times),
                                             friction_force=np.sign(np.cos(3.0 * times)) * (20.0 + times))


class Balance(HTMLParser):
    """Holds which elements are open; an end without its begin fails."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


RESULTS: dict[str, Callable[[Path], object]] = {
    'scene': lambda _: SCENE,
    'run': lambda _: stickslip.simulate(SCENE, 3.0),
    'measured run': recorded,
    'summary': lambda _: stickslip.simulate(SCENE, 3.0).summary,
    'measurement': lambda _: measurement(),
    'friction': lambda path: stickslip.friction_curve(recorded(path)),
    'fit': lambda path: stickslip.friction_curve(recorded(path)).fit(),
    'design': lambda _: stickslip.design('paper_fig7', KNOWN, duration=1.0, rate=100.0),
    'identification': lambda _: stickslip.identify(stickslip.simulate(SCENE, 2.0), SCENE, FREE),
}


@pytest.mark.parametrize('name', RESULTS)
def test_a_result_is_a_short_line_and_a_page(name: str, tmp_path: Path) -> None:
    found = RESULTS[name](tmp_path)
    assert repr(found).startswith('<')
    assert len(repr(found)) < 200
    assert '\n' not in repr(found)
    page = found._repr_html_()  # type: ignore[attr-defined]
    assert '<table' in page or '<pre>' in page
    balance = Balance()
    balance.feed(page)
    assert balance.open == []


def test_a_picture_is_shown_by_itself() -> None:
    figure = stickslip.simulate(SCENE, 1.0).plot(window=(0.2, 0.5))
    assert figure._repr_png_().startswith(b'\x89PNG')
    assert len(figure.axes) > 4


@pytest.mark.parametrize(('call', 'said'), [
    (lambda: stickslip.simulate({}, 1.0), 'scene = .dict. is refused: must be a Scene'),  # type: ignore[arg-type]
    (lambda: stickslip.design(3, KNOWN), 'scene = .int. is refused: must be a Scene'),  # type: ignore[arg-type]
    (lambda: stickslip.design('paper_fig7', 'axis.mass'), r"must be a list of names; give \['axis.mass'\]"),
    (lambda: stickslip.design('paper_fig7', KNOWN, criterion='E'), 'criterion = .E. is refused'),
    (lambda: stickslip.friction_curve({}), 'run = .dict. is refused: must be a run'),  # type: ignore[arg-type]
    (lambda: stickslip.friction_curve(SCENE), 'run = .Scene. is refused: must be a run'),  # type: ignore[arg-type]
    (lambda: stickslip.error_estimate('runs/four'), 'run = .str. is refused: must be a run that was simulated'),  # type: ignore[arg-type]
    (lambda: stickslip.read_run({}), 'path = .dict. is refused'),  # type: ignore[arg-type]
    (lambda: stickslip.load_scene({}), 'is refused: must be the name or path of a scene'),  # type: ignore[arg-type]
    (lambda: stickslip.plot_runs([SCENE], 'a.png'), 'runs = .list. is refused'),  # type: ignore[arg-type]
])
def test_what_is_no_scene_and_no_run_is_refused(call: Callable[[], object], said: str) -> None:
    with pytest.raises(stickslip.InputError, match=said):
        call()
