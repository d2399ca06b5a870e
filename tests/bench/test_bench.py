# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The benchmark: pairing of events, peers against known events, the report, and what is not installed."""

import json
import math
import re
import sys
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from benchmarks.measured import kept
from benchmarks.races import row
from stickslip_sim.axis import InitialState
from stickslip_sim.bench.contestants import exact_solver
from stickslip_sim.bench.outside import FIRST_SLIP, Ratio, at_least, at_most, ratios
from stickslip_sim.bench.peers import PEERS, dop853, mujoco, scipy_ivp
from stickslip_sim.bench.problem import NO_SETTING, Outcome, Peer, Problem, Setting, case_names, make_case
from stickslip_sim.bench.race import Truth, errors_of, race
from stickslip_sim.bench.report import as_case, markdown, race_as_json, text_table
from stickslip_sim.cli.main import run
from stickslip_sim.core.input_profile import constant
from stickslip_sim.core.types import EventKind
from stickslip_sim.figures.distance import pair
from tests.conftest import Program
from tests.support.axes import COMPLIANT, RIGID, instant, make, paper_axis

pytestmark = pytest.mark.slow

FINEST = Setting(1e-12, 'tolerance')
# docs/model.md, to ten digits: the paper's data with 2 mm/s and a rest-time constant of 0.2 s, rigid contact
KNOWN = [(0.67979883333333, EventKind.BREAKAWAY), (0.76770114503556598, EventKind.COAST),
         (0.79961346115854196, EventKind.DECELERATE), (0.83862368925988008, EventKind.STICK),
         (1.3313467055455221, EventKind.BREAKAWAY), (1.4173257894649382, EventKind.COAST)]


def paper(contact: str, duration: float) -> Problem:
    axis = paper_axis(RIGID if contact == 'rigid' else COMPLIANT)
    return Problem('paper', contact, axis, InitialState(), constant(0.002), constant(0.0), duration)


@pytest.fixture
def mujoco_stands_in(monkeypatch: pytest.MonkeyPatch) -> None:
    """Put a slider on a joint in the place of MuJoCo: its integrator `Euler`, which is semi-implicit."""
    def model(text: str) -> SimpleNamespace:
        step, mass = (float(one) for one in re.findall(r'(?:timestep|mass)="([^"]+)"', text))
        return SimpleNamespace(step=step, mass=mass)

    def advance(model: SimpleNamespace, data: SimpleNamespace) -> None:
        data.qvel[0] += model.step * data.qfrc_applied[0] / model.mass
        data.qpos[0] += model.step * data.qvel[0]

    monkeypatch.setitem(sys.modules, 'mujoco', SimpleNamespace(
        MjModel=SimpleNamespace(from_xml_string=model), mj_step=advance, mj_resetData=lambda *_: None,
        MjData=lambda _: SimpleNamespace(qpos=[0.0], qvel=[0.0], qfrc_applied=[0.0])))


@pytest.mark.parametrize(('peer', 'setting', 'within'), [
    (dop853.PEER, FINEST, 1e-10), (scipy_ivp.SCIPY_PEERS[0], FINEST, 1e-6),
    (mujoco.PEER, Setting(1e-5, 'step'), 1e-4)])
@pytest.mark.usefixtures('mujoco_stands_in')
def test_peers_find_the_events_of_the_paper(peer: Peer, setting: Setting, within: float) -> None:
    outcome = peer.prepare(paper('rigid', 1.43), setting)()
    assert [int(kind) for kind in outcome.events[:, 1]] == [kind for _, kind in KNOWN]
    assert np.abs(outcome.events[:, 0] - [time for time, _ in KNOWN]).max() < within


@pytest.mark.parametrize('name', ['B', 'positioning', 'cutting_force', 'paper_fig4_falling'])
def test_the_strong_rival_finds_every_event_of_the_exact_engine(name: str) -> None:
    problem = make_case(name, 5.0)
    events = make(problem.axis, problem.drive, problem.force, problem.initial).advance(instant(5.0))
    outcome = dop853.PEER.prepare(problem, FINEST)()
    assert [(row[1], row[2]) for row in outcome.events] == [(e.kind, e.direction) for e in events]
    assert max(abs(row[0] - e.time) for row, e in zip(outcome.events, events)) < 1e-6


def test_the_exact_contestant_gives_the_events_of_the_simulator() -> None:
    problem = make_case('positioning', 5.0)
    simulator = make(problem.axis, problem.drive, problem.force, problem.initial)
    events = simulator.advance(instant(5.0))
    outcome = exact_solver().prepare(problem, NO_SETTING)()
    assert [tuple(row) for row in outcome.events] == [
        (e.time, e.kind, e.direction, e.position, e.velocity) for e in events]
    assert outcome.position == simulator.sample().position


def test_pairs_leave_out_what_is_missed_and_invented() -> None:
    want = [(1.0, 0.0), (2.0, 0.0), (3.0, 0.0)]
    assert pair(want, want, 0.5) == list(zip(want, want))
    assert pair(want, [want[0], want[2]], 0.5) == [(want[0], want[0]), (want[2], want[2])]
    late, extra = (2.1, 0.0), (2.4, 0.0)
    assert pair(want, [want[0], late, extra, want[2]], 0.5) == [(want[0], want[0]), (want[1], late), (want[2], want[2])]
    assert pair(want, [], 0.5) == []


def test_errors_count_missed_invented_late_and_misplaced_events() -> None:
    problem = paper('rigid', 2.0)
    events = make(problem.axis, 0.002).advance(instant(2.0))
    rows = np.array([(e.time, e.kind, e.direction, e.position, e.velocity) for e in events])
    truth = Truth(events, 0.001)
    assert errors_of(Outcome(rows, 0.001), truth, 2.0)[2:7] == (0, 0, 0.0, 0.0, 0.0)
    shifted = rows.copy()
    shifted[0, 0] += 1e-3
    shifted[0, 3] += 1e-6
    errors = errors_of(Outcome(np.vstack([shifted, [1.9, EventKind.REVERSE, -1.0, 0.0, 0.0]]), 0.0015), truth, 2.0)
    assert (errors.missed, errors.invented) == (0, 1)
    assert errors.time == pytest.approx(1e-3)
    assert errors.position == pytest.approx(1e-6)
    assert errors.end_position == pytest.approx(5e-4)
    assert errors_of(Outcome(rows[1:], 0.001), truth, 2.0).missed == 1


def test_a_race_is_reported_in_full_and_a_missing_peer_by_name() -> None:
    absent = scipy_ivp.SCIPY_PEERS[0]._replace(missing='pip install scipy')
    results = race([paper('rigid', 1.0)], [exact_solver(), dop853.PEER._replace(settings=(FINEST,)), absent], 1)
    assert [row.note for row in results[0].rows] == ['', '', 'not installed (pip install scipy)']
    exact = results[0].rows[0].errors
    assert exact is not None
    assert exact.time < 1e-14
    data = json.loads(json.dumps(race_as_json(results, ratios(results), 1), allow_nan=False))
    assert data['cases'][0]['rows'][1]['setting'] == {'tolerance': 1e-12}
    assert data['cases'][0]['rows'][0]['cost_per_simulated_second']['median'] > 0.0
    for text in (text_table(as_case(results[0])), markdown(data)):
        assert 'not installed (pip install scipy)' in text
        assert 'DOP853 with events, numba' in text


def test_a_run_that_would_take_too_long_is_reported_and_not_waited_for(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr('stickslip_sim.bench.race.RACE_PATIENCE', 0.0)   # s
    results = race([paper('rigid', 2.0)], [dop853.PEER._replace(settings=(FINEST,))], 1)
    left_out = results[0].rows[0]
    assert left_out.errors is None
    assert left_out.cost is None
    assert left_out.note.startswith('left out: a run would take ')


def test_figures_stand_beside_their_marks() -> None:
    assert at_least('speed', 'A', 3.0, 2.0, 4.0) == ('speed', 'A', 3.0, '>= 2', '4', True)
    assert at_most('error', 'A', 3e-12, 1e-12) == ('error', 'A', 3e-12, '<= 1e-12', '', False)
    page = markdown({'versions': {}, 'machine': 'a machine', 'rounds': 1, 'cases': [], 'ratios': [
        at_most('error', 'A', 3e-12, 1e-12)._asdict(), Ratio('any', '', 2.5)._asdict()]})
    assert '| error | A | 3.0e-12 | <= 1e-12 | – | **no** |' in page
    assert '| any |  | 2.5 | – | – | – |' in page


def test_peers_say_what_is_missing_and_have_names_of_their_own() -> None:
    assert len({peer.name for peer in PEERS}) == len(PEERS)
    for peer in PEERS:
        assert peer.missing is None or peer.missing.startswith('pip install ')
        assert all(setting.label for setting in peer.settings)


def test_peers_whose_packages_are_blocked_are_reported_and_do_not_race(in_a_process: Program) -> None:
    program = '''
import sys
for name in ('heyoka', 'scipy', 'sksundae', 'mujoco'):
    sys.modules[name] = None
from stickslip_sim.bench.peers import PEERS
print(*sorted(peer.missing for peer in PEERS if peer.missing), sep='|')
'''
    missing = in_a_process(program, compiled=True).strip().split('|')
    assert missing == ['pip install heyoka', 'pip install mujoco', 'pip install scikit-sundae',
                       *['pip install scipy'] * 4]


def test_a_start_is_timed_until_the_axis_slips(in_a_process: Program) -> None:
    out = in_a_process(FIRST_SLIP + 'print(sample.mode.name)', compiled=False)
    assert out.strip() == 'ACCELERATING'


def test_the_tool_runs_quickly_and_writes_everything(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(['bench', '--quick', '--scenes', 'paper_fig7', '--out', str(tmp_path)]) == 0
    assert 'exact' in capsys.readouterr().out
    data = json.loads((tmp_path / 'bench.json').read_text())
    assert [case['name'] for case in data['cases']] == ['paper_fig7']
    assert {path.name for path in tmp_path.iterdir()} == {
        'bench.json', 'bench.md', 'trade_scenes.png', 'trade_scenes.svg'}
    rows = [row(case['name'], raced) for case in data['cases'] for raced in case['rows']]
    assert [*rows[0]] == [*kept('races')['rows'][0]]
    assert all((one['cost'] is None) == bool(one['note']) for one in rows)


def test_an_unknown_scene_is_refused_with_the_names(capsys: pytest.CaptureFixture[str]) -> None:
    assert run(['bench', '--scenes', 'nothing']) == 2
    assert 'paper_fig8' in capsys.readouterr().err
    assert run(['bench', 'A']) == 2


def test_cases_are_the_letters_and_all_scenes() -> None:
    assert case_names()[:4] == ['A', 'B', 'C', 'D']
    assert 'paper_fig8' in case_names()
    assert math.isclose(make_case('D').pieces[-1, 0], 4.999)
