# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""Both packages as bloom reads them: package.xml, changelog and licence."""

import re

import docutils.core
import pytest
from catkin_pkg.changelog import get_changelog_from_path
from catkin_pkg.package import parse_package

from dev.changelog import PACKAGES, SOURCE, changelog, rst
from stickslip_sim.core.version import __version__
from tests.support.repository import ROOT

MARKDOWN = SOURCE.read_text(encoding='utf-8')


@pytest.mark.parametrize('name', PACKAGES)
def test_package_xml_has_what_a_release_asks_for(name: str) -> None:
    package = parse_package(ROOT / name)
    warnings: list[str] = []
    package.validate(warnings)
    assert warnings == []
    assert (package.name, package.version) == (name, __version__)
    assert package.authors
    assert package.maintainers
    assert sorted(url.type for url in package.urls) == ['bugtracker', 'repository', 'website']
    assert (ROOT / name / 'README.md').is_file()


@pytest.mark.parametrize('name', PACKAGES)
def test_the_licence_is_that_of_the_repository(name: str) -> None:
    """After a change: cp LICENSE stickslip_msgs/; cp LICENSE stickslip_sim/.  bloom takes no link out of a package."""
    [licence] = parse_package(ROOT / name).licenses
    assert (ROOT / name / licence.file).read_bytes() == (ROOT / 'LICENSE').read_bytes()


@pytest.mark.parametrize('name', PACKAGES)
def test_the_changelog_is_that_of_the_repository(name: str) -> None:
    """After a change: python3 -m dev.changelog."""
    assert (ROOT / name / 'CHANGELOG.rst').read_text(encoding='utf-8') == changelog(name, MARKDOWN)


@pytest.mark.filterwarnings('ignore:nodes.Node.traverse:DeprecationWarning')    # of docutils, which catkin_pkg calls
@pytest.mark.parametrize('name', PACKAGES)
def test_catkin_pkg_reads_the_changelog(name: str) -> None:
    found = get_changelog_from_path(ROOT / name, name)
    releases = {version: (f'{date:%Y-%m-%d}', content) for version, date, content in found.foreach_version()}
    assert {version: date for version, (date, _) in releases.items()} == dict(
        re.findall(r'^## (\d\S*) - (\S+)$', MARKDOWN, re.MULTILINE))
    assert all(content for _, content in releases.values())
    assert __version__ == [*releases][-1]    # bloom refuses to release another version than the newest


def text_of(markup: str) -> str:
    """Return what docutils reads, which finds no fault."""
    tree = docutils.core.publish_doctree(markup, settings_overrides={'report_level': 1, 'halt_level': 1})
    text: str = tree.astext()
    return ' '.join(text.split())


def test_the_changelog_loses_no_word() -> None:
    """Markdown without its marks, beside what docutils reads."""
    _, _, body = MARKDOWN.partition('## Unreleased\n')
    plain = re.sub(r'^## .*$|^#+ |^\* ', '', re.sub(r'\[([^\]]+)\]\([^)\s]+\)', r'\1', body), flags=re.MULTILINE)
    plain = re.sub(r'(`[^`]+`)|\*\*', lambda match: (match[1] or '').strip('`'), plain)
    read = text_of(changelog('stickslip_sim', MARKDOWN))
    read = re.sub(r' (Forthcoming|\d+\.\d+\.\d+ \([\d-]+\)) ', ' ', read.partition(' Forthcoming ')[2])
    assert read == ' '.join(plain.split())


@pytest.mark.parametrize(('markdown', 'expected'), [
    ('`a`s and `*`', '``a``\\ s and ``*``'),
    ('x`a`', 'x\\ ``a``'),
    ('**Use `a` now** (`b`).', '**Use** ``a`` **now** (``b``).'),
    ('**`a` and `b`**: c', '``a`` **and** ``b``: c'),
    ('wildcards `*` and `**`, **bold**', 'wildcards ``*`` and ``**``, **bold**'),
    ('mu_k, name_ and 2 * 3', 'mu_k, name\\_ and 2 \\* 3'),
    ('* see [the page](docs/a.md#b)\n  [`c`](d)', '* see the page\n  ``c``'),
    ('### Motion of `a`\n\n* b', '**Motion of** ``a``\n\n* b'),
])
def test_markup(markdown: str, expected: str) -> None:
    assert rst(markdown) == expected
    text_of(expected)


def test_a_changelog_without_a_release_is_refused() -> None:
    with pytest.raises(ValueError, match=r'CHANGELOG.md has no heading "## X.Y.Z - YYYY-MM-DD"'):
        changelog('stickslip_sim', '# Changelog\n')
