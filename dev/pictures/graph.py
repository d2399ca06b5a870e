# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""The diagram of the node in its graph: topics, services, bag, replay and tool.  A test holds its names to the code."""

from .svg import BLUE, GREEN, GREY, INK, MONO, PALE, RED, Point, Sheet, Style

COMMANDS = ('drive_velocity', 'external_force', 'joint_commands')
SERVICES = ('~/step', '~/reset', '~/set_paused', '~/record', '~/inject_fault', '~/clear_faults')
REPORTS = ('slider_state', 'friction_force', 'mode_event', 'rig_event', 'joint_states', 'timing', 'run_info',
           '/diagnostics', '/clock')
OF_SCENES = ('simulate', 'sweep', 'critical', 'uncertainty', 'advise')
OF_RUNS = ('verify', 'check', 'compare', 'export')

_LEFT, _NODE, _RIGHT, _WIDTH = 20.0, 450.0, 940.0, 240.0
_NODE_WIDTH = 260.0
_NAME = Style(14.0, font=MONO)


def picture() -> Sheet:
    """Return the picture."""
    sheet = Sheet(1200, 640, 'The node, its topics and services, the bag and the tool')
    _scene(sheet)
    _node(sheet)
    _commands(sheet)
    _services(sheet)
    _reports(sheet)
    _bag(sheet)
    _replay(sheet)
    _tool(sheet)
    return sheet


def _scene(sheet: Sheet) -> None:
    _box(sheet, (_NODE, 20), (_NODE_WIDTH, 66), 'scene', ['a ROS 2 parameter file'], stroke=GREY)
    sheet.arrow((580, 86), (580, 122), color=GREY)
    sheet.arrow((710, 53), (1192, 53), (1192, 570), (1180, 570), color=GREY)
    sheet.text((950, 44), 'the same file', Style(14.0, 'middle', GREY))


def _node(sheet: Sheet) -> None:
    sheet.rect((_NODE, 122), (_NODE_WIDTH, 318), fill=PALE, radius=8)
    sheet.text((580, 150), 'feed_axis', Style(18.0, 'middle', font=MONO, weight='bold'))
    sheet.text((580, 172), 'the executable sim_node', Style(14.0, 'middle', GREY))
    stages = ('commands: checked, held', 'rig: limits, faults, encoders', 'axis: from event to event', 'messages out')
    for i, stage in enumerate(stages):
        y = 194 + 50 * i
        sheet.rect((475, y), (210, 32), stroke=GREY, radius=4)
        sheet.text((580, y + 21), stage, Style(14.0, 'middle'))
        if i + 1 < len(stages):
            sheet.arrow((580, y + 32), (580, y + 50), color=GREY, width=1.5)
    sheet.text((580, 400), 'a step each 1/rate: real time,', Style(13.0, 'middle', GREY))
    sheet.text((580, 418), 'lock-step or free run', Style(13.0, 'middle', GREY))


def _commands(sheet: Sheet) -> None:
    _box(sheet, (_LEFT, 122), (_WIDTH, 100), 'your controller', [
        'or ros2_control, a drive', 'program, ros2 topic pub'], stroke=BLUE)
    for i, name in enumerate(COMMANDS):
        y = 142 + 30 * i
        sheet.arrow((260, y), (_NODE, y), color=BLUE)
        sheet.text((352, y - 5), name, Style(14.0, 'middle', font=MONO))


def _services(sheet: Sheet) -> None:
    _box(sheet, (_LEFT, 248), (_WIDTH, 192), 'bench operator', [
        'steps, pauses, resets, records,', 'makes faults, sets parameters',
        '(ros2 service call, ros2 param)'], stroke=GREEN)
    for i, name in enumerate(SERVICES):
        y = 272 + 30 * i
        sheet.arrow((260, y), (_NODE, y), color=GREEN, both=True)
        sheet.text((352, y - 5), name, Style(14.0, 'middle', font=MONO))


def _reports(sheet: Sheet) -> None:
    _box(sheet, (_RIGHT, 122), (_WIDTH, 318), 'subscribers', [
        'your controller, ros2_control', 'PlotJuggler, Lichtblick', 'ros2 topic echo', 'health'], stroke=RED)
    for i, name in enumerate(REPORTS):
        y = 150 + 33 * i
        sheet.arrow((710, y), (_RIGHT, y), color=RED)
        sheet.text((820, y - 5), name, Style(14.0, 'middle', font=MONO))


def _bag(sheet: Sheet) -> None:
    _box(sheet, (_NODE, 510), (_NODE_WIDTH, 110), 'run folder', [
        'a ROS 2 bag: states, events,', 'commands as applied, scene,', 'versions, receipt'])
    sheet.arrow((620, 440), (620, 510))
    sheet.text((630, 480), 'records', Style(14.0))


def _replay(sheet: Sheet) -> None:
    _box(sheet, (_LEFT, 510), (_WIDTH, 110), 'replay_node', [
        'plays a run onto its topics,', 'or its commands into', 'a live axis'])
    sheet.arrow((_NODE, 565), (260, 565))
    sheet.arrow((200, 510), (200, 476), (520, 476), (520, 440), color=BLUE)
    sheet.text((360, 494), 'commands', Style(14.0, 'middle'))


def _tool(sheet: Sheet) -> None:
    _box(sheet, (_RIGHT, 510), (_WIDTH, 110), 'stickslip', ['the tool: needs no ROS graph'])
    for y, verbs in ((577, OF_SCENES[:3]), (594, OF_SCENES[3:]), (611, OF_RUNS)):
        sheet.text((1060, y), ' '.join(verbs), Style(12.0, 'middle', font=MONO))
    sheet.arrow((710, 548), (_RIGHT, 548), both=True)
    sheet.text((825, 541), ' '.join(OF_RUNS[:3]), Style(12.0, 'middle', font=MONO))
    sheet.text((825, 566), 'simulate --bag', Style(12.0, 'middle', font=MONO))


def _box(sheet: Sheet, corner: Point, size: Point, title: str, lines: list[str], stroke: str = INK) -> None:
    x, y = corner
    sheet.rect(corner, size, fill=PALE, stroke=stroke, radius=8)
    middle = x + size[0] / 2
    top = y + (27 if size[1] < 150 else (size[1] - 20 * len(lines)) / 2)   # a high box: in its middle
    sheet.text((middle, top), title, Style(17.0, 'middle', weight='bold'))
    for i, line in enumerate(lines):
        sheet.text((middle, top + 23 + 20 * i), line, Style(14.0, 'middle', GREY))
