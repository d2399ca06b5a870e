# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Recordings of a node, without the node: into which folder they go, and what is read before."""

from pathlib import Path

import pytest

from stickslip_sim.inputs import load_scene
from stickslip_sim.recording import open_bag, schema
from stickslip_sim.recording.recordings import Recordings
from stickslip_sim.recording.stamped_folder import stamped_folder


@pytest.mark.parametrize('ending', ['/', '//', '/.'])
def test_a_folder_as_a_shell_completes_it(tmp_path: Path, ending: str) -> None:
    scene = load_scene('paper_fig8', {'record.folder': f'{tmp_path}/runs/first{ending}'})
    recordings = Recordings('/', scene)
    recordings.begin(scene)
    recordings.end({})
    assert open_bag(tmp_path / 'runs' / 'first').is_complete


def test_no_message_definition_is_read_while_the_axis_runs(tmp_path: Path) -> None:
    """It takes longer than a step."""
    scene = load_scene('paper_fig8', {'record.folder': f'{tmp_path}/runs/first'})
    recordings = Recordings('/', scene)
    schema.cache_clear()
    recordings.prepare()
    read = schema.cache_info().misses
    recordings.begin(scene)
    recordings.end({})
    assert schema.cache_info().misses == read > 0


def test_folders_of_one_second_have_numbers(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also where a link to nowhere has the name."""
    monkeypatch.setattr('time.gmtime', lambda: (2026, 3, 1, 12, 0, 7, 6, 60, 0))
    (tmp_path / 'axis_20260301T120007Z').mkdir()
    (tmp_path / 'axis_20260301T120007Z_2').symlink_to(tmp_path / 'nowhere')
    assert stamped_folder(tmp_path, 'axis') == tmp_path / 'axis_20260301T120007Z_3'
    assert stamped_folder(tmp_path, 'mill') == tmp_path / 'mill_20260301T120007Z'
