#!/usr/bin/python3
# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A display of LinuxCNC without a screen: run [DISPLAY]PROGRAM, and write what is sampled to [DISPLAY]RECORD."""

import sys
import time
from collections.abc import Callable
from typing import TextIO

import hal
import linuxcnc

COLUMNS = 'command [mm]', 'drive velocity [mm/s]', 'position [mm]', 'drive [mm]', 'drive force [N]', 'mode'
PATIENCE = 300.0   # s

ini = linuxcnc.ini(sys.argv[sys.argv.index('-ini') + 1])
command, status, errors = linuxcnc.command(), linuxcnc.stat(), linuxcnc.error_channel()
period = int(ini.find('EMCMOT', 'SERVO_PERIOD'))
component = hal.component('record')
stream = hal.stream(component, hal.sampler_base, 'fffffsfffffs')
component.ready()


def said() -> bool:
    """Print what LinuxCNC has to say; return whether it is an error."""
    message = errors.poll()
    if message:
        print(f'LinuxCNC: {message[1]}')
    return bool(message) and message[0] in (linuxcnc.NML_ERROR, linuxcnc.OPERATOR_ERROR)


def wait(is_done: Callable[[], bool], what: str) -> None:
    """Wait until something is so; exit with 1 on an error, and when it takes too long."""
    end = time.monotonic() + PATIENCE
    done = False
    while not done:
        status.poll()
        done = is_done()
        if said() or time.monotonic() > end:
            sys.exit(f'failed: {what}')
        time.sleep(0.0 if done else 0.01)


def record(file: TextIO) -> bool:
    """Write the samples that have come; return whether the program has recorded and ended."""
    while stream.readable:
        row = stream.read()
        file.write(','.join(map(repr, (stream.sampleno * period / 1e9, *row))) + '\n')
    return bool(stream.sampleno and status.interp_state == linuxcnc.INTERP_IDLE and status.inpos)


command.state(linuxcnc.STATE_ESTOP_RESET)
command.wait_complete()
command.state(linuxcnc.STATE_ON)
wait(lambda: status.task_state == linuxcnc.STATE_ON, 'switch on')
command.mode(linuxcnc.MODE_MANUAL)
command.wait_complete()
command.home(-1)
wait(lambda: all(status.homed[:status.joints]), 'home')
command.mode(linuxcnc.MODE_AUTO)
command.wait_complete()
command.program_open(ini.find('DISPLAY', 'PROGRAM'))
command.auto(linuxcnc.AUTO_RUN, 0)
command.wait_complete()
with open(ini.find('DISPLAY', 'RECORD'), 'w') as file:
    file.write(','.join(('time [s]', *(f'{axis} {name}' for axis in 'xy' for name in COLUMNS))) + '\n')
    wait(lambda: record(file), 'run the program')
    record(file)
if status.task_state != linuxcnc.STATE_ON or stream.num_overruns:
    sys.exit('failed: the machine is off, or samples were lost')
print(f'written: {ini.find("DISPLAY", "RECORD")}, {stream.sampleno} samples')
