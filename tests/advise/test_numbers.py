# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Which numbers of a scene matter most."""

from stickslip_sim.advise.numbers import number_lines, numbers_as_json, sensitivities_of
from stickslip_sim.advise.trial_runs import reference_of
from stickslip_sim.inputs import load_scene


def test_the_numbers_of_a_limit_cycle_by_their_effect() -> None:
    """The forces of a cycle go with friction: one percent more of N mu_s is at least one of the period."""
    found = sensitivities_of(reference_of(load_scene('paper_fig7'), 4.0))
    assert found is not None
    head, first, *rest = number_lines(found)
    assert head.split()[-6:] == ['stick', 'share', 'peak', 'speed', 'break-away', 'force']
    assert first.split() == ['friction.static.limit', '2.386', '2.386', '1.128', '4.016', '1.379']
    assert len(rest) == 10
    assert (numbers_as_json(found) or {})['axis.mass']['period'] < 0.0


def test_a_scene_without_a_limit_cycle_has_the_time_of_an_event() -> None:
    found = sensitivities_of(reference_of(load_scene('positioning'), 4.0))
    assert found is not None
    assert found.figures[0].endswith('.time')
    assert not any(line.startswith('initial.') for line in number_lines(found))   # of 0 there is no percent


def test_a_scene_at_rest_has_none() -> None:
    found = sensitivities_of(reference_of(load_scene('paper_fig7', {'drive.velocity': 0.0}), 1.0))
    assert found is None
    assert numbers_as_json(found) is None
