# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The events that the node keeps for the figures of a run."""

from stickslip_sim.ros import kept_events
from stickslip_sim.ros.kept_events import KeptEvents
from tests.axes import COMPLIANT, paper_axis, run


def test_they_come_back_as_they_were() -> None:
    events = run(paper_axis(COMPLIANT), 0.002, 5.0)
    kept = KeptEvents()
    assert (kept.all(), kept.latest_time) == ([], None)
    for event in events:
        kept.append(event)
    assert (kept.all(), kept.latest_time) == (events, events[-1].time)
    kept.clear()
    assert (kept.all(), kept.latest_time) == ([], None)


def test_the_oldest_make_room() -> None:
    (event, *_) = run(paper_axis(COMPLIANT), 0.002, 1.0)
    kept = KeptEvents()
    for second in range(kept_events.MOST + 5):
        kept.append(event._replace(second=float(second)))
    assert [kept.all()[0].second, kept.all()[-1].second, len(kept.all())] == [5.0, kept_events.MOST + 4.0,
                                                                             kept_events.MOST]
