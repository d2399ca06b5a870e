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
# pip makes a wheel: the offline part, with the tool alone in `bin`.  colcon and the build farm of ROS install, with
# the programs of the nodes in lib/stickslip_sim, where `ros2 run` looks (setup.cfg), and the files of a ROS package.
FOR_ROS = not {'bdist_wheel', 'dist_info', 'editable_wheel'} & set(sys.argv)
NODES = ['cascade_controller', 'compensating_controller', 'health', 'replay_node', 'sim_node'] if FOR_ROS else []

setup(
    name=NAME,
    cmdclass={'build_ext': BuildUnit},
    ext_modules=extensions(),
    version='1.0.1',
    description='Stick-slip of a feed axis in real time: exact engine, ROS 2 node, offline tool',
    maintainer='The stickslip developers',
    maintainer_email='stickslip@example.org',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['py.typed', 'scenes/*.yaml', 'recording/stickslip_msgs/*.msg']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (SHARE, ['package.xml']),
        ('bin', ['bin/stickslip']),
        (f'{SHARE}/scenes', sorted(glob(f'{NAME}/scenes/*.yaml'))),
        (f'{SHARE}/launch', sorted(glob('launch/*.launch.py'))),
        (f'{SHARE}/layouts', sorted(glob('layouts/*'))),
        (f'{SHARE}/ros2_control', sorted(glob('ros2_control/*'))),
        (f'{SHARE}/security', sorted(glob('security/*'))),
    ] if FOR_ROS else [],
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
            *(f'{node} = stickslip_sim.ros.{node}:main' for node in NODES),
            'stickslip = stickslip_sim.__main__:main',
        ],
    },
)
