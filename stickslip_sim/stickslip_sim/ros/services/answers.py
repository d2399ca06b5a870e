# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Answers of services."""

from typing import Any

BUSY = 'the step loop is busy'


def answer(response: Any, success: bool, message: str) -> Any:
    """Fill in a response that has a success and a message."""
    response.success, response.message = success, message
    return response
