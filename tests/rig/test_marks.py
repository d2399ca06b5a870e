# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The marks of a run: when its faults and time-outs began and ended, and which commands were not taken."""

from stickslip_sim.rig import Fault, RigEventKind
from stickslip_sim.rig.marks import Mark, TimedRigEvent, marks_of_events, marks_of_faults

INJECTED, BEGIN, END, CLEARED = (RigEventKind.FAULT_INJECTED, RigEventKind.FAULT_BEGIN, RigEventKind.FAULT_END,
                                 RigEventKind.FAULT_CLEARED)


def marks(*events: tuple[float, RigEventKind, str, str]) -> list[Mark]:
    return marks_of_events([TimedRigEvent(*event, 1) for event in events], 0.5, 10.0)


def test_a_fault_lasts_from_its_start_to_its_end() -> None:
    assert marks((1.0, INJECTED, 'a', 'force_pulse'), (2.0, BEGIN, 'a', 'force_pulse'), (3.0, END, 'a', 'force_pulse')
                 ) == [Mark(2.0, 3.0, 'force_pulse')]


def test_a_fault_is_cut_short_or_goes_on() -> None:
    assert marks((2.0, BEGIN, 'a', 'drive_freeze'), (2.5, BEGIN, 'b', 'command_loss'),
                 (4.0, CLEARED, 'a', 'drive_freeze')) == [Mark(2.0, 4.0, 'drive_freeze'),
                                                          Mark(2.5, 10.0, 'command_loss')]


def test_a_fault_that_was_cleared_before_it_began_is_none() -> None:
    assert not marks((1.0, INJECTED, 'a', 'force_pulse'), (1.5, CLEARED, 'a', 'force_pulse'))


def test_a_fault_from_before_the_recording_begins_with_it() -> None:
    assert marks((3.0, END, 'a', 'force_pulse')) == [Mark(0.5, 3.0, 'force_pulse')]


def test_a_time_out_lasts_until_commands_come_again_or_it_is_cleared() -> None:
    timeout, resumed = RigEventKind.COMMAND_TIMEOUT, RigEventKind.COMMAND_RESUMED
    assert marks((1.0, timeout, 'velocity', ''), (2.0, resumed, 'velocity', '')) == [Mark(1.0, 2.0, 'time-out')]
    assert marks((1.0, timeout, 'velocity', ''), (3.0, CLEARED, '', '')) == [Mark(1.0, 3.0, 'time-out')]
    assert marks((1.0, timeout, 'velocity', '')) == [Mark(1.0, 10.0, 'time-out')]


def test_the_first_command_after_a_cleared_time_out_is_no_second_one() -> None:
    timeout, resumed = RigEventKind.COMMAND_TIMEOUT, RigEventKind.COMMAND_RESUMED
    again = (3.5, resumed, 'velocity', '')
    assert marks((1.0, timeout, 'velocity', ''), (3.0, CLEARED, '', ''), again) == [Mark(1.0, 3.0, 'time-out')]
    assert marks((3.0, CLEARED, '', ''), again) == [Mark(0.5, 3.0, 'time-out')]    # from before the recording
    assert marks(again) == [Mark(0.5, 3.5, 'time-out')]


def test_what_was_not_taken_is_an_instant_with_its_number() -> None:
    events = [TimedRigEvent(1.0, RigEventKind.COMMAND_REFUSED, 'velocity', '', 12),
              TimedRigEvent(2.0, RigEventKind.COMMAND_LIMITED, 'velocity', '', 0)]
    found = marks_of_events(events, 0.0, 10.0)
    assert found == [Mark(1.0, 1.0, 'refused', 12), Mark(2.0, 2.0, 'limited', 1)]
    assert not any(mark.is_span for mark in found)


def test_the_faults_of_a_scene_end_with_the_run() -> None:
    faults = [Fault('a', 'force_pulse', 1.0, 2.0, 5.0), Fault('b', 'drive_freeze', 3.0, float('inf'), 0.0),
              Fault('c', 'drive_freeze', 8.0, 1.0, 0.0)]
    assert marks_of_faults(faults, 5.0) == [Mark(1.0, 3.0, 'force_pulse'), Mark(3.0, 5.0, 'drive_freeze')]
