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


def resolve(requirements: pathlib.Path, beside: pathlib.Path | None = None) -> set[str]:
    """Return the pins `name==version` of everything that the file needs, where the lock `beside` allows it."""
    files = ['-r', str(requirements), *(('-c', str(beside)) if beside else ())]
    command = [sys.executable, '-m', 'pip', 'install', '--quiet', '--dry-run',
               '--ignore-installed', '--report', '-', *files]
    report = json.loads(subprocess.run(command, check=True, stdout=subprocess.PIPE).stdout)
    metadata = [item['metadata'] for item in report['install']]
    return {f"{item['name'].lower()}=={item['version']}" for item in metadata}


def write(path: pathlib.Path, pins: set[str]) -> None:
    """Write a lock, sorted, with a line that says where it comes from."""
    head = f'# Full lock of {path.stem}.in; made by lock.py, not by hand.'
    path.write_text('\n'.join([head, *sorted(pins)]) + '\n')
    print(f'{path.name}: {len(pins)} packages')


def main() -> None:
    """Write all locks; those beside the product's hold only what it lacks."""
    if sys.version_info[:2] != OLDEST:
        sys.exit('run lock.py with Python {}.{}, the oldest supported'.format(*OLDEST))
    distro = sys.argv[1] if len(sys.argv) > 1 else 'jazzy'
    product = HERE / f'requirements-{distro}.in'
    pins = resolve(product)
    lock = product.with_suffix('.txt')
    write(lock, pins)
    for name in ('test', 'bench'):
        more = HERE / f'requirements-{name}.in'
        write(more.with_suffix('.txt'), resolve(more, lock) - pins)


if __name__ == '__main__':
    main()
