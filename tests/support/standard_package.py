# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The ROS package simulation_interfaces as far as the node needs it, which is not in the wheels.

As a program it calls its services, in a process that finds the package, and prints the answers as JSON:

python3 -m tests.support.standard_package 'NAME {"field": value}' ...

Types, fields and constants are those of its release 1.0 and later (ros-simulation/simulation_interfaces).
"""

import json
import os
import subprocess
import sys
from collections.abc import Mapping
from hashlib import sha256
from importlib import import_module
from pathlib import Path
from textwrap import dedent
from typing import Any

import rclpy
from rcl_interfaces.srv import GetParameters
from rclpy.node import Node

from stickslip_sim.ros.node.endpoints import fields_of

_DEFINITIONS = {
    'msg/Result': '''
        uint8 RESULT_FEATURE_UNSUPPORTED=0
        uint8 RESULT_OK=1
        uint8 RESULT_OPERATION_FAILED=4
        uint8 result
        string error_message''',
    'msg/SimulationState': '''
        uint8 STATE_STOPPED=0
        uint8 STATE_PLAYING=1
        uint8 STATE_PAUSED=2
        uint8 STATE_QUITTING=3
        uint8 state''',
    'msg/SimulatorFeatures': '''
        uint8 SIMULATION_RESET=20
        uint8 SIMULATION_STATE_GETTING=24
        uint8 SIMULATION_STATE_SETTING=25
        uint8 SIMULATION_STATE_PAUSE=26
        uint8 STEP_SIMULATION_SINGLE=31
        uint8 STEP_SIMULATION_MULTIPLE=32
        uint16[] features
        string[] spawn_formats
        string custom_info''',
    'srv/GetSimulatorFeatures': '''
        ---
        SimulatorFeatures features''',
    'srv/ResetSimulation': '''
        uint8 SCOPE_DEFAULT=0
        uint8 SCOPE_TIME=1
        uint8 SCOPE_ALL=255
        uint8 scope
        ---
        Result result''',
    'srv/StepSimulation': '''
        uint64 steps 1
        ---
        Result result''',
    'srv/GetSimulationState': '''
        ---
        SimulationState state
        Result result''',
    'srv/SetSimulationState': '''
        SimulationState state
        ---
        uint8 ALREADY_IN_TARGET_STATE=101
        Result result''',
}
_CMAKE = '''
cmake_minimum_required(VERSION 3.16)
project(simulation_interfaces)
find_package(ament_cmake REQUIRED)
find_package(rosidl_default_generators REQUIRED)
rosidl_generate_interfaces(${PROJECT_NAME} %s)
# of C++, compiled together: two thirds of the time
foreach(support fastrtps_c fastrtps_cpp introspection_cpp cpp)
  set_target_properties(${PROJECT_NAME}__rosidl_typesupport_${support} PROPERTIES
    UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 0)
endforeach()
ament_package()
'''
_PACKAGE = '''
<package format="3">
  <name>simulation_interfaces</name>
  <version>1.0.0</version>
  <description>As far as the tests need it</description>
  <maintainer email="stickslip@example.org">The stickslip developers</maintainer>
  <license>Apache-2.0</license>
  <buildtool_depend>ament_cmake</buildtool_depend>
  <buildtool_depend>rosidl_default_generators</buildtool_depend>
  <member_of_group>rosidl_interface_packages</member_of_group>
</package>
'''


def environment(folder: Path) -> dict[str, str]:
    """Return what a process needs to find the package; builds it below the folder unless it is there."""
    made_of = repr((_DEFINITIONS, _CMAKE, sys.version, os.environ['AMENT_PREFIX_PATH']))
    folder /= sha256(made_of.encode()).hexdigest()[:16]
    prefix = folder / 'install'
    if not (folder / 'done').exists():
        _build(folder, prefix)
        (folder / 'done').touch()
    version = f'python{sys.version_info.major}.{sys.version_info.minor}'
    added = {'AMENT_PREFIX_PATH': prefix, 'LD_LIBRARY_PATH': prefix / 'lib',
             'PYTHONPATH': prefix / 'lib' / version / 'site-packages'}
    return {name: os.pathsep.join([str(path), *filter(None, [os.environ.get(name)])]) for name, path in added.items()}


def _build(folder: Path, prefix: Path) -> None:
    source = folder / 'source'
    for name, text in _DEFINITIONS.items():
        file = source / f'{name}.{name[:3]}'
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dedent(text))
    (source / 'CMakeLists.txt').write_text(_CMAKE % ' '.join(f'{name}.{name[:3]}' for name in _DEFINITIONS))
    (source / 'package.xml').write_text(_PACKAGE)
    build = str(folder / 'build')
    for command in (['cmake', '-S', str(source), '-B', build, f'-DCMAKE_INSTALL_PREFIX={prefix}'],
                    ['cmake', '--build', build, '--parallel'], ['cmake', '--install', build]):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]


def main() -> None:
    rclpy.init()
    node = Node('standard_client')
    answers = [ask(node, *words.split(' ', 1)) for words in sys.argv[1:]]
    print(json.dumps(answers, default=list))
    rclpy.shutdown()


def ask(node: Node, name: str, fields: str = '{}') -> Any:
    srv = import_module('simulation_interfaces.srv')    # others need not have it
    kind = getattr(srv, ''.join(part.title() for part in name.split('_')))
    client = node.create_client(kind, f'feed_axis/{name}')
    assert client.wait_for_service(20.0), name
    greet(node)
    request = kind.Request()
    fill(request, json.loads(fields))
    future = client.call_async(request)
    rclpy.spin_until_future_complete(node, future, timeout_sec=20.0)
    return fields_of(future.result())


def greet(node: Node) -> None:
    """Wait until the simulator knows every client made so far, as the client in ros_nodes.py does."""
    client = node.create_client(GetParameters, 'feed_axis/get_parameters')
    assert client.wait_for_service(20.0)
    for _ in range(20):
        future = client.call_async(GetParameters.Request())
        rclpy.spin_until_future_complete(node, future, timeout_sec=1.0)
        if future.done():
            return
    raise AssertionError('the simulator does not answer')


def fill(message: Any, fields: Mapping[str, Any]) -> None:
    for name, value in fields.items():
        if isinstance(value, Mapping):
            fill(getattr(message, name), value)
        else:
            setattr(message, name, value)


if __name__ == '__main__':
    main()
