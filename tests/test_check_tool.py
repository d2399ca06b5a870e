# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check` as a user meets it: runs and scenes in, table, JUnit XML, JSON and exit code out."""

import json
import re
import signal
from pathlib import Path
from xml.etree import ElementTree

import pytest

from stickslip_sim.check.kinds import KINDS
from stickslip_sim.cli.main import run
from stickslip_sim.offline import run_offline
from stickslip_sim.recording import BagWriter, OfflineBag, RunFacts, read_run, topics, write_bag
from stickslip_sim.scene import load_scene
from stickslip_sim.words import Sample
from tests.check_files import checked, cut, limits_file, node_bag, refused
from tests.tool import Capture

ROOT = Path(__file__).parents[1]
EXAMPLE = str(ROOT / 'examples' / 'limits.yaml')
LIMITS = 'limits: {sticks: {max: 1}, longest_stick: {max: 1.0}, peak_speed: {max: 0.02}}'
FAILING = LIMITS.replace('1}', '0}').replace('0.02', '0.01')
DURATION = '1.4'   # s; paper_fig7 sticks once


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('runs') / 'jump'
    assert run(['simulate', 'paper_fig7', '--duration', DURATION, '--bag', str(folder)]) == 0
    return folder


class TestOutcome:
    def test_passed(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, LIMITS)
        code, out, err = checked(capsys, 'paper_fig7', '--duration', DURATION, '--limits', limits)
        assert (code, err) == (0, '')
        head, heads, *rows, verdict = out.splitlines()
        assert head == 'paper_fig7: 0 to 1.4 s, 1401 states, 5 transitions'
        assert heads.split() == ['limit', 'measured', 'at', 'most', 'margin']
        measured = [row.split()[:2] for row in rows]
        assert measured == [['sticks', '1'], ['longest_stick', '679.8'], ['peak_speed', '14.561']]
        assert len({row.index('PASS') for row in rows}) == 1
        assert verdict == 'PASSED: 3 of 3'

    def test_failed(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, FAILING)
        code, out, err = checked(capsys, 'paper_fig7', '--duration', DURATION, '--limits', limits)
        assert code == 3
        assert out.splitlines()[-1] == 'FAILED: 2 of 3: sticks, peak_speed'
        assert re.search(r'sticks +1 +0 +-1 +FAIL', out)
        assert err == f'stickslip: paper_fig7 does not keep {limits}: sticks, peak_speed\n'

    def test_a_changed_scene(self, tmp_path: Path, capsys: Capture) -> None:
        code, out, _ = checked(capsys, 'paper_fig7', '--duration', DURATION, '--set', 'drive.velocity=0.0', '--limits',
                               limits_file(tmp_path, LIMITS))
        assert (code, out.splitlines()[-1]) == (3, 'FAILED: 1 of 3: longest_stick')
        assert '0 transitions' in out

    def test_junit(self, tmp_path: Path, capsys: Capture) -> None:
        path = tmp_path / 'c.xml'
        code, out, _ = checked(capsys, 'paper_fig7', '--duration', DURATION, '--limits', limits_file(tmp_path, FAILING),
                               '--junit', path)
        suite = ElementTree.parse(path).getroot()
        assert (code, suite.tag) == (3, 'testsuite')
        assert suite.attrib == {'name': 'paper_fig7', 'tests': '3', 'failures': '2', 'errors': '0'}
        cases = {case.attrib['name']: case for case in suite}
        assert [*cases] == ['sticks', 'longest_stick', 'peak_speed']
        assert [[part.tag for part in case] for case in suite] == [['failure'], ['system-out'], ['failure']]
        assert {(case.tag, case.attrib['classname']) for case in suite} == {('testcase', 'stickslip.check.paper_fig7')}
        assert cases['sticks'][0].attrib == {'type': 'limit', 'message': 'sticks = 1, limit 0'}
        assert re.match(r'peak_speed = 0\.01456149\d+ m/s, limit 0\.01 m/s', str(cases['peak_speed'][0].text))
        assert 'FAILED' in out
        assert sorted(file.name for file in tmp_path.iterdir()) == ['c.xml', 'limits.yaml']

    def test_json(self, tmp_path: Path, capsys: Capture) -> None:
        text = 'limits: {never: {check: settling_time, target: 1.0, band: 1.0e-3, max: 1.0}, sticks: {max: 3}}'
        code, out, _ = checked(capsys, 'paper_fig7', '--duration', DURATION, '--limits', limits_file(tmp_path, text),
                               '--json', '-')
        found = json.loads(out)
        assert (code, found['passed'], found['run']['states']) == (3, False, 1401)
        never, sticks = found['limits']
        assert (never['measured'], never['margin'], never['target'], never['passed']) == ('inf', '-inf', 1.0, False)
        assert (sticks['measured'], sticks['max'], sticks['margin'], sticks['passed']) == (1, 3, 2, True)

    def test_the_example_and_every_figure_are_in_the_documentation(self, capsys: Capture) -> None:
        text = (ROOT / 'docs' / 'check.md').read_text()
        code, out, _ = checked(capsys, 'positioning', '--duration', '2', '--limits', EXAMPLE)
        assert code == 0
        assert out in text
        assert Path(EXAMPLE).read_text() in text
        for kind in KINDS.values():
            (row,) = re.findall(rf'^\| `{kind.name}` \|.*$', text, re.MULTILINE)
            assert all(f'`{setting.name}`' in row for setting in kind.settings)
            assert f'| {kind.unit} |' in row


class TestRuns:
    def test_a_recorded_run_has_the_figures_of_the_simulation(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        target = 'target: 0.001\nwindow: {end: 1.4}\nlimits:\n' + ''.join(
            f'  {name}: {{max: 100{", band: 1.0e-4" if name == "settling_time" else ""}}}\n' for name in KINDS)
        limits = limits_file(tmp_path, target)
        found = []
        for source in ([bag], ['paper_fig7', '--duration', DURATION], [next(bag.glob('*.mcap'))]):
            code, out, _ = checked(capsys, *source, '--limits', limits, '--json', '-')
            assert code == 3   # it does not settle
            found.append(json.loads(out)['limits'])
        assert found[0] == found[1] == found[2]
        assert len(found[0]) == len(KINDS)

    @pytest.mark.parametrize('share', [0.4, 0.7])
    def test_a_run_that_was_cut_off(self, share: float, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        text = ('limits: {timing: valid, following_error: {max: 1.0},'
                ' later: {check: sticks, max: 3, window: {begin: 1.35}}}')
        code, out, err = checked(capsys, cut(bag, tmp_path / 'cut', share), '--limits', limits_file(tmp_path, text))
        assert code == 3
        assert err.count('\n') == 1
        end = float(re.search(r'note: the recording has no end: checked up to t = (\S+) s', out)[1])   # type: ignore[index]
        assert 0.2 < end < 1.35
        assert re.search(r'following_error .* PASS', out)
        assert 'nothing from t = 1.35 s on' in out
        assert re.search(r'timing .* FAIL  the run has no end, no verdict', out)
        assert 'FAILED: 2 of 3: later, timing' in out

    def test_missing_steps_are_told(self, tmp_path: Path, capsys: Capture) -> None:
        scene = load_scene('paper_fig7')
        bag = OfflineBag(tmp_path / 'bag', RunFacts.of(scene))
        for step, sample in enumerate(run_offline(scene, 0.2, scene.time.step).sample_rows()):
            if not 50 <= step < 53:
                bag.sample(step, sample)
        bag.close({})
        code, out, _ = checked(capsys, tmp_path / 'bag', '--limits', limits_file(tmp_path, LIMITS))
        assert (code, out.splitlines()[1]) == (0, 'note: 3 of 201 steps are missing in the recording')

    @pytest.mark.parametrize(('valid', 'code'), [(True, 0), (False, 3)])
    def test_the_verdict_of_the_node(self, valid: bool, code: int, tmp_path: Path, capsys: Capture) -> None:
        verdict = 'real-time valid: worst lateness 0.41 ms at t = 12.3 s'
        folder = node_bag(tmp_path / 'run', {'valid': valid, 'verdict': verdict})
        limits = limits_file(tmp_path, 'limits: {timing: valid}')
        found, out, _ = checked(capsys, folder, '--limits', limits, '--junit', tmp_path / 'c.xml')
        assert found == code
        assert re.search(rf'timing .* {"PASS" if valid else "FAIL"}  {re.escape(verdict)}', out)
        (case,) = ElementTree.parse(tmp_path / 'c.xml').getroot()
        assert (case[0].tag, case[0].text) == ('system-out' if valid else 'failure', verdict)

    def test_names_that_xml_cannot_hold(self, tmp_path: Path, capsys: Capture) -> None:
        folder = node_bag(tmp_path / 'a\x01<&"', {'valid': False, 'verdict': 'no\x00 & <'})
        code, _, _ = checked(capsys, folder, '--limits', limits_file(tmp_path, 'limits: {timing: valid}'), '--junit',
                             tmp_path / 'c.xml')
        suite = ElementTree.parse(tmp_path / 'c.xml').getroot()
        assert (code, suite.attrib['name'], suite[0][0].text) == (3, 'a?<&"', 'no? & <')


class TestRefusals:
    @pytest.mark.parametrize(('text', 'words'), [
        ('', ['file', 'limits']),
        ('[1]', ['file', 'window, target, reference, limits']),
        ('limits:', ['line 1', 'missing']),
        ('limits: {}', ['limits', 'at least one limit']),
        ('limits: 3', ['limits = 3', 'at least one limit']),
        ('limit: {sticks: {max: 1}}', ['limit', 'did you mean limits?']),
        ('limits: {stick: {max: 1}}', ["'stick'", 'did you mean sticks?']),
        ('limits: {mine: {max: 1}}', ["'mine'", 'following_error, end_position_error', 'check: sticks']),
        ('limits: {mine: {check: stics, max: 1}}', ['mine.check', 'did you mean sticks?']),
        ('limits: {mine: {check: 3, max: 1}}', ['mine.check = 3', 'one of']),
        ('limits: {sticks: 3}', ['sticks = 3', '{max: 1.0e-3}']),
        ('limits: {sticks: {maximum: 3}}', ['sticks.maximum = 3', 'one of check, max, window', 'did you mean max?']),
        ('limits: {sticks: {}}', ['sticks.max', 'add it']),
        ('limits: {sticks: {max: 1.5}}', ['sticks.max = 1.5', 'whole number']),
        ('limits: {sticks: {max: -1}}', ['sticks.max = -1', '>= 0']),
        ('limits: {sticks: {max: 1, max: 2}}', ['max is given twice']),
        ('limits: {overshoot: {target: 0.1, max: .nan}}', ['overshoot.max = nan', '>= 0']),
        ('limits: {overshoot: {target: 0.1, max: .inf}}', ['overshoot.max = inf', '<= 1e+12 m']),
        ('limits: {overshoot: {target: 0.1, max: "1"}}', ["overshoot.max = '1'", 'without quotes']),
        ('limits: {overshoot: {target: 0.1, max: 1 mm}}', ["overshoot.max = '1 mm'", 'a number']),
        ('limits: {overshoot: {target: true, max: 1.0}}', ['overshoot.target = True', 'a number']),
        ('limits: {overshoot: {max: 1.0}}', ['overshoot.target', 'add it']),
        ('limits: {settling_time: {target: 0.0, max: 1.0}}', ['settling_time.band', '> 0']),
        ('limits: {settling_time: {target: 0.0, band: 0.0, max: 1.0}}', ['settling_time.band = 0.0', '> 0']),
        ('limits: {limit_cycle_amplitude: {cycles: 0, max: 1.0}}', ['cycles = 0', '>= 1']),
        ('limits: {peak_speed: {target: 0.0, max: 1.0}}', ['peak_speed.target', 'one of check, max, window']),
        ('limits: {timing: invalid}', ["timing = 'invalid'", 'valid']),
        ('limits: {timing: {max: 1}}', ['timing', 'valid']),
        ('limits: {timing: valid}', ['timing', 'the node recorded in real time', 'drop this limit']),
        ('target: far\n' + LIMITS, ["target = 'far'", 'a number']),
        ('window: 3\n' + LIMITS, ['window = 3', 'begin, end']),
        ('window: {start: 3.0}\n' + LIMITS, ['window.start = 3.0', 'begin, end']),
        ('window: {begin: 0.3, end: 0.3}\n' + LIMITS, ['window = [0.3, 0.3]', 'begin before end']),
        ('window: {begin: -1.0}\n' + LIMITS, ['window.begin = -1.0', '>= 0']),
        ('window: {end: 1.5}\n' + LIMITS, ['sticks.window.end = 1.5', '0 to 1.4 s']),
        ('window: {begin: 0.0001, end: 0.0002}\n' + LIMITS, ['window = [0.0001, 0.0002]', 'one sample']),
        ('limits: {overshoot: {target: 0.0, max: 1.0}}', ['overshoot.target = 0.0', 'another place', 'begin before']),
        ('reference: 3\n' + LIMITS, ['reference = 3', 'times, positions']),
        ('reference: {times: [0.0]}\n' + LIMITS, ['reference.positions', 'add it']),
        ('reference: {times: [0.0, 1.0], positions: [0.0]}\n' + LIMITS, ['reference.positions = [0.0]', '(2)']),
        ('reference: {times: [1.0, 1.0], positions: [0.0, 1.0]}\n' + LIMITS, ['reference.times', 'increasing']),
        ('reference: {times: [], positions: []}\n' + LIMITS, ['reference.times', 'at least one']),
        ('limits: {"a\\nb": {check: sticks, max: 1}}', ['name', 'printable']),
        ('limits: {sticks: {max: 1}', ['line 1']),
        ('limits: &x {sticks: {max: 1}}\nwindow: *x', ['aliases']),
    ])
    def test_limits(self, text: str, words: list[str], tmp_path: Path, capsys: Capture) -> None:
        path = limits_file(tmp_path, text)
        line = refused(capsys, 'paper_fig7', '--duration', DURATION, '--limits', path, '--junit', tmp_path / 'c.xml')
        for word in words:
            assert word in line
        assert [file.name for file in tmp_path.iterdir()] == ['limits.yaml']

    def test_limits_that_are_no_text(self, tmp_path: Path, capsys: Capture) -> None:
        (tmp_path / 'b.yaml').write_bytes(b'\xff\xfe\x00')
        arguments = ['paper_fig7', '--duration', DURATION, '--limits']
        assert 'is it a limits file?' in refused(capsys, *arguments, tmp_path / 'b.yaml')
        assert 'Is a directory' in refused(capsys, *arguments, tmp_path)
        assert 'No such file' in refused(capsys, *arguments, tmp_path / 'none.yaml')

    @pytest.mark.parametrize(('arguments', 'words'), [
        (['paper_fig7'], ['--duration S', 'check --help']),
        (['paper_fig7', '--duration', '0'], ['duration = 0.0', '> 0']),
        (['paper_fig7', '--duration', '1e9'], ['rows']),
        (['paper_fig9', '--duration', '1'], ['paper_fig9', 'did you mean']),
        (['no/such/folder', '--duration', '1'], ['folder', 'readable']),
        (['no_such.mcap'], ['no_such.mcap', 'no recorded run']),
        (['paper_fig7', '--duration', '1', '--set', 'axis.mass=-1'], ['axis.mass']),
        (['paper_fig7', '--duration', '1', '--junit', '/no/folder/c.xml'], ['--junit', '/no/folder']),
        (['paper_fig7', '--duration', '1', '--junit', '-', '--json', '-'], ['--json', '--junit']),
        (['BAG', '--duration', '1'], ['--duration and --set', 'recorded']),
        (['BAG', '--set', 'axis.mass=1.0'], ['--duration and --set', 'recorded']),
    ])
    def test_wrong_use(self, arguments: list[str], words: list[str], bag: Path, tmp_path: Path,
                       capsys: Capture) -> None:
        given = [str(bag) if argument == 'BAG' else argument for argument in arguments]
        line = refused(capsys, *given, '--limits', limits_file(tmp_path, LIMITS))
        for word in words:
            assert word in line

    @pytest.mark.parametrize('content', [b'', b'no bag at all, but long enough to look like one'])
    def test_no_bag(self, content: bytes, tmp_path: Path, capsys: Capture) -> None:
        (tmp_path / 'x.mcap').write_bytes(content)
        assert 'x.mcap' in refused(capsys, tmp_path / 'x.mcap', '--limits', limits_file(tmp_path, LIMITS))

    def test_a_bag_of_another_thing(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, LIMITS)
        BagWriter(tmp_path / 'other', [topics.DIAGNOSTICS, topics.TIMING], {}, {}).close()
        line = refused(capsys, tmp_path / 'other', '--limits', limits)
        assert 'no topic of type stickslip_msgs/msg/SliderState' in line
        cells = [*topics.recorded('/a'), *topics.recorded('/b')]
        BagWriter(tmp_path / 'two', [topic for topic in cells if topic is not topics.PARAMETER_EVENTS], {}, {}).close()
        assert 'are both of type' in refused(capsys, tmp_path / 'two', '--limits', limits)

    def test_a_bag_without_states(self, tmp_path: Path, capsys: Capture) -> None:
        BagWriter(tmp_path / 'empty', topics.recorded(), {}, {}).close()
        limits = limits_file(tmp_path, LIMITS)
        assert 'no state of the axis' in refused(capsys, tmp_path / 'empty', '--limits', limits)

    def test_a_bag_of_two_runs(self, tmp_path: Path, capsys: Capture) -> None:
        scene = load_scene('paper_fig7')
        rows: list[Sample] = [*run_offline(scene, 0.01, scene.time.step).sample_rows()]
        write_bag(tmp_path / 'two', RunFacts.of(scene), rows + rows, [], {})
        assert 'time goes back' in refused(capsys, tmp_path / 'two', '--limits', limits_file(tmp_path, LIMITS))

    @pytest.mark.parametrize('timing', [None, {'steps': 3}, {'valid': None, 'verdict': 'not in real time'}, 'good'])
    def test_a_bag_without_a_verdict(self, timing: object, tmp_path: Path, capsys: Capture) -> None:
        folder = node_bag(tmp_path / 'run', timing)
        line = refused(capsys, folder, '--limits', limits_file(tmp_path, 'limits: {timing: valid}'))
        assert 'only a run that the node recorded in real time' in line


@pytest.mark.ros
def test_a_run_of_the_node_has_the_figures_of_the_simulation(tmp_path: Path, capsys: Capture) -> None:
    from tests.ros_nodes import client, running

    folder = tmp_path / 'run'
    text = 'window: {end: 1.0}\nlimits: {' + ''.join(
        f'{name}: {{max: 1}}, ' for name in ('following_error', 'sticks', 'longest_stick', 'peak_speed')) + '}'
    limits = limits_file(tmp_path, text)
    with running('-r', '__ns:=/cell', '-p', 'scene:=paper_fig7', '-p', 'record.enabled:=true', '-p',
                 f'record.folder:={folder}') as process, client('/cell') as axis:
        axis.connect()
        axis.next('slider_state', lambda state: state.time > 1.0)
        assert process.end(signal.SIGINT)[0] == 0
    found = []
    for source in ([folder], ['paper_fig7', '--duration', '1.0']):
        code, out, _ = checked(capsys, *source, '--limits', limits, '--json', '-')
        assert code == 0
        found.append(json.loads(out)['limits'])
    assert found[0] == found[1]
    (tmp_path / 'timing.yaml').write_text('limits: {timing: valid}')
    code, out, _ = checked(capsys, folder, '--limits', tmp_path / 'timing.yaml')
    receipt = read_run(folder).receipt['timing']
    assert code == (0 if receipt['valid'] else 3)
    assert receipt['verdict'] in out
