#!/usr/bin/env python3
# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Resolve requirements-DISTRO.in, requirements-test.in and requirements-bench.in into full locks.

    python3.10 lock.py [DISTRO]

Run it with the oldest Python that is supported: what installs there also
installs on the newer ones, so one lock serves them all.  Names and versions are
those that pip resolves.  `pip freeze` would not do: the ROS wheels carry a
second set of names (`rclpy` beside `ros-rclpy`) that are not theirs on PyPI.
"""

import json
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
OLDEST = (3, 10)
NEWER = '3.11'   # that some of the benchmark's peers need
# What FMPy asks for and is not installed: lark is the same module as lark-parser, which the ROS wheels have, and FMPy
# runs with; cmake would take the place of the machine's.
LEFT_OUT = {'lark', 'cmake'}


def resolve(*wanted: str) -> set[str]:
    """Return the pins `name==version` of everything that arguments of pip install need."""
    command = [sys.executable, '-m', 'pip', 'install', '--quiet', '--dry-run',
               '--ignore-installed', '--report', '-', *wanted]
    report = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    metadata = [item['metadata'] for item in report['install']]
    return {f"{item['name'].lower()}=={item['version']}" for item in metadata}


def resolve_for_newer(requirements: pathlib.Path, beside: pathlib.Path, known: set[str]) -> set[str]:
    """Return the pins of what has a marker for NEWER, for it alone; pip takes markers for the Python that runs it."""
    lines = requirements.read_text(encoding='utf-8').splitlines()
    marker = f'python_version >= "{NEWER}"'
    wanted = [line.partition(';')[0] for line in lines if line.endswith(f'; {marker}')]
    found = resolve('-c', str(beside), '--python-version', NEWER, '--only-binary', ':all:', '--target', 'unused',
                    *wanted) if wanted else set()
    names = {pin.partition('==')[0] for pin in known}
    return {f'{pin}; {marker}' for pin in found if pin.partition('==')[0] not in names}


def write(path: pathlib.Path, pins: set[str]) -> None:
    """Write a lock, sorted, with a line that says where it comes from."""
    head = f'# Full lock of {path.stem}.in; made by lock.py, not by hand.'
    pins = {pin for pin in pins if pin.partition('==')[0] not in LEFT_OUT}
    path.write_text('\n'.join([head, *sorted(pins)]) + '\n')
    print(f'{path.name}: {len(pins)} packages')


def main() -> None:
    """Write all locks; those beside the product's hold only what it lacks."""
    if sys.version_info[:2] != OLDEST:
        sys.exit('run lock.py with Python {}.{}, the oldest supported'.format(*OLDEST))
    distro = sys.argv[1] if len(sys.argv) > 1 else 'jazzy'
    product = HERE / f'requirements-{distro}.in'
    pins = resolve('-r', str(product))
    lock = product.with_suffix('.txt')
    write(lock, pins)
    for name in ('test', 'bench'):
        more = HERE / f'requirements-{name}.in'
        found = resolve('-r', str(more), '-c', str(lock))
        write(more.with_suffix('.txt'), (found | resolve_for_newer(more, lock, found | pins)) - pins)


if __name__ == '__main__':
    main()
