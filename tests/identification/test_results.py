# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The files of an identification: the scene, what is left open of it, and the report."""

import json
import math
import re
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from stickslip_sim.figures.point_figures import FIGURES
from stickslip_sim.identification.free_parameters import FreeParameter
from stickslip_sim.identification.identified import (
    AT_BOUND,
    NOT_IDENTIFIABLE,
    Combination,
    Estimate,
    Identification,
    LawFit,
    Misfit,
    StartEnd,
)
from stickslip_sim.identification.identified_scene import IDENTIFIED_SCENE, identified_text, posterior_text
from stickslip_sim.identification.identify import identify
from stickslip_sim.identification.measured_friction import (
    binned,
    friction_points,
    half_width,
    kinetic_of,
    known_friction,
    phases,
    slip_share,
    static_of,
    usual_cycles,
)
from stickslip_sim.identification.report import (
    IDENTIFIED_PAGE,
    IDENTIFIED_VALUES,
    POSTERIOR,
    fitted_channels,
    write_results,
)
from stickslip_sim.inputs import load_scene
from stickslip_sim.plots.characteristics import plot_known_friction
from stickslip_sim.plots.identified_motion import plot_fit
from stickslip_sim.recording.measured_run import MeasuredRun
from stickslip_sim.scene import scene_from_values
from stickslip_sim.scene.load import parse_scene
from stickslip_sim.scene.ros_yaml import read_yaml
from stickslip_sim.study import Saltelli, Study
from stickslip_sim.study.uncertainty import uncertain_of, uncertainty_of
from tests.support.measured_runs import FREE, START, few_starts, free_file, readings, start_scene
from tests.support.measured_runs import VALUES as TRUTH

STATIC = 'friction.static.initial'


@pytest.fixture(scope='module')
def run(tmp_path_factory: pytest.TempPathFactory) -> MeasuredRun:
    return readings().as_run(tmp_path_factory.mktemp('runs') / 'measured')


@pytest.fixture(scope='module')
def found(run: MeasuredRun, tmp_path_factory: pytest.TempPathFactory) -> Identification:
    return identify(run, start_scene(), free_file(tmp_path_factory.mktemp('free') / 'free.yaml'))


@pytest.fixture(scope='module')
@few_starts()
def slip_by_slip(tmp_path_factory: pytest.TempPathFactory) -> tuple[MeasuredRun, Identification]:
    """Return a run that begins late, of another mass than that of the scene: single slips are fitted."""
    measured = readings({**TRUTH, 'axis.mass': 50.0}, 3.0)
    other = measured._replace(times=measured.times + 100.0).as_run(tmp_path_factory.mktemp('other') / 'measured')
    return other, identify(other, start_scene(), free_file(tmp_path_factory.mktemp('free') / 'free.yaml'))


def truth_of(name: str) -> float:
    values = {**TRUTH, 'friction.kinetic.coefficients[0]': 0.12}
    value = values[name]
    assert isinstance(value, float)
    return value


def with_estimate(found: Identification, name: str, **changes: object) -> Identification:
    estimates = tuple(replace(one, **changes) if one.name == name else one for one in found.estimates)  # type: ignore[arg-type]
    return replace(found, estimates=estimates)


def distributions(text: str) -> Mapping[str, Mapping[str, object]]:
    document = read_yaml(text)
    assert isinstance(document, dict)
    found = document['parameters']
    assert isinstance(found, dict)
    return found


def test_the_scene_is_what_was_found_and_says_so_of_each_number(found: Identification) -> None:
    text = identified_text(found, 'measured', 'start.yaml')
    scene = parse_scene(text)
    for one in found.estimates:
        assert one.value == pytest.approx(truth_of(one.name), rel=0.02)
    assert scene.values['axis.drive_stiffness'] == pytest.approx(found.values['axis.drive_stiffness'], rel=1e-5)
    assert scene.values['axis.mass'] == 100.0
    assert re.search(r'mass: 100\.0 +# kg; as in start\.yaml$', text, re.MULTILINE)
    assert re.search(r'drive_stiffness: \S+ +# N/m; found \(.* to .*\), start 160000: ', text)
    assert re.search(r'coefficients: \[.*\] +# \[0\] found \(.*\), start 0\.14: .*; the others in start\.yaml$', text,
                     re.MULTILINE)
    assert text.startswith('# measured_axis: identified from position and drive_force of the run measured, ')


def test_a_scene_that_does_not_fit_says_so_in_its_head(found: Identification) -> None:
    misfit = Misfit('position', 'mean square', 9.0, 1.2, 0.0, 1.0, 'position is off by 3 times the noise')
    both = Combination(('axis.mass', STATIC), (1.0, 1.0), math.inf, 'the data determine only a ratio')
    text = identified_text(replace(found, misfits=(misfit,), combinations=(both,)), 'measured', 'start.yaml')
    assert '# THE MODEL DOES NOT FIT this run' in text
    assert '# the data determine only a ratio\n' in text


def test_sensors_stand_in_the_head_and_not_in_the_scene(found: Identification) -> None:
    offset = Estimate('sensor.drive_force.offset', 'N', 3.25, 0.0, -10.0, 10.0, False, 0.1, (3.05, 3.45), None, 'found',
                      'fit')
    correlation = np.eye(len(found.estimates) + 1)
    changed = replace(found, estimates=(*found.estimates, offset), correlation=correlation)
    text = identified_text(changed, 'measured', 'start.yaml')
    assert '# Of a sensor, and not of the scene: sensor.drive_force.offset 3.25 N (3.05 N to 3.45 N)\n' in text
    assert 'sensor' not in ''.join(distributions(posterior_text(changed, 'measured')))


@pytest.mark.parametrize(('kind', 'words'), [
    (AT_BOUND, 'at the end of its range .*, or at a fixed number'),
    (NOT_IDENTIFIABLE, 'not identifiable from this run')])
def test_a_number_that_was_not_found_says_why(kind: str, words: str, found: Identification) -> None:
    text = identified_text(with_estimate(found, STATIC, kind=kind), 'measured', 'start.yaml')
    assert re.search(rf'initial: \S+ +# {words}', text)


def test_what_is_left_open_is_a_study_with_the_correlations_of_the_fit(found: Identification) -> None:
    known = uncertain_of(read_yaml(posterior_text(found, 'measured')))
    assert {one.name for one in known.distributions} == set(FREE)
    sample = Saltelli(known.distributions, 4096, known.seed, known.correlations)
    points = np.log(Study(found.scene.values, sample, 1.0).points(0, sample.count))
    drawn = [next(one for one in found.estimates if one.name == name) for name in
             (distribution.name for distribution in known.distributions)]
    assert points.mean(axis=0) == pytest.approx([math.log(one.value) for one in drawn], abs=1e-3)
    assert points.std(axis=0) == pytest.approx([one.standard_deviation for one in drawn], rel=0.03)
    order = [found.estimates.index(one) for one in drawn]
    assert np.corrcoef(points.T) == pytest.approx(found.correlation[np.ix_(order, order)], abs=0.03)


def test_numbers_that_were_not_found_are_uniform_or_fall_from_their_end(found: Identification) -> None:
    unknown = with_estimate(found, STATIC, kind=NOT_IDENTIFIABLE, standard_deviation=math.inf)
    text = posterior_text(unknown, 'measured')
    assert distributions(text)[STATIC] == {'distribution': 'uniform', 'low': 0.15, 'high': 0.3}
    assert STATIC not in text.partition('correlations:')[2]
    at_end = with_estimate(found, STATIC, kind=AT_BOUND, value=0.15, standard_deviation=0.01)
    entry = distributions(posterior_text(at_end, 'measured'))[STATIC]
    assert entry == {'distribution': 'triangular', 'low': 0.15, 'mode': 0.15, 'high': pytest.approx(
        0.15 * math.exp(0.02))}
    far = with_estimate(found, STATIC, kind=AT_BOUND, value=0.15, standard_deviation=1e3)   # beyond what exp() does
    assert distributions(posterior_text(far, 'measured'))[STATIC]['high'] == 0.3
    for each in (unknown, at_end, far):
        uncertain_of(read_yaml(posterior_text(each, 'measured')))


def test_numbers_that_are_known_together_stay_together(tmp_path: Path) -> None:
    """From the position alone only ratios of mass, stiffness, damping and normal force are known: of 2 for each."""
    measured = readings()
    alone = measured._replace(columns={'position': measured.columns['position']}).as_run(tmp_path / 'alone')
    free = {name: (0.5 * value, 2.0 * value) for name, value in START.items()
            if name in ('axis.mass', 'axis.drive_stiffness', 'axis.drive_damping', 'axis.normal_force')
            and isinstance(value, float)}
    found = identify(alone, start_scene(), free_file(tmp_path / 'free.yaml', free))
    assert {one.kind for one in found.estimates} == {NOT_IDENTIFIABLE}
    known = uncertain_of(read_yaml(posterior_text(found, 'measured')))
    sample = Saltelli(known.distributions, 64, 0, known.correlations)
    study = Study(parse_scene(identified_text(found, 'measured', 'start.yaml')).values, sample, 4.0)
    drawn = study.points(0, study.count)
    assert np.log(drawn).std(axis=0).min() > 0.1
    assert np.log(drawn / drawn[:, :1]).std(axis=0).max() < 1e-3
    period = uncertainty_of(sample, {name: getattr(figures, name) for figures in [study.figures(0, study.count)]
                                     for name in FIGURES}).percentiles['period']
    assert period is not None
    assert period[-1] / period[0] < 1.003


def test_tails_end_where_a_corner_would_be_no_scene(found: Identification) -> None:
    """0.2 - 4 x 0.01 x 0.2 is below the kinetic coefficient at rest, 0.19."""
    values = {**found.scene.values, 'friction.kinetic.coefficients': (0.19, 0.08)}
    scene = parse_scene(load_scene('paper_fig7', {name: list(value) if isinstance(value, tuple) else value
                                                 for name, value in values.items() if value is not None}).text)
    wide = with_estimate(replace(found, scene=scene), STATIC, value=0.2, standard_deviation=0.014)
    wide = replace(wide, estimates=tuple(one for one in wide.estimates if one.name == STATIC), correlation=np.eye(1))
    entry = distributions(posterior_text(wide, 'measured'))[STATIC]
    assert entry['between'] == pytest.approx([0.2 * math.exp(-0.042), 0.2 * math.exp(0.042)])


def test_a_correlation_of_one_is_a_matrix_all_the_same(found: Identification) -> None:
    perfect = replace(found, correlation=np.ones((3, 3)))
    known = uncertain_of(read_yaml(posterior_text(perfect, 'measured')))
    assert known.correlations is not None
    assert min(map(min, known.correlations)) > 0.999


def test_the_phase_goes_from_break_away_to_break_away(found: Identification) -> None:
    begins = [slip.time for slip in found.slips]
    times = np.array([begins[0] - 1e-3, begins[0], 0.25 * begins[1] + 0.75 * begins[2], begins[-1]])
    assert phases(found, times) == pytest.approx([np.nan, 0.0, 0.75, np.nan], nan_ok=True)
    assert 0.05 < slip_share(found) < 0.6
    begin, end = usual_cycles(found)
    assert sum(begin < time < end for time in begins) == 3
    alone = replace(found, slips=())
    assert np.isnan(phases(alone, times)).all()
    assert slip_share(alone) == 0.0
    assert usual_cycles(alone) == pytest.approx((3.6, 4.0))


def test_all_times_are_those_of_the_measurement(slip_by_slip: tuple[MeasuredRun, Identification]) -> None:
    _, late = slip_by_slip
    assert late.shift == 100.0
    assert 100.0 < late.slips[0].time < late.slips[0].fitted_time + 1.0 < 104.0
    assert {100.0 <= one.from_time < one.to_time <= 103.0 for one in late.misfits} == {True}
    assert np.isfinite(phases(late, late.channels[0].times)).any()


def test_friction_straight_from_the_measurement_is_that_of_the_axis(run: MeasuredRun, found: Identification) -> None:
    """From the noisy force and a position of 1 µm, to some percent: N (mu_k(0) + slope speed)."""
    bins = binned(friction_points(run, found))
    truth = 0.12 - 0.04 * np.minimum(bins.speeds / 0.02, 1.0)
    inside = (bins.speeds > 2e-3) & (bins.speeds < 0.018)
    assert inside.sum() > 5
    assert bins.medians[inside] == pytest.approx(truth[inside], abs=0.006)


@pytest.mark.parametrize('changes', [
    {'axis.damper': 'slideway'},
    {'normal_load.course': 'steps', 'normal_load.times': (0.0, 2.0), 'normal_load.forces': (0.0, 400.0)}])
def test_a_damper_on_the_slideway_and_a_load_are_no_friction(changes: dict[str, object], found: Identification,
                                                             tmp_path: Path) -> None:
    values = {**TRUTH, **changes}
    other = replace(found, scene=scene_from_values(values))
    points = friction_points(readings(values).as_run(tmp_path / 'other'), other)
    inside = (points.speeds > 5e-3) & (points.speeds < 0.018)
    assert inside.sum() > 20
    left = points.coefficients[inside] - (0.12 - 2.0 * points.speeds[inside])
    assert np.median(left) == pytest.approx(0.0, abs=0.002)
    assert np.percentile(np.abs(left), 80) < 0.012


def test_without_a_force_no_friction_is_measured(found: Identification, tmp_path: Path) -> None:
    measured = readings()
    alone = measured._replace(columns={'position': measured.columns['position']}).as_run(tmp_path / 'alone')
    assert len(friction_points(alone, found).speeds) == 0
    assert len(binned(friction_points(alone, found)).speeds) == 0


def test_the_band_is_the_error_that_numbers_leave_in_a_curve(found: Identification) -> None:
    """At rest mu_k is a number of its own, and mu_s everywhere; beyond the last breakpoint nothing was found."""
    of = {one.name: one for one in found.estimates}
    kinetic = half_width(found, kinetic_of(np.array([0.0, 0.01, 0.02])))
    at_rest = 1.96 * of['friction.kinetic.coefficients[0]'].standard_deviation * 0.12
    assert kinetic == pytest.approx([at_rest, 0.5 * at_rest, 0.0], rel=0.05, abs=1e-9)
    static = half_width(found, static_of(np.array([0.0, 1.0])))
    assert static == pytest.approx([1.96 * of[STATIC].standard_deviation * of[STATIC].value] * 2, rel=1e-3)


def test_the_folder_has_four_files_that_say_the_same(run: MeasuredRun, found: Identification, tmp_path: Path) -> None:
    write_results(run, found, 'start.yaml', tmp_path)
    assert {path.name for path in tmp_path.iterdir()} == {IDENTIFIED_SCENE, POSTERIOR, IDENTIFIED_PAGE,
                                                          IDENTIFIED_VALUES}
    values = json.loads((tmp_path / IDENTIFIED_VALUES).read_text())
    page = (tmp_path / IDENTIFIED_PAGE).read_text()
    assert values['fits'] is found.fits is True
    assert [one['name'] for one in values['estimates']] == list(FREE)
    assert len(values['friction']['kinetic']['speed']) == len(values['friction']['kinetic']['half_width'])
    assert page.count('data:image/svg+xml;base64,') == 4
    assert 'src="http' not in page
    for words in ('The model fits', 'axis.drive_stiffness', '160 kN/m', 'Residuals of each channel',
                  'Slips, measured and fitted', 'From position and drive force of measured'):
        assert words in page, words


def test_a_report_shows_what_does_not_fit_and_what_is_not_known(run: MeasuredRun, found: Identification,
                                                                tmp_path: Path) -> None:
    changed = replace(
        found, misfits=(Misfit('position', 'mean square', 9.0, 1.2, 1.0, 2.0, 'position is off by 3 <σ>'),),
        combinations=(Combination(('axis.mass', STATIC), (1.0, -1.0), math.inf, 'one factor on all of them'),),
        starts=(StartEnd((1e5, 0.2, 0.1), (2e5, 0.2, 0.12), 1.0, True),
                StartEnd((4e5, 0.2, 0.1), (3e5, 0.25, 0.12), 7.0, False)),
        laws=(LawFit('constant', 'table', 100.0, 3, 90.0, True), LawFit('kato', 'stribeck', 120.0, 7, 85.0, False)),
        correlation=np.array([[1.0, np.nan, 0.5], [np.nan] * 3, [0.5, np.nan, 1.0]]), notes=('a <note>',))
    write_results(run, changed, 'start.yaml', tmp_path)
    page = (tmp_path / IDENTIFIED_PAGE).read_text()
    for words in ('does not fit', 'position is off by 3 &lt;σ&gt;', 'one factor on all of them', 'a &lt;note&gt;',
                  'Where the search from each start ended', 'kato, stribeck', 'constant, table (taken)'):
        assert words in page, words
    values = json.loads((tmp_path / IDENTIFIED_VALUES).read_text())
    assert values['correlation'][1] == [None] * 3
    assert values['combinations'][0]['spread'] == 'inf'
    assert values['misfits'][0]['from_time'] == 1.0


@pytest.mark.usefixtures('blank_pictures')
def test_of_many_misfits_three_are_listed_and_all_are_in_the_fold(run: MeasuredRun, found: Identification,
                                                                 tmp_path: Path) -> None:
    """The first of each channel, of all of the run, and then the one that is farthest off."""
    misfits = tuple(Misfit(channel, 'mean square', statistic, 1.0, 0.0, 1.0, f'{channel} off by {statistic:g}')
                    for channel in ('position', 'drive_force') for statistic in (5.0, 3.0, *range(10, 45)))
    write_results(run, replace(found, misfits=misfits), 'start.yaml', tmp_path)
    page = (tmp_path / IDENTIFIED_PAGE).read_text()
    above, _, fold = page.partition('<details>')
    assert re.findall(r'<li>(.*?)</li>', above) == ['position off by 5', 'drive_force off by 5', 'position off by 44']
    assert fold.partition('</details>')[0].count('<tr>') == 1 + len(misfits)
    assert page.count('drive_force off by 31') == 1
    assert '@media print' in page


@pytest.mark.usefixtures('blank_pictures')
def test_where_single_slips_are_fitted_the_restarts_and_the_free_run_are_shown(
        slip_by_slip: tuple[MeasuredRun, Identification], tmp_path: Path) -> None:
    other, fitted = slip_by_slip
    assert fitted.restarts
    free = fitted.channels[0].free
    assert free is not None
    assert np.abs(free - fitted.channels[0].measured).max() > 2.0 * np.abs(fitted.channels[0].residuals).max()
    plot_fit(fitted_channels(fitted), usual_cycles(fitted), fitted.restarts, tmp_path / 'fit.svg')
    words = (tmp_path / 'fit.svg').read_text()
    for label in ('free run from the start', 'restart at a measured arrest', 'fitted slip by slip'):
        assert f'<!-- {label} -->' in words
    write_results(other, fitted, 'start.yaml', tmp_path)
    assert json.loads((tmp_path / IDENTIFIED_VALUES).read_text())['restarts'] == list(fitted.restarts)


def test_a_fit_of_the_whole_run_has_no_restart(found: Identification, tmp_path: Path) -> None:
    assert (found.restarts, found.channels[0].free) == ((), None)
    plot_fit(fitted_channels(found), usual_cycles(found), found.restarts, tmp_path / 'fit.svg')
    words = (tmp_path / 'fit.svg').read_text()
    assert '<!-- fitted -->' in words
    assert 'restart' not in words


def test_friction_of_each_direction_is_shown_in_its_own(found: Identification, tmp_path: Path) -> None:
    """The points of a direction lie on the curve of that direction."""
    backward = {'friction.static.backward.initial': 0.26, 'friction.kinetic.backward.velocities': (0.0, 0.02),
                'friction.kinetic.backward.coefficients': (0.16, 0.10)}
    values = {**TRUTH, **backward, 'drive.course': 'steps', 'drive.times': (0.0, 2.0), 'drive.velocities': (0.002,
                                                                                                          -0.002)}
    del values['drive.velocity']
    both = readings(values, duration=5.0).as_run(tmp_path / 'both')
    directed = known_friction(both, replace(found, scene=scene_from_values(values), slips=()))
    assert list(directed) == ['forward', 'backward']
    for name, (rest, slope) in {'forward': (0.12, -2.0), 'backward': (0.16, -3.0)}.items():
        assert directed[name].kinetic.values[0] == rest
        bins = directed[name].bins
        falling = bins.places < 0.02
        np.testing.assert_allclose(bins.middles[falling], rest + slope * bins.places[falling], atol=0.006)
    plot_known_friction(directed, tmp_path / 'friction.svg')
    words = (tmp_path / 'friction.svg').read_text()
    assert '<!-- forward -->' in words
    assert '<!-- backward -->' in words
    assert list(known_friction(both, replace(found, slips=()))) == ['']


def test_an_end_beyond_all_numbers_is_that_of_the_range() -> None:
    """The interval of a number that nothing determines reaches further than exp() does."""
    one = FreeParameter('axis.mass', 'kg', 100.0, 50.0, 200.0)
    assert (one.outer(-1e4), one.outer(1e4)) == pytest.approx((50.0, 200.0))
    offset = FreeParameter('sensor.position.offset', 'm', 0.0, -1.0, 3.0)
    assert (offset.outer(-1e4), offset.outer(0.25), offset.outer(1e4)) == (-1.0, 1.0, 3.0)
