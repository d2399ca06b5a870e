# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Installation of stickslip_sim as a ROS 2 package."""

import sys
from glob import glob
from pathlib import Path

from setuptools import find_packages, setup
from setuptools.command.install_scripts import install_scripts

sys.path.insert(0, str(Path(__file__).resolve().parent))   # pip runs this file from elsewhere
from hot_unit.build import BuildUnit, extensions

NAME = 'stickslip_sim'
SHARE = f'share/{NAME}'
# pip makes a wheel: the offline part, with the tool alone in `bin`.  colcon and the build farm of ROS install, with
# the programs of the nodes in lib/stickslip_sim, where `ros2 run` looks (setup.cfg), and the files of a ROS package.
FOR_ROS = not {'bdist_wheel', 'dist_info', 'editable_wheel'} & set(sys.argv)
NODES = ['cascade_controller', 'compensating_controller', 'health', 'replay_node', 'sim_node'] if FOR_ROS else []
PROGRAM = """{python}
import sys
try:
    from {module} import main
except ModuleNotFoundError as error:
    if error.name != '{package}':
        raise
    from pathlib import Path
    places = [place / 'setup.bash' for place in Path(__file__).resolve().parents[2:4]]
    found = next((place for place in places if place.is_file()), 'its setup.bash')
    sys.stderr.write(f'{name}: this terminal does not know the workspace: source {{found}}, in each terminal\\n')
    sys.exit(2)
sys.exit(main())
"""


class InstallPrograms(install_scripts):
    """Writes the programs so that a terminal that does not know the workspace gets a line, and no traceback."""

    def run(self):
        """Let each program have its interpreter, and the text above."""
        super().run()
        for path in map(Path, self.get_outputs()):
            module = f'{NAME}.ros.{path.name}' if path.name in NODES else f'{NAME}.__main__'
            python, _, _ = path.read_text().partition('\n')
            path.write_text(PROGRAM.format(python=python, module=module, package=NAME, name=path.name))


setup(
    name=NAME,
    cmdclass={'build_ext': BuildUnit, 'install_scripts': InstallPrograms},
    ext_modules=extensions(),
    version='1.0.1',
    description='Stick-slip of a feed axis in real time: exact engine, ROS 2 node, offline tool',
    maintainer='The stickslip developers',
    maintainer_email='stickslip@example.org',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['py.typed', 'scenes/*.yaml', 'recording/stickslip_msgs/*.msg', 'ros/client/*.xml']},
    data_files=[
        ('share/ament_index/resource_index/packages', [f'resource/{NAME}']),
        (SHARE, ['package.xml']),
        ('bin', ['bin/stickslip']),
        (f'{SHARE}/scenes', sorted(glob(f'{NAME}/scenes/*.yaml'))),
        (f'{SHARE}/launch', sorted(glob('launch/*.launch.py'))),
        (f'{SHARE}/layouts', sorted(glob('layouts/*'))),
        (f'{SHARE}/ros2_control', sorted(glob('ros2_control/*'))),
        (f'{SHARE}/rviz', sorted(glob('rviz/*'))),
        (f'{SHARE}/security', sorted(glob('security/*'))),
        (f'{SHARE}/urdf', sorted(glob('urdf/*'))),
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
