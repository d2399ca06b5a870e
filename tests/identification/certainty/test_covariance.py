# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""What a singular JᵀJ says: parameters that the data do not tell apart are not known, however exact the data are."""

import numpy as np
import pytest

from stickslip_sim.core.arrays import Numbers
from stickslip_sim.identification.certainty import certainty_of, combinations_of
from stickslip_sim.identification.free_parameters import FreeParameter

SIGMA = 1e-9    # of a reading, relative


def parameters(count: int) -> list[FreeParameter]:
    return [FreeParameter(f'axis.number_{k}', '', 1.0, 0.5, 2.0) for k in range(count)]


def information(jacobian: Numbers, error: float) -> Numbers:
    """Return JᵀJ of derivatives in units of the noise, with relative errors as differences have them."""
    noisy = jacobian * (1.0 + error * np.random.default_rng(5).standard_normal(jacobian.shape)) / SIGMA
    return np.asarray(noisy.T @ noisy)


@pytest.mark.parametrize('error', [0.0, 1e-9, 1e-7])
def test_a_slope_known_to_all_digits_leaves_both_ends_open(error: float) -> None:
    """The first column alone, and two whose ratio alone matters."""
    t = np.linspace(0.0, 1.0, 400)
    found = information(np.stack([np.sin(9.0 * t), t, -t], axis=1), error)
    certainty = certainty_of(found, 1.0, parameters(3))
    assert certainty.known.tolist() == [True, False, False]
    assert 6e-11 < certainty.deviations[0] < 1e-8    # and not that of the other two
    (combination,) = combinations_of(found, parameters(3))
    assert combination.names == ('axis.number_1', 'axis.number_2')


def test_what_the_data_tell_apart_is_known_as_before() -> None:
    t = np.linspace(0.0, 1.0, 400)
    jacobian = np.stack([np.sin(9.0 * t), t, t + 1e-3 * t**2], axis=1)
    found = information(jacobian, 0.0)
    certainty = certainty_of(found, 2.0, parameters(3))
    assert certainty.known.all()
    assert certainty.covariance == pytest.approx(2.0 * np.linalg.inv(found), rel=1e-6, abs=0.0)
    assert combinations_of(found, parameters(3)) == ()


def test_what_is_held_is_not_known() -> None:
    certainty = certainty_of(np.diag([4.0e18, 0.0]), 1.0, parameters(2))
    assert certainty.known.tolist() == [True, False]
    assert certainty.covariance[0, 0] == pytest.approx(2.5e-19, abs=0.0)
