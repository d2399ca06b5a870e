# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The reference of all scene parameters as Markdown: `python3 -m stickslip_sim.scene.document > docs/scene.md`."""

import sys
from itertools import groupby

from ..config.parameter import Parameter
from .schema import PARAMETERS
from .text import yaml_value

_HEAD = """\
# Every parameter of a scene

Look up here every parameter that a scene file may have: type, unit, default, range and meaning.  Made from the schema
by `python3 -m stickslip_sim.scene.document > docs/scene.md`; a test keeps it up to date.

A scene is a ROS 2 parameter file: sections below `/**:` (or `feed_axis:`) and `ros__parameters:`.  The node loads it
with `--params-file`, the tool by its path.  Both refuse unknown names, wrong types and ranges, and values that
contradict a choice, with one line.  The shipped files in `stickslip_sim/stickslip_sim/scenes/` are the models to copy.

* **`scene`** names the scene.  The name of a shipped scene takes that scene, and the file changes it: `scene:
  positioning` with `axis: {normal_force: 2500.0}` is `positioning` with another normal force, the same in a file, in
  the `parameters` of a launch file, and with `-p` or `--set`.  Any other name is yours, for a file that gives the whole
  scene.  A file without `scene` must give both laws of friction, `friction.static` and `friction.kinetic`.
* **Defaults.**  In a whole scene a parameter that is left out takes the default.  Only the axis has the paper's values
  there; everything else that is left out is not modelled: no friction, a rigid contact, a drive that stands still, no
  force.  (A node without a file runs `paper_fig8`.)  Every number has bounds, far beyond any machine, within which
  nothing overflows.
* **One file for several nodes.**  The node takes the sections that fit its full name, `/x/feed_axis`, as every ROS node
  does: `*` stands for one word of a name, `**` for any number of them.  The more specific section holds over the more
  general one, of two alike the later one, and `-p` over all.  Sections of other nodes are passed over.  The tool takes
  files for one axis only.
* **"with"** says for which choice a parameter has a meaning.  Given with another choice it is refused; without a
  default (*needed*) it must be given.
* **Numbers.**  Write numbers with a dot, `350.0` or `6.0e5`.  A whole number is taken for a double, but inside a list
  ROS wants all alike: `[0.0, 0.035]`.  Infinity is `.inf`.  Anchors, aliases, tags and a name given twice are refused.
* **"live"** parameters may change while the node runs.  `ros2 param set`, `ros2 param load` and the service
  `set_parameters` change one after the other, each checked with those in force, as ROS defines it.  Parameters that
  must change together, as both lists of a friction table to another length, go by the service
  `set_parameters_atomically` (in newer ROS `ros2 param load --atomic`): all or none, between the same two steps.
* **`null`** is as if left out.  `ros2 param dump /feed_axis` writes it for what has no value: its file is a scene, for
  the node and the tool.
* **`--set a.b=value`** of the tool changes one value of the file.  If it changes a choice, the values that the file
  gives for the old choice are dropped: `--set contact.model=rigid` needs no more.
* **Input profiles.**  `drive.course` and `force.course` choose the input profile: velocity or force over time.
  `normal_load.course` adds a load to the normal force (docs/model.md); `solver.name: fixed_step` takes constant or
  steps alone, and Kato's law under one that varies smoothly is for `adaptive`.
* **Position of the drive.**  `drive: {course: position, times: [0.0, 1.0, 3.0], positions: [0.0, 0.002, 0.002]}`
  prescribes s, where the drive end of the spring is.  Its velocity is the derivative, exactly: s is linear between the
  breakpoints, so that the velocity jumps there; with `slopes`, the velocities just after each of them, it is quadratic.
  The velocity does not jump where the slopes at both ends of an interval are on average its mean velocity.  After the
  last breakpoint the drive stands still, or goes on at the last slope; a `period` leads back to the first position,
  which is where the drive starts: initial.position + initial.stretch.  A jump of s is refused: the drive's damper would
  answer it with an infinite force.
* **Profiles from files.**  `drive: {file: feed.csv}` takes the place of times and velocities, `force: {file:
  pull.csv}` and `normal_load: {file: clamp.csv}` of times and forces: measured, or from another program.  A CSV file
  begins with a line of names; `file_column`, `file_unit`, `file_time` and `file_time_unit` say which columns are
  meant, and their units.  Left out they are `velocity`, `position` (`course: position`) or `force`, and `time`, in SI;
  a heading that names another unit (`v [mm/s]`) is refused.  A unit may have a factor: `35.15 N`.  A decimal comma is
  read where the commas are not between columns, what follows a `#` is not read.  `file: run:slider_state` is a topic
  of a bag; its column is a field of the messages, like `velocity`, `wrench.force.x`, `velocity[0]` or
  `velocity[axis_drive]`.  The profile is linear between the rows (`course: table`) unless `course: steps` says that
  each value holds until the next, and is resampled only where `file_resample` asks for it.  The points become the
  times and values of the scene: its hash, the bag and the receipt hold them, and `verify` needs the file no more.  Up
  to 200,000 rows; 25,000 are read in 0.1 s and simulated in 0.01 s.
* **Tables.**  The points of a table are its breakpoints; it is linear between them.  Breakpoints of friction are at
  least 1e-8 of their speed apart, those over time 1e-11 s.
* **Backwards.**  Real axes differ forwards and backwards.  The sections `backward` of friction have the numbers of
  motion along -x, and of a force that pulls that way: `friction: {static: {initial: 0.12, backward: {initial: 0.1}}}`.
  Each that is left out is as forwards.  The choices (`law`, `acceleration_dependence`) and `tolerance` are for both.
"""


def document() -> str:
    """Return the reference."""
    parts = [_HEAD]
    for section, entries in groupby(PARAMETERS, lambda entry: entry.name.rpartition('.')[0] or entry.name):
        parts.append(f'\n## {section}\n\n| name | type | unit | default | range | with | live | meaning |\n'
                     '|---|---|---|---|---|---|---|---|\n')
        parts.extend(map(_row, entries))
    return ''.join(parts)


def _row(entry: Parameter) -> str:
    limits = ', '.join(f'`{choice}`' for choice in entry.choices) or entry.range
    cells = [f'`{entry.name}`', entry.type.replace('_', ' '), entry.unit, _default(entry), limits,
             f'`{entry.when}`' if entry.when else '', 'yes' if entry.live else '', entry.description]
    return '| ' + ' | '.join(cell.replace('|', '\\|') for cell in cells) + ' |\n'


def _default(entry: Parameter) -> str:
    if entry.default is None:
        return '*needed*' if entry.required else '*none*'
    return f'`{yaml_value(entry, entry.default)}`'


if __name__ == '__main__':
    sys.stdout.write(document())
