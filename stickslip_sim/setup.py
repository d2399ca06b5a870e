"""Installation of stickslip_sim as a ROS 2 package."""

from glob import glob

from setuptools import find_packages, setup

NAME = 'stickslip_sim'
SHARE = f'share/{NAME}'

setup(
    name=NAME,
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
        (f'{SHARE}/scenes', sorted(glob(f'{NAME}/scenes/*.yaml'))),
        (f'{SHARE}/launch', sorted(glob('launch/*.launch.py'))),
    ],
    zip_safe=False,
    python_requires='>=3.10',
    install_requires=[
        'setuptools', 'numpy', 'scipy', 'numba', 'PyYAML', 'mcap', 'zstandard', 'lz4', 'rosbags',
        'matplotlib', 'click',
    ],
    extras_require={'bench': ['mpmath'], 'test': ['pytest']},
    entry_points={
        'console_scripts': [
            'sim_node = stickslip_sim.ros.sim_node:main',
            'stickslip = stickslip_sim.__main__:main',
        ],
    },
)
