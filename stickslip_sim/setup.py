# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Installation of stickslip_sim as a ROS 2 package."""

import sys
from contextlib import suppress
from glob import glob
from pathlib import Path

from setuptools import find_packages, setup
from setuptools.command.install_scripts import install_scripts

sys.path.insert(0, str(Path(__file__).resolve().parent))   # pip runs this file from elsewhere
from distutils.command.install_data import install_data  # after setuptools, which brings it since Python 3.12

from hot_unit.build import BuildUnit, extensions

NAME = 'stickslip_sim'
SHARE = f'share/{NAME}'
# The programs beside the tool, which is the only entry point: pip puts each entry point of a wheel into `bin`, and a
# wheel is the offline part.  colcon and the build farm call setup.py, with lib/stickslip_sim for programs (setup.cfg).
NODES = ['cascade_controller', 'compensating_controller', 'controller_node', 'health', 'replay_node', 'sim_node']
PROGRAM = """{python}
import sys
try:
    from {module} import {function} as main
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


class Programs:
    """Writes the programs; a terminal that does not know the workspace gets a line from them, and no traceback."""

    def write_script(self, script_name, contents, mode='t', *others):
        """Write all in place of the one that setuptools makes for the tool, whose interpreter they take.

        It makes none for a wheel.
        """
        python, _, _ = contents.partition('\n')
        for name in (script_name, *NODES):
            module, function = ('ros.executables', name) if name in NODES else ('__main__', 'main')
            text = PROGRAM.format(python=python, module=f'{NAME}.{module}', function=function, package=NAME, name=name)
            super().write_script(name, text, mode, *others)


class InstallPrograms(Programs, install_scripts):
    """Writes the programs of `setup.py install`."""


class InstallData(install_data):
    """Installs the files of a ROS package; a wheel has none."""

    def run(self):
        """Copy them, unless setuptools makes a wheel and so writes no programs either."""
        if not self.get_finalized_command('install_scripts').no_ep:
            super().run()


COMMANDS = {'build_ext': BuildUnit, 'install_data': InstallData, 'install_scripts': InstallPrograms}
with suppress(ImportError):    # `colcon build --symlink-install` develops; setuptools means to drop the command
    from setuptools.command.develop import develop
    COMMANDS['develop'] = type('DevelopPrograms', (Programs, develop), {})

setup(
    name=NAME,
    cmdclass=COMMANDS,
    ext_modules=extensions(),
    version='2.0.0',
    description='Feed-axis simulator with stick-slip friction: exact engine, ROS 2 node and command-line tool',
    maintainer='The stickslip developers',
    maintainer_email='stickslip@example.org',
    license='Apache-2.0',
    packages=find_packages(include=[NAME, f'{NAME}.*']),
    package_data={NAME: ['py.typed', 'scenes/*.yaml', 'bags/stickslip_msgs/*.msg', 'ros/*.xml', 'plain_c/*.[ch]',
                         'plain_c/*.comp', 'fmu/*.c', 'explorer/*.js', 'explorer/page.html',
                         'explorer/page.css']},
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
    entry_points={'console_scripts': ['stickslip = stickslip_sim.__main__:main']},
)
