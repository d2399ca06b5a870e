# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Installation of stickslip_sim as a ROS 2 package."""

import os
import subprocess
import sys
from glob import glob

from setuptools import find_packages, setup
from setuptools.command.build_py import build_py

NAME = 'stickslip_sim'
SHARE = f'share/{NAME}'


class BuildAndCompile(build_py):
    """Build, and compile the hot path ahead of time; where that fails, the first start of the package compiles."""

    def run(self):
        """Compile what was just built, in a process that imports nothing else of this name."""
        super().run()
        environment = {**os.environ, 'STICKSLIP_COMPILED': 'jit', 'PYTHONPATH': os.pathsep.join(
            [os.path.abspath(self.build_lib), *filter(None, os.environ.get('PYTHONPATH', '').split(os.pathsep))])}
        done = subprocess.run([sys.executable, '-m', f'{NAME}.solvers.ahead', os.path.join(self.build_lib, NAME)],
                              env=environment, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            reason = (done.stderr.strip().splitlines() or ['no reason given'])[-1]
            self.warn(f'{NAME} is not compiled ahead of time; its first start will compile: {reason}')


setup(
    name=NAME,
    cmdclass={'build_py': BuildAndCompile},
    version='0.1.0',
    description='Stick-slip of a feed axis in real time: exact engine, ROS 2 node, offline tool',
    maintainer='The stickslip developers',
    maintainer_email='stickslip@example.org',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['py.typed', 'scenes/*.yaml']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (SHARE, ['package.xml']),
        ('bin', ['bin/stickslip']),
        (f'{SHARE}/scenes', sorted(glob(f'{NAME}/scenes/*.yaml'))),
        (f'{SHARE}/launch', sorted(glob('launch/*.launch.py'))),
        (f'{SHARE}/layouts', sorted(glob('layouts/*'))),
        (f'{SHARE}/ros2_control', sorted(glob('ros2_control/*'))),
        (f'{SHARE}/security', sorted(glob('security/*'))),
    ],
    zip_safe=False,
    python_requires='>=3.10',
    install_requires=[
        'setuptools', 'numpy', 'scipy', 'numba', 'PyYAML', 'mcap', 'zstandard', 'lz4', 'rosbags',
        'matplotlib>=3.6', 'click',
    ],
    extras_require={
        'bench': ['mpmath'], 'cluster': ['distributed'], 'tables': ['pandas', 'fastparquet'], 'test': ['pytest'],
    },
    entry_points={
        'console_scripts': [
            'cascade_controller = stickslip_sim.ros.cascade_controller:main',
            'compensating_controller = stickslip_sim.ros.compensating_controller:main',
            'health = stickslip_sim.ros.health:main',
            'replay_node = stickslip_sim.ros.replay_node:main',
            'sim_node = stickslip_sim.ros.sim_node:main',
            'stickslip = stickslip_sim.__main__:main',
        ],
    },
)
