# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Installation of stickslip_sim as a ROS 2 package."""

import sys
from glob import glob
from pathlib import Path

from setuptools import find_packages, setup

sys.path.insert(0, str(Path(__file__).resolve().parent))   # pip runs this file from elsewhere
from hot_unit.build import BuildUnit, extensions

NAME = 'stickslip_sim'
SHARE = f'share/{NAME}'

setup(
    name=NAME,
    cmdclass={'build_ext': BuildUnit},
    ext_modules=extensions(),
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
        'setuptools', 'numpy', 'scipy', 'PyYAML', 'mcap', 'zstandard', 'lz4', 'rosbags',
        'matplotlib>=3.6', 'click', 'mpmath',
    ],
    extras_require={
        'bench': ['numba'], 'cluster': ['distributed'], 'tables': ['pandas', 'fastparquet'],
        'test': ['numba', 'pytest'],
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
