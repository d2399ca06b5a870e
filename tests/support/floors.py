# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The floors of a package, as the contracts of import-linter list them in pyproject.toml."""

import re

from .repository import ROOT


def floors(package: str) -> list[list[str]]:
    """Return what stands on each floor of a package, from the top floor down."""
    text = (ROOT / 'pyproject.toml').read_text(encoding='utf-8')
    (layers,) = re.findall(rf'^containers = \["{package}"\]\nexhaustive = true\nlayers = \[\n(.*?)^\]', text,
                           re.MULTILINE | re.DOTALL)
    return [re.findall(r'\w+', layer) for layer in re.findall(r'"(.*?)"', layers)]
