# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""An identification as values for JSON, SI; what is not a finite number is null, or the text 'inf'."""

import json
import math
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from ...core.errors import InputError
from ...plots.known_friction import Band, KnownFriction
from ...runs.receipt import versions
from ..identified import LEVEL, ChannelFit, Estimate, Identification
from .identified_scene import OF_SENSORS

IDENTIFIED_VALUES = 'report.json'


def report_values(found: Identification, run: str, start: str, friction: Mapping[str, KnownFriction]
                  ) -> dict[str, Any]:
    """Return all that a report has, but for the readings themselves."""
    values: dict[str, Any] = _plain({
        'run': run, 'start': start, 'scene': found.scene.name, 'scene_hash': found.scene.hash, 'fits': found.fits,
        'level': LEVEL, 'estimates': [_estimate(one) for one in found.estimates],
        'correlation': found.correlation.tolist(), 'channels': [_channel(one) for one in found.channels],
        'misfits': [asdict(one) for one in found.misfits],
        'combinations': [asdict(one) for one in found.combinations], 'starts': [asdict(one) for one in found.starts],
        'criterion': found.criterion, 'laws': [asdict(one) for one in found.laws],
        'slips': [asdict(one) for one in found.slips], 'friction': _friction(next(iter(friction.values()))),
        'friction_backward': _friction(friction['backward']) if 'backward' in friction else None, 'cost': found.cost,
        'residuals': found.n_residuals, 'runs': found.runs, 'seconds': found.seconds, 'notes': list(found.notes),
        'restarts': list(found.restarts),        'versions': versions(),
    })
    return values


def sensor_errors(folder: Path) -> dict[str, float]:
    """Return what the report in a folder says of sensors, as `sensor.CHANNEL.offset`; nothing without a report.

    Raises InputError on one that is damaged.
    """
    path = folder / IDENTIFIED_VALUES
    if not path.is_file():
        return {}
    try:
        estimates = json.loads(path.read_text(encoding='utf-8'))['estimates']
        return {one['name']: float(one['value']) for one in estimates if one['name'].startswith(OF_SENSORS)}
    except (ValueError, LookupError, TypeError, AttributeError):
        raise InputError('report', str(path), 'as identify wrote it', 'identify again, or take it away') from None


def _estimate(one: Estimate) -> dict[str, Any]:
    return {**asdict(one), 'relative_change': one.value / one.start - 1.0 if one.start else math.nan}


def _channel(one: ChannelFit) -> dict[str, Any]:
    residuals = one.residuals
    return {'name': one.name, 'unit': one.unit, 'readings': len(one.times), 'begin': float(one.times[0]),
            'end': float(one.times[-1]), 'resolution': one.resolution, 'correlation_time': one.correlation_time,
            'rms': float(np.sqrt(np.mean(residuals**2))), 'largest': float(np.abs(residuals).max())}


def _friction(friction: KnownFriction) -> dict[str, Any]:
    bins = friction.bins
    return {
        'kinetic': _band('speed', friction.kinetic), 'static': _band('rest_time', friction.static),
        'accelerating': None if friction.accelerating is None else _band('speed', friction.accelerating),
        'measured': {'speed': bins.places.tolist(), 'median': bins.middles.tolist(),
                     'lower_quartile': bins.low.tolist(), 'upper_quartile': bins.high.tolist()},
        'break_aways': {'rest_time': friction.break_aways.places.tolist(),
                        'coefficient': friction.break_aways.values.tolist()},
    }


def _band(over: str, band: Band) -> dict[str, Any]:
    return {over: band.places.tolist(), 'coefficient': band.values.tolist(), 'half_width': band.half.tolist()}


def _plain(value: Any) -> Any:
    """Return values without numbers that JSON has no word for."""
    if isinstance(value, Mapping):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(item) for item in value]
    if isinstance(value, float) and not math.isfinite(value):
        return None if math.isnan(value) else str(value)
    return value.item() if isinstance(value, np.generic) else value
