# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The catalogue of figures: all that runs, studies and limits have, and how it is worded."""

import pytest

from stickslip_sim.check.measures import KINDS
from stickslip_sim.core.types import Event, Sample
from stickslip_sim.figures.catalogue import CATALOGUE, OF_A_CYCLE, head_of, label_of, unit_of
from stickslip_sim.figures.cycles import Cycle, Round
from stickslip_sim.figures.point_figures import FIGURES

NOT_FIGURES = {'second', 'fraction', 'kind', 'mode', 'direction'}   # instant and state


@pytest.mark.parametrize('names', [Cycle._fields, Round._fields, FIGURES, KINDS, Event._fields, Sample._fields])
def test_all_figures_are_in_the_catalogue_with_their_formula(names: tuple[str, ...]) -> None:
    assert {*names} - NOT_FIGURES <= CATALOGUE.keys()
    assert all(CATALOGUE[name].formula for name in {*names} - NOT_FIGURES)


def test_labels_and_units() -> None:
    assert [(head_of(name), unit_of(name)) for name in OF_A_CYCLE] == [
        ('period', 's'), ('stick', 's'), ('slip', 's'), ('jump', 'm'), ('peak speed', 'm/s'),
        ('break-away force', 'N'), ('drive force at arrest', 'N'), ('static coefficient', '')]
    assert [label_of(name) for name in ('stick_time', 'stick_slip', 'begin')] == [
        'stick time', 'stick-slip', 'break-away']
