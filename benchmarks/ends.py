# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Start and end the node again and again under a flood of commands; report each end that is not clean.

    python3 -m benchmarks.ends [--count 500] [--rate 2000] [--folder runs/ends]

The signal comes at any time from when the node takes it, amid its start or its run.  A process that crashes leaves its
core dump in its folder, where the machine writes them there (core_pattern).  Exit code 1 when any end was not clean.
"""

import argparse
import random
import resource
import signal
import subprocess
import sys
import time
from collections import Counter
from pathlib import Path

from .loop import executable

PATIENCE = 60.0    # s
FLOOD = """
import sys, time, rclpy
from stickslip_msgs.msg import DriveVelocity, ExternalForce
from rclpy.qos import QoSProfile, ReliabilityPolicy
rclpy.init()
node = rclpy.create_node('flood')
quality = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)
ports = [(node.create_publisher(kind, name, quality), kind()) for kind, name in
         ((DriveVelocity, 'drive_velocity'), (ExternalForce, 'external_force'))]
while True:
    for port, message in ports:
        port.publish(message)
    time.sleep(1.0 / float(sys.argv[1]))
"""


def prepare() -> None:
    """Let the child take Ctrl-C, and dump its core."""
    signal.signal(signal.SIGINT, signal.default_int_handler)
    resource.setrlimit(resource.RLIMIT_CORE, (resource.RLIM_INFINITY, resource.RLIM_INFINITY))


def takes_signals(pid: int) -> bool:
    """Return whether a process has a handler for SIGTERM."""
    status = Path(f'/proc/{pid}/status').read_text()
    caught = next(line.split()[1] for line in status.splitlines() if line.startswith('SigCgt'))
    return bool(int(caught, 16) >> signal.SIGTERM - 1 & 1)


def one(number: int, folder: Path, random_numbers: random.Random) -> str:
    """Start a node and end it after a while; return how it ended: empty when clean."""
    place = folder / f'{number:04}'
    place.mkdir(parents=True)
    arguments = ['-p', 'record.enabled:=true', '-p', 'joint_interface.enabled:=true']
    process = subprocess.Popen([executable('sim_node'), '--ros-args', *arguments], cwd=place, stderr=subprocess.PIPE,
                               text=True, start_new_session=True, preexec_fn=prepare)
    while process.poll() is None and not takes_signals(process.pid):    # Python itself ends on one without a word
        time.sleep(0.01)
    time.sleep(random_numbers.uniform(0.0, 4.0))    # amid the start, or amid the run
    process.send_signal(random_numbers.choice([signal.SIGINT, signal.SIGTERM]))
    try:
        _, errors = process.communicate(timeout=PATIENCE)
    except subprocess.TimeoutExpired:
        process.kill()
        _, errors = process.communicate()
        return f'hangs: {errors[-500:]}'
    if process.returncode == 0 and 'Traceback' not in errors and 'terminate' not in errors:
        for file in sorted(place.rglob('*'), reverse=True):
            file.rmdir() if file.is_dir() else file.unlink()
        place.rmdir()
        return ''
    return f'exit code {process.returncode}: {errors[-2000:]}'


def main() -> None:
    """Run, and report."""
    parser = argparse.ArgumentParser(prog='python3 -m benchmarks.ends', description=__doc__.splitlines()[0])
    parser.add_argument('--count', type=int, default=500)
    parser.add_argument('--rate', type=float, default=2000.0, help='commands of each kind a second')
    parser.add_argument('--seed', type=int, default=0)
    parser.add_argument('--folder', type=Path, default=Path('runs/ends'), help='for what did not end well')
    options = parser.parse_args()
    flood = subprocess.Popen([sys.executable, '-c', FLOOD, str(options.rate)])
    random_numbers, ends = random.Random(options.seed), Counter[str]()
    try:
        for number in range(options.count):
            how = one(number, options.folder, random_numbers)
            ends[how.partition(':')[0] or 'clean'] += 1
            if how:
                sys.stderr.write(f'{number}: {how}\n')
    finally:
        flood.kill()
        flood.wait()
        print(dict(ends))
    sys.exit(set(ends) != {'clean'})


if __name__ == '__main__':
    main()
