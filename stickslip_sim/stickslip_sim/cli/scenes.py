# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`stickslip scenes`: the scenes that come with the package."""

import click


@click.command()
def scenes() -> None:
    """List the shipped scenes, one line each."""
    from ..inputs import load_scene
    from ..scene import scene_names

    names = scene_names()
    width = max(map(len, names))
    for name in names:
        print(f'{name:{width}}  {load_scene(name).summary}')
