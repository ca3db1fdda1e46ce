"""Ctrl-C, worker processes and threads."""

import multiprocessing
import os
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import prtkit
from conftest import table_scene

LONG = """
import sys, threading, prtkit
from conftest import table_scene
model = prtkit.from_arrays(*table_scene())
print('ready', flush=True)
try:
    prtkit.bake(model, order=6, rays=1 << 24)
except KeyboardInterrupt:
    print('interrupted', threading.active_count())
print(prtkit.bake(model, order=2, rays=16).transfer.shape)
"""


def test_ctrl_c_raises_keyboard_interrupt():
    child = subprocess.Popen(
        [sys.executable, "-c", LONG],
        cwd=os.path.dirname(__file__),
        env=os.environ,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert child.stdout.readline() == "ready\n"
    time.sleep(1)
    begin = time.monotonic()
    child.send_signal(signal.SIGINT)
    output, _ = child.communicate(timeout=60)
    assert output.splitlines() == ["interrupted 1", "(7, 4)"] and child.returncode == 0
    assert time.monotonic() - begin < 20


def work(seed):
    return prtkit.compute_prt(*table_scene(), n=8, seed=seed, threads=1)


def test_forked_workers_bake():
    expected = work(3)  # the parent has used its threads before
    prtkit.compute_prt(*table_scene(), n=20)
    with multiprocessing.get_context("fork").Pool(32) as pool:
        results = pool.map(work, [3] * 32)
    for result in results:
        np.testing.assert_array_equal(result, expected)


def test_threads_bake_at_once():
    results = [None] * 4

    def bake(i):
        results[i] = prtkit.compute_prt(*table_scene(), n=8, seed=1)

    threads = [threading.Thread(target=bake, args=(i,)) for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for result in results:
        np.testing.assert_array_equal(result, results[0])


def test_import_starts_no_threads():
    code = "import prtkit, os; print(len(os.listdir('/proc/self/task')))"
    count = subprocess.run(
        [sys.executable, "-c", code],
        check=True,
        capture_output=True,
        text=True,
        env={**os.environ, "OPENBLAS_NUM_THREADS": "1"},
    )
    assert count.stdout == "1\n"
