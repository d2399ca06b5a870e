# Copyright 2026 The stickslip authors
# SPDX-License-Identifier: Apache-2.0
"""`--scheduler`: real Dask processes, one of which is killed in the middle; and the report when there are none."""

import importlib.util
import json
import os
import signal
import socketserver
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import closing, suppress
from pathlib import Path

import pytest

from stickslip_sim.cli.main import run
from stickslip_sim.study.folder import PARTIAL, POINTS_TABLE
from stickslip_sim.study.study import versions_of_a_study
from tests.support.tool import Capture, restore_interrupt

pytestmark = pytest.mark.slow

if importlib.util.find_spec('distributed') is None:   # not imported: it takes a third of a second
    pytest.skip('needs the extra cluster', allow_module_level=True)
LONG = ['sweep', 'paper_fig7', '--over', 'drive.velocity=1e-3:0.03:10000:log', '--duration', '15']   # five chunks
ABSENT = 'tcp://127.0.0.1:9'
_PATIENCE = 30.0   # s


def started(*arguments: str | Path, **environment: str) -> 'subprocess.Popen[str]':
    return subprocess.Popen([sys.executable, '-m', *map(str, arguments)], stdout=subprocess.PIPE, text=True,
                            stderr=subprocess.PIPE, start_new_session=True, env={**os.environ, **environment},
                            preexec_fn=restore_interrupt)


def wait_until(holds: Callable[[], object], what: str) -> None:
    end = time.monotonic() + _PATIENCE
    while not holds():
        assert time.monotonic() < end, what
        time.sleep(0.005)


class Cluster:
    """A scheduler and its workers, each a process as a user starts them."""

    def __init__(self, folder: Path) -> None:
        import distributed

        self.file = folder / 'scheduler.json'
        self.scheduler = started('dask', 'scheduler', '--host', '127.0.0.1', '--port', '0', '--no-dashboard',
                                 '--scheduler-file', self.file)
        self.workers: list[subprocess.Popen[str]] = []
        wait_until(lambda: self.file.exists() and self.file.stat().st_size, 'a scheduler')
        self.address = str(json.loads(self.file.read_text())['address'])
        self.client = distributed.Client(self.address, set_as_default=False)

    def need_worker(self) -> None:
        """Start a worker unless one is left of another test: to import what it needs takes a second or two."""
        if not self.client.scheduler_info()['workers']:
            self.add_worker()

    def add_worker(self, **environment: str) -> None:
        self.workers.append(started('dask', 'worker', '--scheduler-file', self.file, '--no-nanny', '--nthreads', '1',
                                    '--no-dashboard', '--name', str(len(self.workers)), **environment))
        self.client.wait_for_workers(len(self.workers), timeout=_PATIENCE)

    def is_at_work(self, worker: int) -> bool:
        """Return whether a worker has chunks to run."""
        addresses = {pid: address for address, pid in self.client.run(os.getpid).items()}
        return bool(self.client.processing().get(addresses.get(self.workers[worker].pid)))

    def end_workers(self) -> None:
        for process in self.workers:
            process.kill()
            process.communicate()
        self.workers.clear()
        wait_until(lambda: not self.client.scheduler_info()['workers'], 'a scheduler that knows it')

    def close(self) -> None:
        self.client.close()
        for process in (*self.workers, self.scheduler):
            process.kill()
            process.communicate()


@pytest.fixture(scope='module')
def shared_cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    with closing(Cluster(tmp_path_factory.mktemp('cluster'))) as one:
        yield one


@pytest.fixture
def cluster(shared_cluster: Cluster) -> Iterator[Cluster]:
    """A scheduler that goes on; its workers end with the test."""
    yield shared_cluster
    shared_cluster.end_workers()


def test_a_worker_without_this_package_is_reported(cluster: Cluster, tmp_path: Path, capsys: Capture) -> None:
    paths = os.pathsep.join(path for path in sys.path if path and not Path(path, 'stickslip_sim').exists())
    cluster.add_worker(PYTHONPATH=paths, PYTHONSAFEPATH='1')
    assert run([*LONG, '--scheduler', cluster.address, '--out', str(tmp_path / 'out')]) == 2
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert "No module named 'stickslip_sim'" in error
    assert not (tmp_path / 'out').exists()


def test_a_worker_with_other_versions_is_reported(cluster: Cluster, tmp_path: Path, capsys: Capture) -> None:
    cluster.add_worker(STICKSLIP_COMPILED='0')
    assert run([*LONG, '--scheduler', cluster.address, '--out', str(tmp_path / 'out')]) == 2
    assert f'hot_path plain python and not {versions_of_a_study()["hot_path"]}' in capsys.readouterr().err
    assert not (tmp_path / 'out').exists()


def test_a_scheduler_without_workers_gets_one_line_and_no_folder(cluster: Cluster, tmp_path: Path,
                                                                 capsys: Capture) -> None:
    out = tmp_path / 'out'
    assert run([*LONG, '--scheduler', cluster.address, '--out', str(out)]) == 2
    error = capsys.readouterr().err
    assert error.count('\n') == 1
    assert f'dask worker {cluster.address}' in error
    assert not out.exists()


@pytest.mark.parametrize('address', [ABSENT, 'nowhere', 'carrier-pigeon://coop:1', 'tls://127.0.0.1:9'])
def test_a_scheduler_that_is_not_there_gets_one_line_and_no_folder(address: str, tmp_path: Path,
                                                                   capfd: Capture) -> None:
    out = tmp_path / 'out'
    assert run([*LONG, '--scheduler', address, '--out', str(out)]) == 2
    error = capfd.readouterr().err
    assert error.count('\n') == 1, error
    assert error.startswith(f"stickslip: --scheduler = '{address}' is refused")
    assert not out.exists()


class Stranger(socketserver.BaseRequestHandler):
    """Says one thing to each caller, and nothing more."""

    answer = b''

    def handle(self) -> None:
        with suppress(OSError):
            self.request.sendall(self.answer)
            while self.request.recv(4096):
                pass


class Chatterer(Stranger):
    answer = b'HTTP/1.0 400 Bad Request\r\n\r\n'


@pytest.mark.parametrize('stranger', [Stranger, Chatterer])
def test_what_is_no_scheduler_gets_one_line_and_no_folder(stranger: type[Stranger], tmp_path: Path,
                                                          capfd: Capture) -> None:
    with socketserver.ThreadingTCPServer(('127.0.0.1', 0), stranger) as server:
        threading.Thread(target=server.serve_forever, kwargs={'poll_interval': 0.01}).start()
        address = f'tcp://127.0.0.1:{server.server_address[1]}'
        try:
            assert run([*LONG, '--scheduler', address, '--out', str(tmp_path / 'out')]) == 2
        finally:
            server.shutdown()
    error = capfd.readouterr().err
    assert error.count('\n') == 1, error
    assert error.startswith(f"stickslip: --scheduler = '{address}' is refused")
    assert not (tmp_path / 'out').exists()


def test_workers_and_a_scheduler_exclude_each_other(tmp_path: Path, capsys: Capture) -> None:
    assert run([*LONG, '--scheduler', ABSENT, '--workers', '2', '--out', str(tmp_path / 'out')]) == 2
    assert 'exclude each other' in capsys.readouterr().err


# Those that follow share their workers.


def test_a_worker_killed_in_the_middle_changes_no_bit_and_ctrl_c_keeps_what_is_done(shared_cluster: Cluster,
                                                                                    tmp_path: Path) -> None:
    cluster = shared_cluster
    cluster.add_worker()
    cluster.add_worker()
    out, alone = tmp_path / 'out', tmp_path / 'alone'
    process = started('stickslip_sim', *LONG, '--scheduler', cluster.address, '--out', out)
    wait_until(lambda: (out / PARTIAL).exists() and (out / PARTIAL).stat().st_size > 1000, 'the first chunk')
    wait_until(lambda: cluster.is_at_work(0), 'a worker at work')
    cluster.workers[0].send_signal(signal.SIGKILL)
    said, error = process.communicate(timeout=_PATIENCE)
    assert (process.returncode, error) == (0, ''), error
    assert '10000 of them run now' in said
    assert run([*LONG, '--out', str(alone)]) == 0
    whole = (alone / POINTS_TABLE).read_bytes()
    assert (out / POINTS_TABLE).read_bytes() == whole

    left = tmp_path / 'left'
    process = started('stickslip_sim', *LONG, '--scheduler', cluster.address, '--out', left)
    wait_until(lambda: (left / PARTIAL).exists() and (left / PARTIAL).stat().st_size > 1000, 'the first chunk')
    process.send_signal(signal.SIGINT)
    said, error = process.communicate(timeout=_PATIENCE)
    assert process.returncode == 130, error
    assert (said, error.count('\n')) == ('', 1)
    rows = (left / PARTIAL).read_bytes()
    assert whole.startswith(rows)
    assert rows.count(b'\n') % 2000 == 1
    wait_until(lambda: not cluster.is_at_work(1), 'a worker that is free again')


def test_closed_loops_on_a_cluster_have_the_bytes_of_one_process(shared_cluster: Cluster, tmp_path: Path) -> None:
    controller, limits = tmp_path / 'own.py', tmp_path / 'limits.yaml'
    controller.write_text('class Own:\n    def __init__(self, gain=5.0):\n        self.gain = gain\n'
                          '    def __call__(self, t, measured):\n'
                          '        return self.gain * (1e-4 - measured.slider_position)\n')
    limits.write_text('limits: {peak_speed: {max: 1.0}}\n')
    command = ['close-loop', f'{controller}:Own', '--scene', 'positioning', '--duration', '0.1', '--gain',
               'gain=2:20:3', '--over', 'friction.scale=0.8:1.2:4', '--limits', str(limits)]
    shared_cluster.need_worker()
    assert run([*command, '--scheduler', shared_cluster.address, '--out', str(tmp_path / 'out')]) == 0
    assert run([*command, '--out', str(tmp_path / 'alone')]) == 0
    tables = [(tmp_path / name / POINTS_TABLE).read_bytes() for name in ('out', 'alone')]
    assert tables[0] == tables[1]
    assert tables[0].count(b'\n') >= 12


def test_a_scheduler_that_goes_is_reported(shared_cluster: Cluster, tmp_path: Path) -> None:
    """The last one that uses it."""
    out = tmp_path / 'out'
    shared_cluster.need_worker()
    process = started('stickslip_sim', *LONG, '--scheduler', shared_cluster.address, '--out', out,
                      DASK_DISTRIBUTED__COMM__TIMEOUTS__CONNECT='1s')
    wait_until(lambda: (out / PARTIAL).exists() and (out / PARTIAL).stat().st_size > 1000, 'the first chunk')
    shared_cluster.scheduler.kill()
    said, error = process.communicate(timeout=_PATIENCE)
    assert process.returncode == 1
    assert (said, error.count('\n')) == ('', 1), error
    assert f'the scheduler {shared_cluster.address} is gone' in error
    assert '--resume' in error
