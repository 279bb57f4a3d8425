"""Threads and processes: others run meanwhile, calls wait for each other, a fork is told."""

import os
import threading
import time

import pytest

import flowdlo
from conftest import SMALL, bits
from flowdlo import _core


class Ticking:
    """A thread that notes the time again and again, as often as it is let."""

    def __enter__(self):
        self.times = []
        self.done = threading.Event()
        self.thread = threading.Thread(target=self._tick)
        self.thread.start()
        return self

    def _tick(self):
        while not self.done.is_set():
            self.times.append(time.perf_counter())
            time.sleep(0.0005)

    def __exit__(self, *_):
        self.done.set()
        self.thread.join()


def ticks_within(work):
    """Ticks of another thread in the middle half of the time that `work` takes.

    A call that held the interpreter's lock would let none through.
    """
    with Ticking() as other:
        start = time.perf_counter()
        work()
        taken = time.perf_counter() - start
    return sum(start + taken / 4 < tick < start + 3 * taken / 4 for tick in other.times)


def test_the_measure_sees_a_lock_that_is_held():
    numbers = list(range(2_000_000))
    assert ticks_within(lambda: numbers.index(-1) if -1 in numbers else None) == 0


def test_other_threads_run_while_an_estimator_is_made():
    made = []
    found = max(
        ticks_within(lambda: made.append(_core.Estimator({"device": "cpu"}))) for _ in range(5)
    )
    assert found > 2


def test_other_threads_run_during_an_estimate(rose):
    core = _core.Estimator({"device": "cpu", "draws": 8, "threads": 1})
    camera = tuple(rose.intrinsics)
    found = max(
        ticks_within(lambda: core.estimate(rose.depth_m, rose.mask, camera, None, None)) for _ in range(3)
    )
    assert found > 5


def test_calls_on_one_estimator_wait_for_each_other(rose, estimator):
    expected = bits(estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics))
    found = []

    def work():
        for _ in range(3):
            found.append(bits(estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics)))

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [expected] * 12


def test_closing_waits_for_an_estimate(rose):
    estimator = flowdlo.Estimator(**SMALL)
    outcomes = []

    def work():
        try:
            while True:
                outcomes.append(estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics))
        except flowdlo.BadInput as error:
            outcomes.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    while not outcomes:
        time.sleep(0.001)
    estimator.close()
    thread.join(timeout=60)
    assert not thread.is_alive() and "closed" in str(outcomes[-1])


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork on this system")
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_a_forked_process_is_told_to_make_its_own(rose, estimator):
    estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics)
    child = os.fork()
    if child == 0:
        outcome = 1
        try:
            estimator.estimate(rose.depth_m, rose.mask, rose.intrinsics)
        except flowdlo.DeviceLost:
            outcome = 0
        finally:
            os._exit(outcome)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
