# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Figures in words: numbers that are read beside each other have one unit."""

from stickslip_sim.runs.wording import quantities, quantity


def test_a_quantity_has_the_prefix_that_suits_it() -> None:
    found = [quantity(value, 's', 4) for value in (0.9723, 1.137, 3600.0, 0.0)]
    assert found == ['972.3 ms', '1.137 s', '3600 s', '0 s']


def test_kilograms_have_a_prefix_already() -> None:
    assert [quantity(value, 'kg', 4) for value in (1553.2, 34.0, 0.25, 2e-6)] == ['1553 kg', '34 kg', '250 g', '2 mg']
    assert quantities([0.4, 0.5, 1.2], 'kg', 4) == ['400 g', '500 g', '1200 g']
    assert quantities([900.0, 1000.0, 1100.0], 'kg', 4) == ['900 kg', '1000 kg', '1100 kg']


def test_few_digits_are_no_power_of_ten() -> None:
    found = [quantity(value, 'N s/m', 2) for value in (4.6e-4, 985.0, 0.0312)]
    assert found == ['460 µN s/m', '980 N s/m', '31 mN s/m']


def test_quantities_have_that_of_the_one_in_the_middle() -> None:
    assert quantities([0.6631, 0.9723, 1.4991], 's', 4) == ['663.1 ms', '972.3 ms', '1499 ms']
    assert quantities([0.0, 0.2, 0.3], 'm', 4) == ['0 mm', '200 mm', '300 mm']
    assert quantities([0.1, 0.25], '', 4) == ['0.1', '0.25']


def test_quantities_too_far_apart_have_one_each() -> None:
    assert quantities([0.001, 0.5, 100.0], 's', 4) == ['1 ms', '500 ms', '100 s']
