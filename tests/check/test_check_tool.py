# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip check` as a user meets it: runs and scenes in, table, JUnit XML, JSON and exit code out."""

import json
import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from stickslip_sim.check.measures import CIRCLE_KINDS, KINDS
from stickslip_sim.cli.main import run
from stickslip_sim.figures.positioning import PositioningFigures
from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import OfflineBag, RunFacts
from stickslip_sim.recording.offline_bag import StepMessages
from stickslip_sim.runs import simulate
from tests.support.check_files import DURATION, LIMITS, checked, cut, limits_file, node_bag, refused
from tests.support.repository import ROOT
from tests.support.tool import Capture, done

EXAMPLE = str(ROOT / 'examples' / 'limits.yaml')
FAILING = LIMITS.replace('1}', '0}').replace('0.02', '0.01')


@pytest.fixture(scope='module')
def bag(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp('runs') / 'jump'
    assert run(['simulate', 'paper_fig7', '--duration', DURATION, '--bag', str(folder)]) == 0
    return folder


class TestOutcome:
    def test_passed(self, tmp_path: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, LIMITS)
        out = done(capsys, 'check', 'paper_fig7', '--duration', DURATION, '--limits', limits)
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

    def test_the_name_of_a_scene_is_the_scene(self, tmp_path: Path, capsys: Capture, monkeypatch: pytest.MonkeyPatch
                                              ) -> None:
        """Also where a folder of that name is."""
        monkeypatch.chdir(tmp_path)
        (tmp_path / 'paper_fig7').mkdir()
        limits = limits_file(tmp_path, LIMITS)
        assert checked(capsys, 'paper_fig7', '--duration', DURATION, '--limits', limits)[0] == 0
        assert 'no recorded run there' in refused(capsys, './paper_fig7', '--limits', limits)

    def test_a_run_that_does_not_suit_the_limits_is_named_and_the_others_are_checked(
            self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        short = node_bag(tmp_path / 'short', None)
        limits = limits_file(tmp_path, 'window: {end: 1.0}\n' + LIMITS)
        code, out, err = checked(capsys, bag, short, '--limits', limits, '--json', tmp_path / 'found.json')
        assert (code, out.splitlines()[-2:]) == (2, ['PASSED: 3 of 3', f'1 of 2 runs keep {limits}'])
        assert err.startswith(f'stickslip: {short} cannot be checked: sticks.window.end = 1.0 is refused')
        assert checked(capsys, short, bag, '--limits', limits)[1:] == (out, err)
        assert not (tmp_path / 'found.json').exists()

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
        out = done(capsys, 'check', 'positioning', '--duration', '2', '--limits', EXAMPLE)
        assert out in text
        assert Path(EXAMPLE).read_text() in text
        of_iso = {*CIRCLE_KINDS, *PositioningFigures._fields}
        for kind in KINDS.values():
            if kind.name not in of_iso:
                (row,) = re.findall(rf'^\| (?:`\w+`, )?`{kind.name}`(?:, `\w+`)? \|.*$', text, re.MULTILINE)
                assert all(f'`{setting.name}`' in row for setting in kind.settings)
        for name in of_iso:
            way, plain = name.rpartition('_')[2], re.sub('_(forward|backward)$', '', name)
            assert re.search(rf'^\|.*`{plain}`.*{f"_{way}`" if plain != name else ""}.*\|$', text, re.MULTILINE)


class TestSeveral:
    def test_each_is_checked_and_one_that_fails_fails_all(self, tmp_path: Path, bag: Path, capsys: Capture) -> None:
        limits = limits_file(tmp_path, 'limits: {sticks: {max: 1}, peak_speed: {max: 0.014}}')
        xml, found = tmp_path / 'c.xml', tmp_path / 'c.json'
        code, out, err = checked(capsys, bag, 'fast_feed', '--duration', DURATION, '--set', 'drive.velocity=0.0',
                                 '--limits', limits, '--junit', xml, '--json', found)
        assert code == 3
        assert [line for line in out.splitlines() if line.startswith(('PASSED', 'FAILED'))] == [
            'FAILED: 1 of 2: peak_speed', 'PASSED: 2 of 2']
        assert out.splitlines()[-2:] == [f'1 of 2 runs keep {limits}', f'written: {found}, {xml}']
        assert err == f'stickslip: {bag} does not keep {limits}: peak_speed\n'
        root = ElementTree.parse(xml).getroot()
        assert (root.tag, [(suite.tag, suite.attrib['name']) for suite in root]) == (
            'testsuites', [('testsuite', str(bag)), ('testsuite', 'fast_feed')])
        both = json.loads(found.read_text())
        assert (both['passed'], [(one['run']['name'], one['passed']) for one in both['runs']]) == (
            False, [(str(bag), False), ('fast_feed', True)])

    def test_folders_of_one_name_keep_theirs_apart(self, tmp_path: Path, bag: Path, capsys: Capture) -> None:
        other = cut(bag, tmp_path / 'jump', 0.7)
        limits = limits_file(tmp_path, 'limits: {sticks: {max: 1}}')
        out = done(capsys, 'check', bag, other, '--limits', limits)
        assert [line.partition(': ')[0] for line in out.splitlines() if ' states, ' in line] == [str(bag), str(other)]

    def test_a_run_given_twice_is_refused(self, tmp_path: Path, bag: Path, capsys: Capture) -> None:
        assert 'only once' in refused(capsys, bag, bag, '--limits', limits_file(tmp_path, LIMITS))


class TestRuns:
    def test_a_recorded_run_has_the_figures_of_the_simulation(self, bag: Path, tmp_path: Path, capsys: Capture) -> None:
        given = {'band': 1e-4, 'speed': 1e-4, 'within': 0.1}
        known = [kind for kind in KINDS.values() if 'dwell' not in {setting.name for setting in kind.settings}]
        target = 'target: 0.001\nwindow: {end: 1.4}\nlimits:\n' + ''.join(
            f'  {kind.name}: {{{kind.bound.name}: 100' + ''.join(
                f', {setting.name}: {given[setting.name]}' for setting in kind.settings if setting.name in given)
            + '}\n' for kind in known)
        limits = limits_file(tmp_path, target)
        found = []
        for source in ([bag], ['paper_fig7', '--duration', DURATION], [next(bag.glob('*.mcap'))]):
            code, out, _ = checked(capsys, *source, '--limits', limits, '--json', '-')
            assert code == 3   # it does not settle
            found.append(json.loads(out)['limits'])
        assert found[0] == found[1] == found[2]
        assert len(found[0]) == len(known)

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

    def test_missing_steps_are_reported(self, tmp_path: Path, capsys: Capture) -> None:
        scene = load_scene('paper_fig7')
        bag = OfflineBag(tmp_path / 'bag', RunFacts.of(scene))
        samples = simulate(scene, 0.2, scene.time.step).samples
        for first, last in ((0, 50), (53, 201)):
            bag.write(StepMessages().block(first, {name: column[first:last] for name, column in samples.items()}, []))
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
        properties, case = ElementTree.parse(tmp_path / 'c.xml').getroot()
        assert (case[0].tag, case[0].text) == ('system-out' if valid else 'failure', verdict)
        assert properties[0].attrib == {'name': 'real time', 'value': verdict}

    def test_names_that_xml_cannot_hold(self, tmp_path: Path, capsys: Capture) -> None:
        folder = node_bag(tmp_path / 'a\x01<&"', {'valid': False, 'verdict': 'no\x00 & <'})
        code, _, _ = checked(capsys, folder, '--limits', limits_file(tmp_path, 'limits: {timing: valid}'), '--junit',
                             tmp_path / 'c.xml')
        suite = ElementTree.parse(tmp_path / 'c.xml').getroot()
        assert (code, suite.attrib['name'], suite[1][0].text) == (3, 'a?<&"', 'no? & <')
