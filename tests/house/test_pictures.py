# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The schematic pictures: the committed files are those that are made, and what they name is there."""

import re
from pathlib import Path
from xml.etree import ElementTree

import pytest

from dev.pictures import graph, rooms
from dev.pictures.__main__ import PICTURES
from dev.pictures.svg import Sheet, Style
from stickslip_sim.cli.main import stickslip
from stickslip_sim.recording import topics
from tests.support.repository import ROOT


@pytest.mark.parametrize('name', PICTURES)
class TestEach:
    def test_is_what_is_made(self, name: str) -> None:
        assert (ROOT / name).read_text(encoding='utf-8') == str(PICTURES[name]()), 'run `make pictures` and look'

    def test_is_xml_on_a_white_ground_with_all_text_inside(self, name: str) -> None:
        root = ElementTree.fromstring(str(PICTURES[name]()))
        *_, width, height = map(float, root.attrib['viewBox'].split())
        shapes = [element for element in root if element.tag.endswith('}rect')]
        assert shapes[0].attrib == {'width': f'{width:g}', 'height': f'{height:g}', 'fill': '#ffffff'}
        for text in (element for element in root if element.tag.endswith('}text')):
            left, right = _extent(text)
            assert 0 <= left < right <= width, ''.join(text.itertext())
            assert 0 < float(text.attrib['y']) < height

    def test_is_shown(self, name: str) -> None:
        pages = [ROOT / 'README.md', *(ROOT / 'docs').glob('*.md'), ROOT / 'CONTRIBUTING.md']
        assert any(Path(name).name in page.read_text(encoding='utf-8') for page in pages)


def _extent(text: ElementTree.Element) -> tuple[float, float]:
    """Return from where to where a text reaches at most, roughly."""
    long = 0.56 * float(text.attrib['font-size']) * len(''.join(text.itertext()))
    start = float(text.attrib['x']) - {'start': 0.0, 'middle': 0.5, 'end': 1.0}[text.get('text-anchor', 'start')] * long
    return start, start + long


class TestGraph:
    def test_names_every_topic(self) -> None:
        """All but that of parameters, which every node has."""
        every = {topic.name for topic in vars(topics).values() if isinstance(topic, topics.Topic)}
        assert {*graph.COMMANDS, *graph.REPORTS} == every - {topics.PARAMETER_EVENTS.name}

    def test_names_services_that_there_are(self) -> None:
        sources = (ROOT / 'stickslip_sim/stickslip_sim/ros').rglob('*.py')
        offered = {name for file in sources for name in re.findall(r"'(~/\w+)'", file.read_text(encoding='utf-8'))}
        assert set(graph.SERVICES) <= offered

    def test_names_verbs_that_there_are(self) -> None:
        assert {*graph.OF_SCENES, *graph.OF_RUNS} <= set(stickslip.commands)


class TestRooms:
    def test_every_room_is_there_and_says_what_it_is_for(self) -> None:
        package = ROOT / 'stickslip_sim/stickslip_sim'
        here = {place.stem for place in package.iterdir()
                if place.suffix == '.py' or (place / '__init__.py').is_file()} - {'__init__'}
        drawn = [room for floor in rooms.floors() for room in floor]
        assert {room.name for room in drawn} == here
        assert all(room.purpose for room in drawn)

    def test_doors_are_those_of_the_contracts(self) -> None:
        doors = {door: room.name for floor in rooms.floors() for room in floor for door in room.doors}
        assert doors['ROS'] == 'ros'
        assert doors['matplotlib'] == 'plots'


class TestSheet:
    def test_text_is_escaped_and_formulas_have_their_subscripts(self) -> None:
        sheet = Sheet(100, 100, 'a < b')
        sheet.text((1, 2), 'a < b & $F_{cd} + x$')
        root = ElementTree.fromstring(str(sheet))
        text = root[-1]
        assert ''.join(text.itertext()) == 'a < b & Fcd + x'
        low, = (span for span in text if span.text == 'cd')
        assert float(low.attrib['dy']) > 0
        assert sum(float(span.get('dy', 0)) for span in text) == pytest.approx(0)

    def test_a_paragraph_stays_within_its_width(self) -> None:
        sheet = Sheet(300, 300, '')
        below = sheet.paragraph((0, 10), 'one two three four five six seven eight nine ten', 100, Style(10.0))
        lines = [element.text or '' for element in ElementTree.fromstring(str(sheet)) if element.tag.endswith('text')]
        assert ' '.join(lines) == 'one two three four five six seven eight nine ten'
        assert max(map(len, lines)) <= Style(10.0).letters(100)
        assert below == pytest.approx(10 + 13 * len(lines))
