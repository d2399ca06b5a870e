# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The parameters of the example controllers: their list, and what they make."""

from collections.abc import Mapping

from ...axis import Axis
from ...config.parameter import Parameter
from ...controllers import BranchCompensation, Cascade, Controller, Following, Moves
from ...inputs import load_scene
from ...scene.load import named
from ...scene.schema import JOINT_PREFIX

_LEAST = 1e-12       # of what must not be zero
_MOVES, _GAINS = Moves(), Cascade()
_FIELDS = BranchCompensation.__dataclass_fields__

COMMON = (
    Parameter('moves.travel', 'double', _MOVES.travel, 'm', 'of a move out, and back', _LEAST, 1e3),
    Parameter('moves.feed', 'double', _MOVES.feed, 'm/s', 'of the moves', _LEAST, 1e3),
    Parameter('moves.acceleration', 'double', _MOVES.acceleration, 'm/s²', 'up to the feed, and down', 1e-9, 1e6),
    Parameter('moves.dwell', 'double', _MOVES.dwell, 's', 'at rest after each move', 0.0, 1e6),
    Parameter('position_gain', 'double', _GAINS.position_gain, '1/s', 'K_v of the position loop', 0.0, 1e4, live=True),
    Parameter('velocity_gain', 'double', _GAINS.velocity_gain, '', 'K_p of the velocity loop', 0.0, 1e4, live=True),
    Parameter('integral_time', 'double', _GAINS.integral_time, 's', 'T_n of the velocity loop; .inf: no integral part',
              1e-6, 1e6, infinite=True, live=True),
    Parameter('max_velocity', 'double', 1.0, 'm/s', 'of the drive; commands stay within it, and the integral part does'
              ' not wind up', 1e-9, 1e6),
    Parameter('max_gap', 'double', 0.5, 's', 'between two measurements; after a longer one the moves begin anew', 1e-6,
              1e6),
    JOINT_PREFIX,
)
COMPENSATION = (
    Parameter('compensation.model', 'string', 'positioning', '', 'scene, shipped or a file, whose axis is the model of'
              ' spring and friction'),
    Parameter('compensation.share', 'double', _FIELDS['share'].default, '', 'of the gap between the branches of'
              ' friction that is crossed', 0.0, 1.0, live=True),
    Parameter('compensation.rate', 'double', _FIELDS['rate'].default, '1/s', 'at which it is crossed', 0.0, 1e4,
              live=True),
    Parameter('compensation.threshold', 'double', _FIELDS['threshold'].default, 'm/s', 'error of the velocity from'
              ' which on it acts in full', _LEAST, 1e3, live=True),
)


def model_of(values: Mapping[str, object]) -> Axis | None:
    """Return the axis that the compensation takes for its model; raises InputError when it is no scene."""
    model = values.get('compensation.model')
    if model is None:
        return None
    with named('compensation.model'):
        return load_scene(str(model)).axis


def following(values: Mapping[str, object], model: Axis | None) -> Following:
    """Return the controller, which compensates friction if it has a model, and its moves."""
    of = {name: value for name, value in values.items() if isinstance(value, float)}
    moves = Moves(of['moves.travel'], of['moves.feed'], of['moves.acceleration'], of['moves.dwell'])
    cascade = Cascade(of['position_gain'], of['velocity_gain'], of['integral_time'])
    compensation = BranchCompensation(model, of['compensation.share'], of['compensation.rate'],
                                      of['compensation.threshold']) if model else None
    return Following(Controller(cascade, compensation, of['max_velocity']), moves, of['max_gap'])
