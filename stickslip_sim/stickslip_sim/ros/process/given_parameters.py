# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters that the command line gives a node, in files and one by one.

Files are read here before ROS reads them, whose parser needs minutes for what is long or deeply nested; and here the
sections that fit a node are chosen as rclcpp does it, where rclpy knows no wildcard but `/**`.
"""

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import NamedTuple

from ...config.ros_yaml import read_yaml
from ...scene.load import named, read_text
from ...scene.sections import Section, sections_of


class ParameterFile(NamedTuple):
    """A file and its sections, for any nodes."""

    path: str
    sections: Sequence[Section]


class NodeParameters(NamedTuple):
    """The parameters of one node by dotted name: those `in_files`, and `single` ones, which hold over them.

    `folders` are those of the files by parameter; `passed_over` are the files without a section that fits the node.
    """

    in_files: Mapping[str, object]
    single: Mapping[str, object]
    folders: Mapping[str, Path]
    source: str
    passed_over: Sequence[str]

    @property
    def values(self) -> dict[str, object]:
        """All of them."""
        return {**self.in_files, **self.single}


class GivenParameters(NamedTuple):
    """All parameters of a command line, for any nodes; each of the single ones is a section."""

    files: Sequence[ParameterFile] = ()
    single: Sequence[Section] = ()

    @classmethod
    def read(cls, args: Sequence[str]) -> 'GivenParameters':
        """Read them; raises InputError on a file that is too long or deep, or no parameter file as ROS reads it."""
        files, single = [], []
        for flag, word in _options(args):
            if flag == '--params-file':
                files.append(_read(word))
            elif ':=' in word:    # ROS itself refuses what is none
                single.append(_assigned(word))
        return cls(files, single)

    def of(self, node: str) -> NodeParameters:
        """Return the parameters of a node by its full name.

        What a more specific section says holds, and of equally specific ones the later.
        """
        fitting = [(section, file.path) for file in self.files for section in file.sections if section.fits(node)]
        fitting.sort(key=lambda found: found[0].specificity)
        in_files = {name: value for section, _ in fitting for name, value in section.parameters}
        folders = {name: Path(path).parent for section, path in fitting for name, _ in section.parameters}
        single = {name: value for section in self.single if section.fits(node) for name, value in section.parameters}
        paths = dict.fromkeys(path for _, path in fitting)
        return NodeParameters(in_files, single, folders, ' + '.join(paths),
                              [file.path for file in self.files if file.path not in paths])


def _options(args: Sequence[str]) -> Iterator[tuple[str, str]]:
    """Yield the flags of ROS for parameters and what follows each; they stand between --ros-args and --."""
    is_of_ros = False
    for word, following in zip(args, [*args[1:], '']):
        if word in ('--ros-args', '--'):
            is_of_ros = word == '--ros-args'
        elif is_of_ros and word in ('--params-file', '-p', '--param') and following:
            yield word, following


def _read(path: str) -> ParameterFile:
    with named(path):
        return ParameterFile(path, sections_of(read_yaml(read_text(Path(path), 'parameter file'))))


def _assigned(word: str) -> Section:
    """Return `[NODE:]NAME:=VALUE` as a section."""
    left, _, value = word.partition(':=')
    node, _, name = left.rpartition(':')
    with named(left):
        return Section(node or '/**', [(name, read_yaml(value))])
