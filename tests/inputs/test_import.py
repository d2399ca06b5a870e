# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Measured runs as run folders: what was measured and nothing else, and what each verb makes of it."""

import inspect
import json
import math
import shlex
import typing
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import yaml
from scipy.io import savemat

import stickslip_sim as stickslip
from stickslip_sim.core.errors import RecordingError
from stickslip_sim.core.types import EventKind
from stickslip_sim.identification.readings import readings_of
from stickslip_sim.inputs import load_scene
from stickslip_sim.inputs.csv_table import Rows
from stickslip_sim.recording import MeasuredRun, open_bag, read_run
from stickslip_sim.runs import SimulatedRun, simulate
from stickslip_sim.scene import Scene
from tests.support.tool import answered, done, refusals, refused

Capture = pytest.CaptureFixture[str]
COLUMNS = '--columns', 'time=t,position=x,velocity=v,drive_position=s', '--columns', 'drive_force=F'
UNITS = '--unit', 'time=ms,position=mm,velocity=mm/s,drive_position=mm'


@pytest.fixture(scope='module')
def simulated() -> SimulatedRun:
    return simulate(load_scene('paper_fig7'), 6.0, 0.001)


@pytest.fixture(scope='module')
def data(simulated: SimulatedRun, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return what a recorder would have written of a run of the paper's axis."""
    path = tmp_path_factory.mktemp('measured') / 'axis.csv'
    samples = simulated.samples
    columns = [samples[name] for name in ('time', 'position', 'velocity', 'drive_position', 'drive_force')]
    np.savetxt(path, np.array(columns).T * [1e3, 1e3, 1e3, 1e3, 1.0], delimiter=',', header='t [ms],x,v,s [mm],F',
               comments='')
    return path


@pytest.fixture
def run(data: Path, tmp_path: Path, capsys: Capture) -> MeasuredRun:
    out = done(capsys, 'import', data, *COLUMNS, *UNITS, '--out', tmp_path / 'run')
    assert '6001 rows, 6 s: position, velocity, drive_position, drive_force' in out
    assert 'modes and cycles are derived: a slip is faster than' in out
    found = read_run(tmp_path / 'run')
    assert isinstance(found, MeasuredRun)
    return found


def test_what_was_measured_is_there_in_si_and_nothing_else(run: MeasuredRun, simulated: SimulatedRun) -> None:
    assert run.measured == ('position', 'velocity', 'drive_position', 'drive_force')
    assert list(run.bag.topics) == ['/slider_state']
    for name in ('time', *run.measured):
        np.testing.assert_allclose(run.samples[name], simulated.samples[name], rtol=1e-12, atol=1e-15)
    states = run.bag.columns('slider_state')
    assert all(np.isnan(states[name]).all() for name in ('acceleration', 'drive_velocity', 'rest_time'))
    assert set(states['mode'].tolist()) == {255}
    with pytest.raises(RecordingError, match='a measured run without a scene; it has position, velocity'):
        _ = run.scene


def test_cycles_are_derived_from_the_speed(run: MeasuredRun, simulated: SimulatedRun) -> None:
    """To a sample or two; the threshold is passed a little after break-away."""
    found, exact = run.summary.last, simulated.summary.last
    assert found is not None
    assert exact is not None
    assert run.summary.cycles == simulated.summary.cycles > 3
    assert found.period == pytest.approx(exact.period, abs=2e-3)
    assert found.jump == pytest.approx(exact.jump, rel=2e-3)
    assert found.peak_speed == pytest.approx(exact.peak_speed, rel=1e-3)
    assert math.isnan(found.break_away_force)
    kinds = [event.kind for event in run.events]
    assert kinds[:4] == [EventKind.BREAKAWAY, EventKind.DECELERATE, EventKind.STICK, EventKind.BREAKAWAY]
    assert [event.time for event in run.events] == sorted(event.time for event in run.events)


def test_verbs_take_it_as_far_as_what_they_need_was_measured(run: MeasuredRun, tmp_path: Path, capsys: Capture
                                                             ) -> None:
    folder = run.bag.path.parent
    assert answered(capsys, 'plot', folder, '--out', tmp_path / 'run.png')[0] == 0
    assert answered(capsys, 'export', folder, '--csv', '-')[1].count('\n') == 6002
    limits = tmp_path / 'limits.yaml'
    limits.write_text('limits: {following_error: {max: 1.0}, sticks: {max: 99}, peak_speed: {max: 1.0}}\n')
    assert answered(capsys, 'check', folder, '--limits', limits)[0] == 0
    assert 'a measurement; only simulated runs can be verified' in refused(capsys, 'verify', folder)


def test_a_velocity_alone(data: Path, tmp_path: Path, capsys: Capture) -> None:
    answered(capsys, 'import', data, '--columns', 'time=t,velocity=v', '--unit', 'time=ms,velocity=mm/s',
             '--stick-velocity', '1e-3', '--out', tmp_path / 'run')
    assert answered(capsys, 'plot', tmp_path / 'run', '--out', tmp_path / 'run.png')[0] == 0
    run = read_run(tmp_path / 'run')
    assert isinstance(run, MeasuredRun)
    assert run.stick_velocity == 1e-3
    assert run.summary.cycles > 3
    limits = tmp_path / 'limits.yaml'
    limits.write_text('limits: {following_error: {max: 1.0}}\n')
    assert 'following_error needs position and drive_position, which was not measured' in refused(
        capsys, 'check', tmp_path / 'run', '--limits', limits)
    for limit in ('overshoot: {target: 1.0, max: 1.0}', 'settling_time: {target: 1.0, band: 1.0, max: 9.0}'):
        limits.write_text(f'limits: {{{limit}}}', encoding='utf-8')
        assert 'needs position' in refused(capsys, 'check', tmp_path / 'run', '--limits', limits)


def test_a_position_alone(data: Path, tmp_path: Path, capsys: Capture) -> None:
    out = answered(capsys, 'import', data, '--columns', 'time=t,position=x', '--unit', 'time=ms,position=mm',
                   '--out', tmp_path / 'run')[1]
    assert 'note: the velocity follows from the position' in out
    assert read_run(tmp_path / 'run').summary.cycles > 3


def test_topics_of_a_bag(tmp_path: Path, capsys: Capture) -> None:
    answered(capsys, 'simulate', 'paper_fig7', '--duration', '3', '--bag', tmp_path / 'bag')
    out = answered(capsys, 'import', tmp_path / 'bag', '--columns', 'position=slider_state:position,'
                   'friction_force=friction_force:force', '--out', tmp_path / 'run')[1]
    assert 'friction_force: linear between messages, at the times of slider_state' in out
    run, bag = read_run(tmp_path / 'run'), open_bag(tmp_path / 'bag')
    np.testing.assert_array_equal(run.samples['friction_force'], bag.columns('friction_force')['force'])
    assert run.notes[-1].startswith('friction_force: linear')


@pytest.mark.parametrize(('given', 'hint'), refusals(Path(__file__).with_name('import_refusals.txt')))
def test_one_line_says_what_is_wrong(given: str, hint: str, data: Path, tmp_path: Path, capsys: Capture) -> None:
    assert hint in refused(capsys, 'import', data, *shlex.split(given), '--out', tmp_path / 'run')
    assert not (tmp_path / 'run').exists()


@pytest.mark.parametrize(('rows', 'given', 'hint'),
                         yaml.safe_load(Path(__file__).with_name('exports_refused.yaml').read_text(encoding='utf-8')))
def test_a_bad_export_is_refused_in_one_line(rows: str, given: str, hint: str, tmp_path: Path, capsys: Capture) -> None:
    (tmp_path / 'bad.csv').write_text(rows)
    assert hint in refused(capsys, 'import', tmp_path / 'bad.csv', *shlex.split(given), '--out', tmp_path / 'run')


def test_others_are_compared_with_it(run: MeasuredRun, tmp_path: Path, capsys: Capture) -> None:
    """With the axis that it was taken from, and with a heavier one."""
    folder, report = run.bag.path.parent, tmp_path / 'report'
    answered(capsys, 'simulate', 'paper_fig7', '--duration', '6', '--set', 'axis.mass=500.0', '--bag',
             tmp_path / 'heavy')
    out = done(capsys, 'compare', folder, 'paper_fig7', tmp_path / 'heavy', '--duration', '6', '--out', report)
    assert 'modes and cycles are derived' in out
    found = json.loads((report / 'report.json').read_text())
    assert found['measured'] == 'run'
    same, heavy = ({one['name']: one for one in beside['figures']} for beside in found['beside'])
    assert [beside['name'] for beside in found['beside']] == ['paper_fig7', 'heavy']
    assert list(same) == ['period', 'stick', 'slip', 'jump', 'peak speed', 'drive force at break-away',
                          'drive force at arrest']
    for one in same.values():
        assert one['other'] == pytest.approx(one['measured'], rel=5e-3)
    assert heavy['slip']['other'] > 1.1 * heavy['slip']['measured']
    assert {path.name for path in report.iterdir()} == {'overlay.png', 'overlay.svg', 'report.html', 'report.json'}
    page = (report / 'report.html').read_text()
    assert 'data:image/svg+xml' in page
    assert 'drive force at arrest' in page


def test_nothing_to_compare_with(run: MeasuredRun, tmp_path: Path, capsys: Capture) -> None:
    folder = run.bag.path.parent
    assert 'two runs or more with a measured one' in refused(capsys, 'compare', folder, '--out', tmp_path / 'report')
    rest = tmp_path / 'rest.csv'
    rest.write_text('time,velocity\n0,1e-5\n1,0\n2,1e-5\n')
    answered(capsys, 'import', rest, '--columns', 'time=time,velocity=velocity', '--stick-velocity', '1', '--out',
             tmp_path / 'rest')
    answered(capsys, 'simulate', 'paper_fig7', '--duration', '1', '--bag', tmp_path / 'recorded')
    assert 'rest: at rest, no complete cycle to be compared' in refused(
        capsys, 'compare', tmp_path / 'rest', tmp_path / 'recorded', '--out', tmp_path / 'report')
    assert not (tmp_path / 'report').exists()


def test_millimetres_that_were_read_as_metres_are_asked_back(data: Path, tmp_path: Path, capsys: Capture) -> None:
    wrong = tmp_path / 'mm.csv'
    rows = np.loadtxt(data, delimiter=',', skiprows=1)
    np.savetxt(wrong, rows[:, :3], delimiter=',', header='t [ms],x,v', comments='')
    for columns, limit in (('position=x', 'up to 10 m'), ('velocity=v', 'up to 3 m/s')):
        name = columns.partition('=')[0]
        words = ('import', wrong, '--columns', f'time=t,{columns}', '--unit', 'time=ms', '--out', tmp_path / 'run')
        line = refused(capsys, *words)
        assert f'must be plausible for a feed axis, {limit}' in line
        assert f'--unit {name}=mm' in line
        assert answered(capsys, *words[:-1], tmp_path / f'meant_{name}', '--meant', name)[0] == 0
    assert 'one of velocity' in refused(capsys, *words, '--meant', 'position')


def test_noise_that_looks_like_slips_is_noted(simulated: SimulatedRun, tmp_path: Path, capsys: Capture) -> None:
    """Of 20 µm at 1 kHz: the derived periods are of milliseconds; the encoder's own steps of 1 µm say nothing."""
    samples = simulated.samples
    noisy = samples['position'] + np.random.default_rng(0).normal(0.0, 2e-5, len(samples['time']))
    counted = 1e-6 * np.round(samples['position'] / 1e-6)
    for name, positions in (('noisy', noisy), ('counted', counted)):
        path = tmp_path / f'{name}.csv'
        np.savetxt(path, np.array([samples['time'], positions]).T, delimiter=',', header='t,x', comments='')
        said = answered(capsys, 'import', path, '--columns', 'time=t,position=x', '--out', tmp_path / name)[1]
        assert ('lies below the noise of the velocity' in said) == (name == 'noisy')
        assert ('or import it with --stick-velocity 0.0' in said) == (name == 'noisy')


def test_a_unit_has_a_factor(tmp_path: Path, capsys: Capture) -> None:
    """Counts of an encoder that counts backwards, and a motor's voltage."""
    path = tmp_path / 'counts.csv'
    path.write_text('t,counts,volts\n0,0,1\n0.001,-3,2\n0.002,-20,-0.5\n', encoding='utf-8')
    done(capsys, 'import', path, '--columns', 'time=t,position=counts,external_force=volts', '--unit',
         'position=-0.05 um,external_force=35.15N', '--out', tmp_path / 'run')
    samples = read_run(tmp_path / 'run').samples
    assert samples['position'].tolist() == [0.0, 1.5e-7, 1e-6]
    assert samples['external_force'].tolist() == [35.15, 70.3, -17.575]


@pytest.mark.parametrize('unit', ['0 mm', '-mm', '2e99 mm', '5', '1 mm mm'])
def test_a_wrong_factor_is_refused(unit: str, data: Path, tmp_path: Path, capsys: Capture) -> None:
    assert '--unit' in refused(capsys, 'import', data, '--columns', 'time=t,position=x', '--unit',
                               f'time=ms,position={unit}', '--out', tmp_path / 'run')



# Every public function that takes a scene takes its name or path, too, and finds there what `load_scene` finds.

SceneOrPath = Scene | str | Path
SCENE = """\
# An axis with a profile from a file
/**:
  ros__parameters:
    scene: from_file
    friction: {static: {initial: 0.2}, kinetic: {velocities: [0.0, 0.1], coefficients: [0.2, 0.1]}}
    drive: {velocity: 0.01}
    %s: {course: steps, file: profile.csv}
"""
PROFILES = {'drive': 'time,velocity\n0,0.02\n', 'force': 'time,force\n0,10\n', 'normal_load': 'time,force\n0,50\n'}


def run_of(run: stickslip.Run) -> object:
    return run.scene.text, run.events


def refusal_of_identify(scene: SceneOrPath) -> None:
    """The parameters that are sought are looked for in the scene, before the run is read."""
    stickslip.identify('no run', scene, {'axis.mas': {'distribution': 'uniform', 'low': 1.0, 'high': 2.0}})


def creep(t: float, measured: object) -> float:
    return 0.02


CALLS: dict[str, Callable[[SceneOrPath], object]] = {
    'close_loop': lambda scene: run_of(stickslip.close_loop(creep, scene, 0.05)),
    'close_loops': lambda scene: repr(
        stickslip.close_loops(creep, scene, 0.05, {'axis.mass': (50.0, 200.0, 2)}).columns),
    'critical': lambda scene: stickslip.critical(scene, 'axis.mass', (50.0, 200.0), 0.5),
    'design': lambda scene: repr(stickslip.design(scene, ['axis.mass'], duration=0.5, speeds=(1e-2, 2e-2), rate=100.0)),
    'friction_curve': lambda scene: repr(stickslip.friction_curve(stickslip.simulate(scene, 0.5), scene=scene).columns),
    'identify': refusal_of_identify,
    'predict': lambda scene: repr(stickslip.predict(scene, stickslip.simulate(scene, 0.5)).found),
    'sensitivities': lambda scene: repr(stickslip.sensitivities(scene, ['event.1.time'], ['axis.drive_stiffness'])),
    'simulate': lambda scene: run_of(stickslip.simulate(scene, 0.5, 0.1)),
    'simulate_events': lambda scene: run_of(stickslip.simulate_events(scene, 0.5)),
    'sweep': lambda scene: repr(stickslip.sweep(scene, 'axis.mass=50:200:2', duration=0.5).columns),
    'tune': lambda scene: repr(stickslip.tune(creep, scene, 0.02, duration=0.2).loops),
    'uncertainty': lambda scene: stickslip.uncertainty(
        scene, {'axis.mass': {'distribution': 'uniform', 'low': 50.0, 'high': 200.0}}, 16, duration=0.5),
}


def takes_a_scene(name: str) -> bool:
    function = getattr(stickslip, name)
    return inspect.isfunction(function) and any(
        Scene in (hint, *typing.get_args(hint)) for argument, hint in typing.get_type_hints(function).items()
        if argument != 'return')


def outcome(call: Callable[[SceneOrPath], object], scene: SceneOrPath) -> object:
    """Return what a call finds, or the words of its refusal."""
    try:
        return call(scene)
    except stickslip.InputError as error:
        return str(error)


def test_no_public_function_is_forgotten() -> None:
    assert set(CALLS) == {name for name in stickslip.__all__ if takes_a_scene(name)}


@pytest.mark.parametrize('section', PROFILES)
@pytest.mark.parametrize('name', CALLS)
def test_a_path_is_the_scene_that_it_loads(name: str, section: str, tmp_path: Path) -> None:
    """Where a profile is in a file beside the scene, too, and where the scene is then refused."""
    (tmp_path / 'profile.csv').write_text(PROFILES[section])
    path = tmp_path / 'scene.yaml'
    body = SCENE % section
    path.write_text(body.replace('    drive: {velocity: 0.01}\n', '') if section == 'drive' else body)
    expected = outcome(CALLS[name], stickslip.load_scene(path))
    assert outcome(CALLS[name], path) == outcome(CALLS[name], str(path)) == expected


def test_a_name_is_the_scene_that_it_loads() -> None:
    expected = stickslip.simulate_events(stickslip.load_scene('paper_fig7'), 2.0)
    assert run_of(stickslip.simulate_events('paper_fig7', 2.0)) == run_of(expected)
    with pytest.raises(stickslip.InputError, match='did you mean paper_fig'):
        stickslip.simulate_events('paper_fig9', 2.0)


# Exports as they come: what controllers, oscilloscopes and spreadsheets write around the numbers.

ROWS = [(k, 0.5 * k * k, 100.0 + k) for k in range(6)]        # ms, mm, N


def comma(value: float) -> str:
    return f'{value:.3f}'.replace('.', ',')


def lines(pattern: str, *values: Callable[[float], str]) -> str:
    return ''.join(pattern.format(*(f(v) for f, v in zip(values, row))) for row in ROWS)


EXPORTS = {
    'twincat': ('Name\tScope01\nStartRecord\t128783093223690000\n\nName\tPos\tName\tF\nPort\t801\tPort\t801\n\n'
                + lines('{0}\t{1}\t{0}\t{2}\n', str, comma, comma) + 'EOF\n',
                'time=1,position=Pos,drive_force=F', 'time=ms,position=mm'),
    'siemens': ('\ufeff"Trace";"Axis"\r\n"t";"x";"x";"F";"Mode"\r\n"ms";"mm";"mm";"N";""\r\n'
                + lines('{0};{1};{1};{2};"AUTO"\r\n', str, comma, comma) + '//END\r\n',
                'time=t,position=3,drive_force=F', ''),
    'labview': ('LabVIEW Measurement\t\nSeparator\tTab\n***End_of_Header***\t\nChannels\t2\nDelta_X\t0,001\t0,001\n'
                '***End_of_Header***\nX_Value\tx\tF\tComment\n' + lines('{}\t{}\t{}\n', str, comma, comma),
                'time=X_Value,position=x,drive_force=F', 'time=ms,position=mm'),
    'tektronix': ('Record Length,2500,,0,0,100\n' + lines(',,,{},{},{}\n', str, str, str).split('\n', 1)[1],
                  'time=4,position=5,drive_force=6', 'time=ms,position=mm'),
    'lecroy': ('LECROY,1,Waveform\nSegments,1,SegmentSize,3\n#1,21-Apr-2018,0\nTime [ms],x_mm,F\n'
               + lines('{},{},{}\n', str, str, str), 'time=Time,position=x_mm,drive_force=F', ''),
    'excel': ('Prüfstand;Müller\n\nZeit [ms];;Kraft [N]\n' + lines('{};{};{}\n', str, comma, comma),
              'time=Zeit,position=2,drive_force=Kraft', 'position=mm'),
}


# Those of drives: units of turns and ratings, columns that repeat or end blank, and what is refused.

DRIVES: dict[str, tuple[str, dict[str, str], dict[str, str]]] = {
    'startdrive': ('\ufeffFormat;Trace\r\nSampling time;1 ms\r\n\r\nTime [ms];r62 [rpm];r80 M_act [Nm];x [LU]\r\n'
                   + lines('{0};1,5;{2};{1};;\r\n', str, comma, lambda force: comma(force / 100.0)),
                   {'time': 'Time', 'position': 'x', 'drive_force': 'r80 M_act'}, {'position': 'mm'}),
    'rated': ('Sampling;1 ms\n\nTime;Pos;Torque\nms;mm;% rated\n' + lines('{};{};{}\n', str, comma, comma),
              {'time': 'Time', 'position': 'Pos', 'drive_force': 'Torque'}, {}),
    'of rated': ('Time [ms];Pos [mm];Torque [% of rated torque]\n' + lines('{};{};{}\n', str, comma, comma),
                 {'time': 'Time', 'position': 'Pos', 'drive_force': 'Torque'}, {}),
    'twincat 3': ('Name\tScope\nFile\tx.svdx\n\nName\tPos\tPos\tM\tM\nData-Type\tREAL64\tREAL64\tINT16\tINT16\n'
                  'SampleTime[ms]\t1\t1\t1\t1\n' + lines('{0}\t{1}\t{0}\t{2}\t\n', str, comma, str) + 'EOF\n',
                  {'time': '1', 'position': '2', 'drive_force': '4'},
                  {'time': 'ms', 'position': 'mm', 'drive_force': '%'}),
    'rigol': ('X,CH1,CH2,Start,Increment,\nSequence,Volt,Volt,0.0,1.0e-03\n' + lines('{},{},{},,\n', str, str, str),
              {'time': 'X', 'position': 'CH1', 'drive_force': 'CH2'},
              {'time': '1 ms', 'position': '1 mm', 'drive_force': '-1 N'}),
    'heidenhain': ('TNCscope V3\n\nZeit;Lage X;Strom X\n[ms];[mm];[A]\n' + lines('{};{};{};\n', str, comma, comma),
                   {'time': 'Zeit', 'position': 'Lage X', 'drive_force': 'Strom X'}, {'drive_force': '35.15 N'}),
}
SCALES = {'startdrive': 2.0 * np.pi, 'rated': 8.0, 'of rated': 8.0, 'twincat 3': 8.0, 'rigol': -1.0,
          'heidenhain': 35.15}


@pytest.mark.parametrize('name', DRIVES)
def test_an_export_of_a_drive(name: str, tmp_path: Path) -> None:
    text, columns, units = DRIVES[name]
    path = tmp_path / 'export.csv'
    path.write_text(text)
    found = stickslip.Measurement.from_file(path, columns, units, '10 mm', rated='800 N')
    time, position, force = np.array(ROWS).T
    np.testing.assert_allclose(found.times, 1e-3 * time, rtol=1e-14)
    np.testing.assert_allclose(found.columns['position'], 1e-3 * position, rtol=1e-14)
    np.testing.assert_allclose(found.columns['drive_force'], SCALES[name] * force, rtol=1e-14)


def test_the_units_of_labview_are_taken(tmp_path: Path) -> None:
    nptdms = pytest.importorskip('nptdms', reason='npTDMS is not installed')
    time, position, _ = np.array(ROWS).T
    of_time = {'wf_increment': 1e-3, 'wf_start_offset': 0.0, 'wf_samples': len(time)}
    with nptdms.TdmsWriter(str(tmp_path / 'run.tdms')) as file:
        file.write_segment([nptdms.ChannelObject('axis', 'x', position, {**of_time, 'unit_string': 'mm'}),
                            nptdms.ChannelObject('axis', 'U', position, {**of_time, 'unit_string': 'Volts'})])
    found = stickslip.Measurement.from_file(tmp_path / 'run.tdms', {'time': 'time', 'position': 'x'})
    np.testing.assert_allclose(found.times, 1e-3 * time, rtol=1e-14)
    np.testing.assert_allclose(found.columns['position'], 1e-3 * position, rtol=1e-14)
    with pytest.raises(stickslip.InputError, match='Volts'):
        stickslip.Measurement.from_file(tmp_path / 'run.tdms', {'time': 'time', 'position': 'U'})
    (tmp_path / 'bad.tdms').write_bytes(b'no segment' * 20)
    with pytest.raises(stickslip.InputError, match='a readable TDMS file'):
        stickslip.Measurement.from_file(tmp_path / 'bad.tdms', {'time': 'time', 'position': 'x'})


@pytest.mark.parametrize('name', EXPORTS)
def test_an_export_as_it_comes(name: str, tmp_path: Path, capsys: Capture) -> None:
    text, columns, units = EXPORTS[name]
    path = tmp_path / f'{name}.csv'
    path.write_bytes(text.encode('latin-1' if name == 'excel' else 'utf-8'))
    unit = ('--unit', units) if units else ()
    out = done(capsys, 'import', path, '--columns', columns, *unit, '--out', tmp_path / 'run')
    assert ('units of the headings' in out) == (name in ('siemens', 'lecroy', 'excel'))
    samples = read_run(tmp_path / 'run').samples
    expected = np.array(ROWS).T * [[1e-3], [1e-3], [1.0]]
    found = [samples[name] for name in ('time', 'position', 'drive_force')]
    np.testing.assert_allclose(found, expected, rtol=1e-14)


def test_rows_are_chosen_and_bad_ones_counted(tmp_path: Path) -> None:
    """In blocks that are halved down to the bad line, too; one without a time counts wherever it is."""
    rows = [f'{k},{k * 1e-5!r}' for k in range(1000)]
    rows[300], rows[700], rows[800] = '300,', '699,1', 'nan,1'
    path = tmp_path / 'long.csv'
    path.write_text('1,2\n3,4\nt [ms],x\n' + '\n'.join(rows))
    taken = Rows(begin=0.2, end=0.75, every=10, skip=2, drops_bad=True)
    found = stickslip.Measurement.from_file(path, {'time': 't', 'position': 'x'}, rows=taken)
    wanted = [k for k in range(200, 751, 10) if k not in (300, 700)]
    np.testing.assert_allclose(found.times, np.array(wanted) / 1e3, rtol=1e-15)
    np.testing.assert_allclose(found.columns['position'], np.array(wanted) * 1e-5, rtol=1e-15)
    assert '3 bad rows are left out' in found.remarks


def test_arrays_frames_and_other_files(tmp_path: Path) -> None:
    time, position = np.arange(5.0), np.arange(5.0) ** 2
    from_arrays = stickslip.Measurement.from_arrays(time=time, position=position,
                                                    units={'time': 'ms', 'position': 'mm'})
    assert repr(from_arrays) == '<Measurement: 5 rows, 0 to 0.004 s: position>'
    savemat(tmp_path / 'run.mat', {'run': {'t': time, 'x': position}, 'M': np.column_stack([position, time])})
    from_file = stickslip.Measurement.from_file(tmp_path / 'run.mat', {'time': 'run.t', 'position': 'M[1]'},
                                                {'time': 'ms', 'position': 'mm'})
    from_frame = stickslip.Measurement.from_frame({'t [ms]': time, 'x [mm]': position},
                                                  {'time': 't', 'position': 'x'})
    for one in (from_arrays, from_file, from_frame):
        assert one.times.tolist() == [0.0, 0.001, 0.002, 0.003, 0.004]
        assert one.columns['position'].tolist() == [0.0, 0.001, 0.004, 0.009, 0.016]
    from_arrays.write(tmp_path / 'run')
    assert read_run(tmp_path / 'run').samples['position'][4] == 0.016
    with pytest.raises(stickslip.InputError, match='frame row 2 = nan is refused: must be a finite number in column x'):
        stickslip.Measurement.from_frame({'t': [0.0, 1.0], 'x': [0.0, math.nan]}, {'time': 't', 'position': 'x'})


def test_a_turning_axis_has_a_lead(tmp_path: Path) -> None:
    """10 mm a turn: 600 rpm are 0.1 m/s, and 1 N m moves with 628 N."""
    found = stickslip.Measurement.from_frame({'t': [0.0, 1.0], 'n [rpm]': [0.0, 600.0], 'M [Nm]': [0.0, 1.0]},
                                             {'time': 't', 'velocity': 'n', 'drive_force': 'M'}, lead='10 mm')
    assert found.columns['velocity'][1] == pytest.approx(0.1, rel=1e-15)
    assert found.columns['drive_force'][1] == pytest.approx(200.0 * math.pi, rel=1e-15)


def test_a_force_alone_has_the_position_of_its_spring(simulated: SimulatedRun, tmp_path: Path) -> None:
    """That of an axis whose drive has no damping; identify takes the position, and not the force again."""
    run = simulate(simulated.scene, 2.0, 0.001)
    scene, samples = run.scene, run.samples
    force = scene.axis.drive_stiffness * (samples['drive_position'] - samples['position'])
    measured = stickslip.Measurement.from_arrays(time=samples['time'], drive_force=force)
    with pytest.raises(stickslip.InputError, match='with a position or a velocity of the slider'):
        measured.write(tmp_path / 'none')
    derived = measured.with_spring(scene.axis.drive_stiffness, samples['drive_position'][-1] / 2.0)
    np.testing.assert_allclose(derived.columns['position'], samples['position'], atol=1e-12)
    derived.write(tmp_path / 'run')
    found = read_run(tmp_path / 'run')
    assert isinstance(found, MeasuredRun)
    assert 'the position is derived, not measured: x = v t - F/k' in found.notes[-1]
    assert [one.name for one in readings_of(found, scene, {}).channels] == ['position']
