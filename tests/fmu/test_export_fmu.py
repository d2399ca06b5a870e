# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip export-fmu`: valid to other tools, the bits of the engine, and nothing changed by a refusal."""

import logging
import math
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any, NamedTuple

import fmpy
import fmpy.fmi3
import pytest
from fmpy.validation import validate_fmu
from fmu_manipulation_toolbox.checker import get_checkers
from fmu_manipulation_toolbox.operations import FMU

from stickslip_sim import load_scene
from stickslip_sim.cli.main import run
from stickslip_sim.core import hot_path
from stickslip_sim.core.types import Event, Instant, Sample
from stickslip_sim.proof.axes import instant
from stickslip_sim.scene import scene_names
from stickslip_sim.simulation.plant import with_friction_scaled
from stickslip_sim.simulation.simulator import Simulator

pytestmark = [pytest.mark.slow, pytest.mark.skipif(hot_path.UNIT is None, reason='no compiled code'),
              pytest.mark.filterwarnings('ignore::DeprecationWarning:lark')]
LOAD = {'normal_load.course': 'sine', 'normal_load.constant': 500.0, 'normal_load.amplitude': 400.0,
        'normal_load.frequency': 7.0, 'drive.amplitudes': [5.0e-3, 2.0e-3], 'drive.frequencies': [3.0, 17.0]}
SCATTER = {'friction.static.scatter': 0.1, 'seed': 7}
SCENES = [*((name, {}, 3) for name in scene_names()),   # what a scene has does not depend on the version
          *((scene, changes, version) for version in (2, 3) for scene, changes in (
              ('paper_fig8', LOAD), ('paper_fig7', SCATTER)))]
FIRST_OUTPUT, EVENT_COUNT = 10, 30
SAMPLE = range(FIRST_OUTPUT, FIRST_OUTPUT + len(Sample._fields) - 2)
DRIVE, FORCE, NORMAL, MASS = 1, 2, 3, 40


class Described(NamedTuple):
    """An FMU, unpacked, and how FMPy reads it."""

    path: Path
    folder: str
    description: Any

    def reference(self, name: str) -> int:
        """Return the value reference of a variable."""
        return int(next(one.valueReference for one in self.description.modelVariables if one.name == name))


def exported(folder: Path, scene: str, changes: dict[str, Any], version: int = 3) -> Described:
    """Return the FMU of a scene."""
    path = folder / f'{scene}{version}.fmu'
    given = [word for name, value in changes.items() for word in ('--set', f'{name}={value}')]
    assert run(['export-fmu', scene, '--fmi', str(version), '--out', str(path), *given]) == 0
    return Described(path, str(fmpy.extract(str(path), str(folder / f'{scene}{version}'))),
                     fmpy.read_model_description(str(path)))


class Instance3(fmpy.fmi3.FMU3Slave):    # type: ignore[misc]
    """An instance of FMI 3.0 that keeps what its logger says; used as a context it ends."""

    def __init__(self, fmu: Described, *, begun: bool = True, event_mode: bool = True, early: bool = True) -> None:
        super().__init__(guid=fmu.description.guid, unzipDirectory=fmu.folder, modelIdentifier='stickslip_axis',
                         instanceName='axis')
        self.said: list[str] = []
        self.instantiate(eventModeUsed=event_mode, earlyReturnAllowed=early,
                         logMessage=lambda *message: self.said.append(message[-1].decode()))
        if begun:
            self.enterInitializationMode()
            self.exitInitializationMode()
            if event_mode:
                self.enterStepMode()

    def __enter__(self) -> 'Instance3':
        return self

    def __exit__(self, *_: object) -> None:
        self.freeInstance()

    def sample(self) -> tuple[float, ...]:
        """Return the outputs of a sample."""
        mode, direction = self.getInt64(SAMPLE[:2])
        return (mode, direction, *self.getFloat64(SAMPLE[2:]))

    def last_event(self) -> tuple[int, float, int]:
        """Return the count of events, and time and kind of the last."""
        count, kind = self.getInt64([EVENT_COUNT, EVENT_COUNT + 2])
        return count, *self.getFloat64([EVENT_COUNT + 1]), kind

    def run_to(self, begin: float, end: float) -> list[tuple[int, float, int]]:
        """Bring it from a time to another in event mode; return its events."""
        events, time = list[tuple[int, float, int]](), begin
        while time < end:
            found, _, early, time = self.doStep(time, end - time)
            time = time if early else end
            if found:
                events.append(self.last_event())
                self.enterEventMode()
                while self.updateDiscreteStates()[0]:
                    events.append(self.last_event())
                self.enterStepMode()
        return events


def refusal(of: Instance3, call: Any, *given: Any) -> str:
    """Return the one sentence that a call is refused with."""
    of.said.clear()
    with pytest.raises(Exception, match=r'(?i)error|failed'):
        call(*given)
    assert len(of.said) == 1
    return of.said[0]


def events_of(engine: Simulator, to: float) -> list[Event]:
    """Return the events up to a time."""
    return engine.advance(instant(to))


def engine_of(scene: str, changes: dict[str, Any] | None = None) -> Simulator:
    """Return the simulator of a scene, which is the FMU's judge."""
    return load_scene(scene, changes or {}).make_simulator()


@pytest.fixture(scope='module')
def fig8(tmp_path_factory: pytest.TempPathFactory) -> Described:
    """Return the FMU of a scene that most tests use."""
    return exported(tmp_path_factory.mktemp('fig8'), 'paper_fig8', {})


@pytest.mark.parametrize(('scene', 'changes', 'version'), SCENES)
def test_each_scene_is_valid_and_has_the_events_and_samples_of_the_engine(
        scene: str, changes: dict[str, Any], version: int, tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    fmu = exported(tmp_path, scene, changes, version)
    assert validate_fmu(str(fmu.path)) == []
    with caplog.at_level(logging.INFO, 'fmu_manipulation_toolbox'):
        for checker in get_checkers():
            FMU(str(fmu.path)).apply_operation(checker())
    assert f'compliant with FMI-{version}.0' in caplog.text
    assert 'No semantic error' in caplog.text
    assert [record for record in caplog.records if record.levelno >= logging.ERROR] == []
    engine = engine_of(scene, changes)
    if version == 2:
        result = fmpy.simulate_fmu(str(fmu.path), stop_time=3.0, output_interval=0.25, output=Sample._fields[2:])
        for row in result:
            engine.advance(instant(float(row['time'])))
            assert [row[name] for name in Sample._fields[2:]] == [*engine.sample()[2:]]
        return
    with Instance3(fmu) as instance:
        time, events = 0.0, list[tuple[int, float, int]]()
        for end in (0.3, 1.0, 1.0625, 6.0):
            expected = events_of(engine, end)
            found = instance.run_to(time, end)
            assert [one[1:] for one in found] == [(event.time, int(event.kind)) for event in expected]
            assert instance.sample() == tuple(map(float, engine.sample()[2:]))
            events, time = events + found, end
        assert [count for count, _, _ in events] == list(range(1, len(events) + 1))
        assert len(events) > 3 or scene in ('fast_feed', 'micro_feed')


def test_at_each_event_the_outputs_are_those_of_the_event(fig8: Described) -> None:
    engine = engine_of('paper_fig8')
    with Instance3(fig8) as instance:
        time = 0.0
        for event in events_of(engine, 3.0):
            found, _, early, time = instance.doStep(time, 3.0 - time)
            assert (found, early, time) == (True, True, event.time)
            row = instance.getFloat64(range(12, 14))
            assert row == [event.position, event.velocity]
            assert instance.getInt64([10]) == [int(event.mode)]
            instance.enterEventMode()
            instance.updateDiscreteStates()
            instance.enterStepMode()


@pytest.mark.parametrize(('event_mode', 'early'), [(False, False), (True, False)])
def test_a_declined_early_return_steps_over_all_events(event_mode: bool, early: bool, fig8: Described) -> None:
    engine = engine_of('paper_fig8')
    expected = events_of(engine, 2000.0)
    assert len(expected) > 10_000
    with Instance3(fig8, event_mode=event_mode, early=early) as instance:
        assert instance.doStep(0.0, 2000.0) == (event_mode, False, False, 2000.0)
        assert instance.last_event() == (len(expected), expected[-1].time, int(expected[-1].kind))
        assert instance.sample() == tuple(map(float, engine.sample()[2:]))


def test_what_is_set_acts_and_parameters_are_tuned(tmp_path: Path) -> None:
    fmu = exported(tmp_path, 'paper_fig8', LOAD)
    engine = engine_of('paper_fig8', LOAD)
    axis = load_scene('paper_fig8', LOAD).axis
    assert fmu.reference('axis.mass') == MASS
    with Instance3(fmu, event_mode=False, early=False) as instance:
        for k in range(400):
            time = 0.01 * k
            if k % 40 == 10:
                velocity = 1e-3 * (k % 7)
                instance.setFloat64([DRIVE], [velocity])
                engine.command_drive(velocity)
            if k == 60:
                instance.setFloat64([FORCE], [-120.0])
                engine.command_force(-120.0)
            instance.doStep(time, 0.01 * (k + 1) - time)
            engine.advance(instant(time + (0.01 * (k + 1) - time)))
            assert instance.sample() == tuple(map(float, engine.sample()[2:]))
        instance.setFloat64([MASS, MASS + 1], [400.0, 5e5])
        engine.change_axis(type(axis)(**{**{name: getattr(axis, name) for name in axis.__slots__}, 'mass': 400.0,
                                         'drive_stiffness': 5e5}))
        assert instance.sample() == tuple(map(float, engine.sample()[2:]))
        instance.setFloat64([NORMAL], [100.0])
        instance.doStep(4.0, 1.0)
        assert instance.getFloat64([NORMAL]) == [100.0]


def test_friction_is_scaled_as_by_a_fault(fig8: Described) -> None:
    engine, axis = engine_of('paper_fig8'), load_scene('paper_fig8').axis
    with Instance3(fig8, event_mode=False, early=False) as instance:
        instance.setFloat64([fig8.reference('friction.scale')], [0.5])
        engine.change_axis(with_friction_scaled(axis, 0.5))
        instance.doStep(0.0, 2.0)
        engine.advance(Instant(2.0, 0.0))
        assert instance.sample() == tuple(map(float, engine.sample()[2:]))


def test_a_state_goes_on_to_the_bit_here_and_in_another_process(fig8: Described, tmp_path: Path) -> None:
    def thousand(instance: Instance3) -> list[Any]:
        return [(instance.doStep(1.0 + k / 256, 1 / 256), instance.sample(), instance.last_event())
                for k in range(1000)]

    with Instance3(fig8, event_mode=False, early=False) as instance, Instance3(fig8, event_mode=False) as other:
        instance.setFloat64([MASS, FORCE], [300.0, 5.0])
        instance.doStep(0.0, 1.0)
        state = instance.getFMUState()
        saved = instance.serializeFMUState(state)
        first = thousand(instance)
        instance.setFloat64([DRIVE], [0.0])
        instance.setFMUState(state)
        assert thousand(instance) == first
        instance.terminate()
        instance.reset()
        assert 'not initialized' in refusal(instance, instance.doStep, 0.0, 1.0)
        instance.setFMUState(state)
        assert thousand(instance) == first
        for wrong in (saved[:-1], saved[:400] + bytes([saved[400] ^ 1]) + saved[401:]):
            assert 'no state' in refusal(other, other.deserializeFMUState, wrong)
        instance.freeFMUState(state)
    (tmp_path / 'state').write_bytes(saved)
    program = (f'import fmpy; from pathlib import Path; from {__name__} import Described, Instance3\n'
               f'path = {str(fig8.path)!r}\n'
               f'fmu = Described(Path(path), {fig8.folder!r}, fmpy.read_model_description(path))\n'
               'i = Instance3(fmu, begun=False, event_mode=False, early=False)\n'
               f'i.setFMUState(i.deserializeFMUState(Path({str(tmp_path / "state")!r}).read_bytes()))\n'
               'print([(i.doStep(1.0 + k / 256, 1 / 256), i.sample(), i.last_event()) for k in range(1000)])')
    again = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=True, timeout=120)
    assert again.stdout.strip() == repr(first)


def test_a_thousand_instances_in_a_process_are_alike(fig8: Described) -> None:
    with Instance3(fig8, begun=False, event_mode=False, early=False) as instance:
        handles = [instance.component]
        for _ in range(999):
            instance.instantiate()    # FMPy keeps the handle of the last
            handles.append(instance.component)
        found = set()
        for handle in handles:
            instance.component = handle
            instance.enterInitializationMode()
            instance.exitInitializationMode()
            instance.doStep(0.0, 1.0)
            found.add((instance.sample(), instance.last_event()))
        assert len(found) == 1
        for instance.component in handles[1:]:
            instance.fmi3FreeInstance(instance.component)
        instance.component = handles[0]


def test_what_is_wrong_is_refused_in_a_sentence_and_changes_nothing(fig8: Described, tmp_path: Path) -> None:
    scale = fig8.reference('friction.scale')
    with Instance3(fig8, event_mode=False, early=False) as instance:
        instance.doStep(0.0, 1.0)
        before = instance.sample(), instance.getFloat64([DRIVE, FORCE, MASS, scale])
        for references, values, word in (
                ([DRIVE], [math.nan], 'nan'), ([FORCE], [math.inf], 'inf'), ([FORCE, MASS], [7.0, -1.0], '-1'),
                ([scale], [101.0], '0 to 100'), ([NORMAL], [1.0], 'cannot be set'), ([12], [1.0], 'cannot be set'),
                ([fig8.reference('friction.static.initial')], [0.3], 'friction.static.limit')):
            assert word in refusal(instance, instance.setFloat64, references, values)
        for time, step, word in ((0.5, 0.1, 'is at 1 s'), (2.0, 0.1, 'is at 1 s'), (math.nan, 0.1, 'is at 1 s'),
                                 (1.0, 0.0, 'above 0'), (1.0, -1.0, 'above 0'), (1.0, math.nan, 'above 0'),
                                 (1.0, math.inf, '1e15')):
            assert word in refusal(instance, instance.doStep, time, step)
        assert 'no real number' in refusal(instance, instance.getFloat64, [10])
        assert 'no whole number' in refusal(instance, instance.getInt64, [99])
        assert 'no readable String' in refusal(instance, instance.getString, [1])
        assert 'event mode was not asked for' in refusal(instance, instance.enterEventMode)
        assert (instance.sample(), instance.getFloat64([DRIVE, FORCE, MASS, scale])) == before
        with Instance3(exported(tmp_path, 'paper_fig7', {})) as stranger:
            state = stranger.getFMUState()
            assert 'another scene' in refusal(instance, instance.setFMUState, state)
            assert 'another scene' in refusal(instance, instance.serializeFMUState, state)
            stranger.freeFMUState(state)
        instance.terminate()
        assert 'terminated' in refusal(instance, instance.doStep, 1.0, 0.1)
    broken = fig8._replace(folder=str(shutil.copytree(fig8.folder, tmp_path / 'broken')))
    text = (Path(broken.folder) / 'resources' / 'axis.txt').read_text(encoding='utf-8')
    for wrong in ('', text[:-200], text.replace(text.split()[2], 'fff0000000000000', 1), '0' + text):
        (Path(broken.folder) / 'resources' / 'axis.txt').write_text(wrong, encoding='utf-8')
        with pytest.raises(Exception, match='instantiate'):
            Instance3(broken)


def test_a_scene_that_the_engine_does_not_move_is_refused(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run(['export-fmu', 'paper_fig8', '--out', str(tmp_path / 'a.fmu'), '--set', 'solver.name=fixed_step',
                '--set', 'solver.step=1e-4']) == 2
    assert 'solver.name' in capsys.readouterr().err
    assert not (tmp_path / 'a.fmu').exists()


@pytest.mark.parametrize('version', [3, 2])
def test_the_sources_compile_against_the_official_headers_and_need_the_c_library_alone(version: int, tmp_path: Path
                                                                                      ) -> None:
    fmu = exported(tmp_path, 'paper_fig8', {}, version)
    sources = Path(fmu.folder) / 'sources'
    if shutil.which('cc') is None:
        pytest.skip('no C compiler')
    subprocess.run(['cc', '-std=c11', '-Wall', '-Wextra', '-Werror', '-fsyntax-only', '-DSTICKSLIP_FMI_HEADERS',
                    f'-I{Path(fmpy.__file__).parent / "c-code"}', 'stickslip_fmu.c'], cwd=sources, check=True)
    (library,) = Path(fmu.folder).glob('binaries/*/*.so')
    assert library.stat().st_size < 150_000
    needed = subprocess.run(['readelf', '-d', library], capture_output=True, text=True, check=True).stdout
    assert {line.split('[')[1].rstrip(']') for line in needed.splitlines() if 'NEEDED' in line} <= {
        'libm.so.6', 'libc.so.6'}
    names = subprocess.run(['nm', '-D', '--defined-only', library], capture_output=True, text=True, check=True).stdout
    assert {line.split()[-1][:4] for line in names.splitlines()} == {'fmi2', 'fmi3'}


def test_ecos_has_the_same_number(tmp_path: Path) -> None:
    fmu = exported(tmp_path, 'paper_fig8', {})
    program = ('import ctypes\n'
               f'ctypes.CDLL({sys.prefix + "/lib/libtbb.so.12"!r})\n'  # ecospy's own library does not look there
               'from ecospy import EcosSimulation, EcosSimulationStructure\n'
               'structure = EcosSimulationStructure()\n'
               f'structure.add_model("axis", {str(fmu.path)!r})\n'
               'simulation = EcosSimulation(structure=structure, step_size=0.125)\n'
               'simulation.init()\nsimulation.step(8)\n'
               'print(float.hex(simulation.get_real("axis::position")))')
    printed = subprocess.run([sys.executable, '-c', program], capture_output=True, text=True, check=True, timeout=120)
    engine = engine_of('paper_fig8')
    engine.advance(Instant(1.0, 0.0))
    assert printed.stdout.split()[-1] == float.hex(engine.sample().position)


def test_events_without_end_are_refused_rather_than_stepped_for_ever(tmp_path: Path) -> None:
    fmu = exported(tmp_path, 'paper_fig7', {})
    with Instance3(fmu, event_mode=False, early=False) as instance:
        instance.setFloat64(range(MASS, MASS + 3), [1e-6, 1e15, 0.0])    # mass, stiffness, damping
        assert 'time does not go on' in refusal(instance, instance.doStep, 0.0, 1e-4)


def test_without_friction_and_a_command_the_slider_rests_under_a_load(tmp_path: Path) -> None:
    fmu = exported(tmp_path, 'positioning', LOAD)
    with Instance3(fmu, event_mode=False, early=False) as instance:
        instance.setFloat64([DRIVE, fmu.reference('friction.scale')], [0.0, 0.0])
        instance.doStep(0.0, 1.0)
        assert instance.last_event()[0] == 0


def test_an_axis_without_friction_has_no_factor_on_it(tmp_path: Path) -> None:
    fmu = exported(tmp_path, 'paper_fig8', {'friction.scale': 0.0})
    assert {'axis.mass', 'friction.static.limit'} <= {one.name for one in fmu.description.modelVariables}
    with pytest.raises(StopIteration):
        fmu.reference('friction.scale')
