# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Run the demonstration of `make run`: drive the installed node from another process, and show the recording."""

import argparse
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import rclpy
from numpy.typing import NDArray
from rclpy.node import Node
from rclpy.signals import SignalHandlerOptions

from stickslip_msgs.msg import DriveVelocity, ExternalForce, SliderState

from ..bags import topics
from ..check.observed_run import Timing, timing_of
from ..core.errors import RecordingError, StickslipError
from ..core.types import Mode
from ..figures.catalogue import label_of, read_in, unit_of
from ..figures.cycles import Summary
from ..recording import read_run
from ..recording.recordings import stamped_folder
from .node.endpoints import publisher, subscription

# What the demonstration prints about its recorded run: read back from the bag, with nothing else to go by.

_PICTURE = 'run.png'
_FIGURES = ('period', 'stick_time', 'slip_time', 'jump', 'peak_speed', 'break_away_force')


def report(folder: Path) -> list[str]:
    """Draw the picture of a run into its folder; return the lines to print about it."""
    run = read_run(folder)
    run.plot(folder / _PICTURE)
    return [f'bag      {folder} ({sum(run.bag.counts.values())} messages)', f'picture  {folder / _PICTURE}',
            *cycle_lines(run.summary), *timing_lines(run.bag.columns('/timing')),
            *(real_time_lines(timing) if (timing := timing_of(run)) and run.is_complete else [])]


def real_time_lines(timing: Timing) -> list[str]:
    """Return whether the run kept real time, and what that means where it did not."""
    late = ['the motion is right, the timing was late, as the machine had other work; where that matters,',
            'lock-step is the way (-p time.mode:=lockstep, docs/hil.md): time waits for steps and controller']
    return [f'verdict  {timing.verdict}', *(f'         {line}' for line in late if timing.valid is False)]


def cycle_lines(figures: Summary) -> list[str]:
    """Return the cycle figures."""
    if figures.last is None:
        return [f'cycles   none: {figures.motion}']
    lines = [f'cycles   {figures.cycles}; of the last one:']
    for name in _FIGURES:
        unit, scale = read_in(unit_of(name))
        lines.append(f'         {label_of(name):17} {getattr(figures.last, name) * scale:9.4g} {unit}')
    return lines


def timing_lines(windows: dict[str, NDArray[Any]]) -> list[str]:
    """Return how the steps kept their time, from the seconds recorded."""
    if not len(windows['steps']):
        return ['timing   no second was completed']
    micro = 1e6
    return [
        f'timing   {windows["steps"].sum()} steps of {windows["period"][0] * 1e3:g} ms; lateness'
        f' p50 {np.nanmedian(windows["lateness_p50"]) * micro:.0f} µs,'
        f' p99 {np.nanmedian(windows["lateness_p99"]) * micro:.0f} µs (median of the seconds),'
        f' max {np.nanmax(windows["lateness_max"]) * micro:.0f} µs',
        f'         cost p50 {np.nanmedian(windows["cost_p50"]) * micro:.0f} µs,'
        f' p99 {np.nanmedian(windows["cost_p99"]) * micro:.0f} µs;'
        f' {windows["total_overruns"][-1]} overruns, {windows["total_caught_up"][-1]} steps caught up',
    ]


DEMO_SCENE = 'paper_fig8'
_PATIENCE = 30.0    # s for the node to appear, and to end


class Order(NamedTuple):
    """A command and when it is sent, as a share of the duration."""

    share: float
    message: DriveVelocity | ExternalForce


_COMMANDS = (
    Order(0.30, DriveVelocity(velocity=0.005)),
    Order(0.45, DriveVelocity(velocity=-0.003)),
    Order(0.60, DriveVelocity(velocity=0.002)),
    Order(0.72, ExternalForce(force=400.0)),
    Order(0.74, ExternalForce(force=0.0)),
)


class Driver(Node):  # type: ignore[misc]
    """Sends the commands when simulation time has come for it, and prints the state once a second."""

    def __init__(self, duration: float) -> None:
        super().__init__('demo')
        self.time = -1.0
        self._duration = duration
        self._orders = list(_COMMANDS)
        self._printed = -1
        self._out = {DriveVelocity: publisher(self, topics.DRIVE_VELOCITY),
                     ExternalForce: publisher(self, topics.EXTERNAL_FORCE)}
        subscription(self, topics.SLIDER_STATE, self._take)

    @property
    def is_connected(self) -> bool:
        """Whether the node hears the commands and is heard."""
        return self.time >= 0.0 and all(out.get_subscription_count() for out in self._out.values())

    def _take(self, state: SliderState) -> None:
        self.time = state.time
        while self._orders and self.is_connected and self.time >= self._orders[0].share * self._duration:
            self._send(self._orders.pop(0).message)
        if int(self.time) > self._printed:
            self._printed = int(self.time)
            print(f'  t {state.time:5.1f} s   drive {state.drive_velocity * 1e3:5.1f} mm/s   slider '
                  f'{state.velocity * 1e3:6.2f} mm/s at {state.position * 1e3:6.2f} mm   '
                  f'{Mode(state.mode).name.lower()}',
                  flush=True)

    def _send(self, message: DriveVelocity | ExternalForce) -> None:
        message.header.stamp = self.get_clock().now().to_msg()
        self._out[type(message)].publish(message)
        is_force = isinstance(message, ExternalForce)
        command = f'force {message.force:g} N' if is_force else f'drive velocity {message.velocity * 1e3:g} mm/s'
        print(f'  t {self.time:5.1f} s   sent: {command}', flush=True)


def main() -> int:
    """Run the demonstration; return the exit code."""
    options = _options()
    folder = stamped_folder(options.out, DEMO_SCENE)
    try:
        print(f'starting sim_node on {DEMO_SCENE} for {options.duration:g} s of real time')
        with _driver(options.duration) as driver, _node_process(folder) as process:
            _drive(driver, process, options.duration)
        print('\n'.join(report(folder)))
    except (StickslipError, OSError) as error:
        sys.stderr.write(f'demo: {error}\n')
        return 1
    return 0


def _options() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog='python3 -m stickslip_sim.ros.demo', description=__doc__)
    parser.add_argument('--duration', type=float, default=10.0, metavar='SECONDS',
                        help='simulated and real time in s [default: %(default)s]')
    parser.add_argument('--out', type=Path, default=Path('runs'), metavar='FOLDER',
                        help='folder of the runs [default: %(default)s]')
    options = parser.parse_args()
    if not 1.0 <= options.duration <= 1e6:
        parser.error(f'argument --duration: {options.duration:g} s; give 1 to 1e6 s')
    return options


@contextmanager
def _node_process(folder: Path) -> Iterator[subprocess.Popen[bytes]]:
    """Run the node, recording into a folder, and end it as Ctrl-C does; raises RecordingError unless it ends well."""
    process = subprocess.Popen(
        [_executable('sim_node'), '--ros-args', '--log-level', 'warn', '-p', f'scene:={DEMO_SCENE}',
         '-p', 'record.enabled:=true', '-p', f'record.folder:={folder.absolute()}'],
        start_new_session=True)    # so that Ctrl-C reaches it through here only
    try:
        yield process
        if process.poll() is None:
            process.send_signal(signal.SIGINT)
        if process.wait(_PATIENCE) != 0:
            raise RecordingError(f'sim_node ended with exit code {process.returncode}')
    finally:
        if process.poll() is None:
            process.kill()
            process.wait()


def _executable(name: str) -> str:
    """Return an installed program of the package, found as `ros2 run` finds it."""
    for prefix in os.environ.get('AMENT_PREFIX_PATH', '').split(os.pathsep):
        path = Path(prefix, 'lib', 'stickslip_sim', name)
        if path.is_file():
            return str(path)
    raise RecordingError(f'{name} is not installed; run `make build` and source ros2_ws/install/setup.bash')


@contextmanager
def _driver(duration: float) -> Iterator[Driver]:
    """Keep the driver until the node has ended, which would warn that its controller is gone."""
    rclpy.init(args=[], signal_handler_options=SignalHandlerOptions.NO)
    driver = Driver(duration)
    try:
        yield driver
    finally:
        driver.destroy_node()
        rclpy.try_shutdown()


def _drive(driver: Driver, process: subprocess.Popen[bytes], duration: float) -> None:
    """Send the commands; Ctrl-C ends it early and well."""
    begin = time.monotonic()
    try:
        while driver.time < duration and process.poll() is None:
            rclpy.spin_once(driver, timeout_sec=0.5)
            if not driver.is_connected and time.monotonic() - begin > _PATIENCE:
                raise RecordingError(f'no sign of sim_node within {_PATIENCE:g} s; check ROS_DOMAIN_ID')
    except KeyboardInterrupt:
        print('  interrupted; the run ends here')


if __name__ == '__main__':
    sys.exit(main())
