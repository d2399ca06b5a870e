# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""A browser without a window, network off, driven over the DevTools protocol: a page from a file, real input events."""

import asyncio
import base64
import json
import shutil
import subprocess
from collections.abc import Callable
from functools import partial
from pathlib import Path
from typing import Any
from urllib.request import urlopen

from tornado.websocket import WebSocketClientConnection, websocket_connect

PROGRAM = next(filter(None, map(shutil.which, ('chromium', 'chromium-browser', 'google-chrome'))), None)
_QUIET = ('--headless', '--no-sandbox', '--disable-gpu', '--disable-quic', '--no-first-run', '--disable-sync',
          '--disable-background-networking', '--disable-component-update', '--remote-debugging-port=0',
          '--force-color-profile=srgb', '--hide-scrollbars')
_START, _ANSWER = 60.0, 60.0   # s
_KEYS = {'Enter': 13, 'Tab': 9, 'ArrowRight': 39, 'ArrowLeft': 37, 'Escape': 27}


class Browser:
    """One page; a context manager that ends the program."""

    def __init__(self, folder: Path, width: int = 1280, height: int = 900) -> None:
        profile = folder / 'profile'
        self._program = subprocess.Popen([str(PROGRAM), *_QUIET, f'--user-data-dir={profile}',
                                          f'--window-size={width},{height}', 'about:blank'],
                                         stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        self._loop, self._number, self.errors = asyncio.new_event_loop(), 0, list[str]()
        assert self._program.stderr is not None
        for line in self._program.stderr:
            if 'DevTools listening on ws://' in line:
                place = line.rpartition('ws://')[2].partition('/')[0]
                break
        else:
            raise RuntimeError('the browser ended at once')
        with urlopen(f'http://{place}/json', timeout=_START) as pages:
            address = next(page['webSocketDebuggerUrl'] for page in json.load(pages) if page['type'] == 'page')
        connect = partial(websocket_connect, address, max_message_size=2**28)   # a picture has megabytes
        self._socket: WebSocketClientConnection = self._wait(connect)
        for domain in ('Page', 'Runtime', 'Network'):
            self.send(f'{domain}.enable')
        self.size(width, height)

    def __enter__(self) -> 'Browser':
        return self

    def __exit__(self, *_: object) -> None:
        self._program.terminate()
        self._program.wait(timeout=_START)
        assert self._program.stderr is not None
        self._program.stderr.close()
        self._loop.close()

    def _wait(self, call: Callable[..., Any], *given: Any) -> Any:
        async def answer() -> Any:
            return await asyncio.wait_for(call(*given), _ANSWER)
        return self._loop.run_until_complete(answer())

    def send(self, method: str, **given: Any) -> dict[str, Any]:
        """Call a method; return its result.  Exceptions of the page that are told meanwhile are kept in `errors`."""
        self._number += 1
        self._wait(self._socket.write_message, json.dumps({'id': self._number, 'method': method, 'params': given}))
        while True:
            told = json.loads(self._wait(self._socket.read_message))
            if told.get('method') == 'Runtime.exceptionThrown':
                details = told['params']['exceptionDetails']
                self.errors.append(details.get('exception', {}).get('description', details['text']))
            if told.get('id') == self._number:
                assert 'error' not in told, told
                return dict(told['result'])

    def size(self, width: int, height: int, scale: float = 1.0, *, phone: bool = False) -> None:
        """Let the window have this size."""
        self.send('Emulation.setDeviceMetricsOverride', width=width, height=height, deviceScaleFactor=scale,
                  mobile=phone)

    def scheme(self, name: str) -> None:
        """Let the reader prefer `dark` or `light`, and motion reduced, so that pictures can be compared."""
        self.send('Emulation.setEmulatedMedia', features=[{'name': 'prefers-color-scheme', 'value': name},
                                                          {'name': 'prefers-reduced-motion', 'value': 'reduce'}])

    def open(self, address: str) -> None:
        """Open an address, with the network off, and wait until the page has begun."""
        self.send('Network.emulateNetworkConditions', offline=True, latency=0, downloadThroughput=0, uploadThroughput=0)
        self.send('Page.navigate', url='about:blank')
        self.send('Page.navigate', url=address)
        self.until('typeof explorer === "object" && explorer.opened > 0')

    def ask(self, expression: str) -> Any:
        """Return the value of an expression, of a promise when it is kept."""
        got = self.send('Runtime.evaluate', expression=expression, returnByValue=True, awaitPromise=True)
        assert 'exceptionDetails' not in got, got['exceptionDetails']
        return got['result'].get('value')

    def until(self, expression: str) -> None:
        """Wait until an expression is true, looked at in each frame."""
        for _ in range(2000):
            if self.ask(f'new Promise(go => setTimeout(() => go(Boolean({expression})), 10))'):
                return
        raise AssertionError(f'{expression} did not come true')

    def place(self, selector: str, share: float = 0.5) -> tuple[float, float]:
        """Return where an element is, scrolled into view: at a share of its width."""
        x, y = self.ask(f'(() => {{ const one = document.querySelector({json.dumps(selector)}); '
                        'one.scrollIntoView({block: "center"}); '
                        'const r = one.getBoundingClientRect(); '
                        f'return [r.x + r.width * {share}, r.y + r.height / 2]; }})()')
        return x, y

    def mouse(self, kind: str, x: float, y: float) -> None:
        """Let the mouse be moved, pressed or released at a place."""
        self.send('Input.dispatchMouseEvent', type=f'mouse{kind}', x=x, y=y, clickCount=1,
                  button='none' if kind == 'Moved' else 'left', buttons=0 if kind == 'Released' else 1)

    def click(self, selector: str, share: float = 0.5) -> None:
        """Click on an element."""
        for kind in ('Pressed', 'Released'):
            self.mouse(kind, *self.place(selector, share))

    def drag(self, selector: str, begin: float, end: float, steps: int = 8) -> None:
        """Drag over an element, from one share of its width to another."""
        x0, y = self.place(selector, begin)
        x1, _ = self.place(selector, end)
        self.mouse('Pressed', x0, y)
        for step in range(1, steps + 1):
            self.mouse('Moved', x0 + (x1 - x0) * step / steps, y)
            self.ask('new Promise(go => requestAnimationFrame(() => requestAnimationFrame(go)))')
        self.mouse('Released', x1, y)

    def key(self, name: str) -> None:
        """Press a key."""
        for kind in ('rawKeyDown', 'keyUp'):
            self.send('Input.dispatchKeyEvent', type=kind, key=name, code=name, windowsVirtualKeyCode=_KEYS[name])

    def write(self, selector: str, text: str) -> None:
        """Write a text into a field in place of what is there, and leave it."""
        self.click(selector)
        self.ask(f'document.querySelector({json.dumps(selector)}).select()')
        self.send('Input.insertText', text=text)
        self.key('Tab')

    def picture(self, path: Path | None = None, *, full: bool = False) -> bytes:
        """Return the picture of the page as PNG, and write it."""
        got = base64.b64decode(self.send('Page.captureScreenshot', captureBeyondViewport=full)['data'])
        if path is not None:
            path.write_bytes(got)
        return got
