# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Faults as they are given: by which id, how many, in a scene; those without a meaning are refused."""

import math
from typing import Any, ClassVar

import pytest

from stickslip_sim.core.errors import InputError
from stickslip_sim.core.time_grid import Grid
from stickslip_sim.inputs import load_scene
from stickslip_sim.rig import Fault, RigEventKind
from stickslip_sim.rig.faults import MAX_FAULTS, RULES
from tests.support.rigs import bits, inject, make, rig_events_of, run, velocity
from tests.support.scene_files import refusal

GRID = Grid(1000.0)


class TestIds:
    def test_are_chosen_when_left_out(self) -> None:
        rig = make()
        names = [rig.inject(Fault(name, 'drive_freeze', 1.0, 1.0, 0.0)).id for name in ('', 'drive_freeze_2', '', '')]
        assert len(set(names)) == 4
        assert list(rig.fault_ids) == names

    @pytest.mark.parametrize('started', [False, True])
    def test_in_use_are_refused(self, started: bool) -> None:
        rig = make()
        rig.inject(Fault('a', 'drive_freeze', 0.0 if started else 9.0, 1.0, 0.0))
        run(rig, 5)
        error = refusal(lambda: rig.inject(Fault('a', 'force_pulse', 0.0, 1.0, 0.0)))
        assert "id = 'a' is refused: must be not in use" in str(error)
        rig.clear_fault('a')
        assert rig.inject(Fault('a', 'force_pulse', 0.0, 1.0, 0.0)).id == 'a'

    def test_are_free_again_after_the_end(self) -> None:
        rig = make()
        run(rig, 50, {step: [inject('force_pulse', 0.0, 0.005, 1.0, 'a')] for step in (10, 20, 30)})
        assert list(rig.fault_ids) == []

    def test_unknown_are_refused_with_those_there_are(self) -> None:
        rig = make()
        assert 'none at the moment' in str(refusal(lambda: rig.clear_fault('x')))
        rig.inject(Fault('a', 'drive_freeze', 1.0, 1.0, 0.0))
        assert "id = 'x' is refused: must be the id of a fault: a;" in str(refusal(lambda: rig.clear_fault('x')))

    def test_a_planned_one_is_cleared_before_it_begins(self) -> None:
        rig = make()
        results = run(rig, 100, {10: [inject('force_pulse', 0.05, 0.02, 1.0, 'a'), inject('drive_freeze', 0.05)],
                                  20: [lambda rig: rig.clear_fault('a')]})
        assert not any(result.sample.external_force for result in results)
        assert results[60].sample.drive_velocity == 0.0

    def test_the_most_there_can_be(self) -> None:
        rig = make()
        for _ in range(MAX_FAULTS):
            rig.inject(Fault('', 'force_pulse', 0.001, 0.001, 1.0))
        error = refusal(lambda: rig.inject(Fault('', 'force_pulse', 0.001, 0.001, 1.0)))
        assert f'at most {MAX_FAULTS} at a time' in str(error)
        assert len(str(refusal(lambda: rig.clear_fault('x')))) < 500
        assert [result.sample.external_force for result in run(rig, 4)] == [0.0, 0.0, MAX_FAULTS, 0.0]
        assert list(rig.fault_ids) == []


class TestRefused:
    @pytest.mark.parametrize(('change', 'reason'), [
        ({'kind': 'gremlin'}, "kind = 'gremlin'"), ({'kind': ''}, 'one of friction_scale'),
        ({'start': -1e-9}, 'start = -1e-09'), ({'start': math.nan}, 'start = nan'),
        ({'start': math.inf}, 'start = inf'),
        ({'duration': 0.0}, 'duration = 0.0'), ({'duration': 0.0009}, 'from a step (0.001 s)'),
        ({'duration': math.nan}, 'duration = nan'), ({'duration': -math.inf}, 'duration = -inf'),
        ({'value': math.nan}, 'value = nan'), ({'value': math.inf}, 'value = inf'),
        ({'id': 'a' * 65}, '1 to 64 characters'), ({'id': 'a\nb'}, 'printable'), ({'id': '\x00'}, 'printable'),
    ])
    def test_without_a_meaning(self, change: dict[str, Any], reason: str) -> None:
        fault = Fault('a', 'force_pulse', 0.0, 1.0, 5.0)._replace(**change)
        rig = make()
        assert reason in str(refusal(lambda: rig.inject(fault)))
        assert list(rig.fault_ids) == []
        assert bits(run(rig, 20)) == bits(run(make(), 20))

    @pytest.mark.parametrize(('kind', 'good', 'bad'), [
        ('friction_scale', [0.0, 100.0], [-1e-9, 100.1]), ('force_pulse', [-1e9, 1e9], [-1.1e9, 1.1e9]),
        ('encoder_freeze', [0.0], [1.0, -1.0]), ('encoder_step', [-1e3, 1e3], [1001.0, -1001.0]),
        ('encoder_dropout', [1e-9, 1.0], [0.0, 1.1, -0.1]), ('command_loss', [1e-9, 1.0], [0.0, 1.1, -0.1]),
        ('command_delay', [1e-9, 60.0], [0.0, 60.1, -1.0]), ('drive_freeze', [0.0], [0.1]),
    ])
    def test_values_by_kind(self, kind: str, good: list[float], bad: list[float]) -> None:
        rig = make(measures=True)
        for value in good:
            rig.inject(Fault('', kind, 0.0, 0.005, value))
        for value in bad:
            assert f'with {kind}: ' in str(refusal(rig.inject, Fault('', kind, 0.0, 1.0, value)))
        run(rig, 20, {5: [velocity(0.01)]})

    def test_every_kind_has_a_rule_that_was_tried(self) -> None:
        assert set(RULES) == {'friction_scale', 'force_pulse', 'encoder_freeze', 'encoder_step', 'encoder_dropout',
                              'command_loss', 'command_delay', 'drive_freeze'}


class TestScene:
    GIVEN: ClassVar[dict[str, Any]] = {'faults.ids': ['a', 'b'], 'faults.kinds': ['force_pulse', 'drive_freeze'],
                             'faults.starts': [0.5, 1.0], 'faults.durations': [0.5, math.inf],
                             'faults.values': [300.0, 0.0]}

    def test_are_those_injected_at_the_start(self) -> None:
        of_scene = run(load_scene('paper_fig8', self.GIVEN).make_rig(), 1500)
        rig = load_scene('paper_fig8').make_rig()
        injected = run(rig, 1500, {0: [inject('force_pulse', 0.5, 0.5, 300.0, 'a'),
                                       inject('drive_freeze', 1.0, math.inf, 0.0, 'b')]})
        assert bits(result.sample for result in of_scene) == bits(result.sample for result in injected)
        assert rig_events_of(of_scene) == [(501, RigEventKind.FAULT_BEGIN), (1001, RigEventKind.FAULT_END),
                                  (1001, RigEventKind.FAULT_BEGIN)]

    @pytest.mark.parametrize(('change', 'reason'), [
        ({'faults.ids': ['a', 'a']}, "faults (a): id = 'a'"),
        ({'faults.ids': ['a', 'a'], 'faults.kinds': ['drive_freeze'] * 2, 'faults.starts': [1.0] * 2,
          'faults.durations': [1.0] * 2, 'faults.values': [0.0] * 2}, "faults (a): id = 'a'"),
        ({'faults.kinds': ['force_pulse', 'goblin']}, "faults (b): kind = 'goblin'"),
        ({'faults.values': [300.0, 1.0]}, 'faults (b): value = 1.0'),
        ({'faults.durations': [1e-4, 1.0]}, 'faults (a): duration = 0.0001'),
        ({'faults.starts': [0.5]}, 'faults.starts = [0.5]'),
        ({'faults.starts': [-0.5, 0.5]}, 'faults.starts'),
    ])
    def test_refused_when_the_scene_is_read(self, change: dict[str, Any], reason: str) -> None:
        error = refusal(lambda: load_scene('paper_fig8', {**self.GIVEN, **change}))
        assert reason in str(error)

    @pytest.mark.parametrize('missing', ['ids', 'kinds', 'starts', 'durations'])
    def test_lists_belong_together(self, missing: str) -> None:
        given = {name: value for name, value in self.GIVEN.items() if name != f'faults.{missing}'}
        with pytest.raises(InputError, match='as many as there are faults'):
            load_scene('paper_fig8', given)

    def test_values_may_be_left_out(self) -> None:
        given = {name: value for name, value in self.GIVEN.items() if name != 'faults.values'}
        assert [fault.value for fault in load_scene('paper_fig8', given).rig.faults] == [0.0, 0.0]

    def test_as_many_as_there_can_be_are_read_in_no_time(self) -> None:
        count = MAX_FAULTS
        given = {'faults.ids': [f'f{i}' for i in range(count)], 'faults.kinds': ['force_pulse'] * count,
                 'faults.starts': [float(i) for i in range(count)], 'faults.durations': [1.0] * count}
        assert len(load_scene('paper_fig8', given).rig.faults) == count
