"""A Dask cluster as an executor: the machines of a SLURM queue, of Kubernetes, or of a cloud."""

from __future__ import annotations

import logging
import os
from collections.abc import Iterator
from concurrent.futures import CancelledError, Executor
from contextlib import contextmanager
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from erdctl.core.errors import ComputationProblem, UsageProblem

PATIENCE = 10  # seconds for a scheduler to answer
FEWEST = 64  # tasks in hand, also of a cluster that has yet to grow
GONE = "the cluster has gone"
EACH = 4  # tasks in hand for each thread, so that none waits for the next


@dataclass(frozen=True)
class Cluster:
    """A cluster that answered; see `cluster`."""

    client: Any

    @property
    def lost(self) -> tuple[type[BaseException], ...]:
        """What a future raises whose worker died again and again, or whose cluster has gone."""
        return CancelledError, import_module("distributed").KilledWorker

    def executor(self) -> Executor:
        """A new executor, whose end is not that of the cluster."""
        # Not "pure", by which equal calls would be one: a call is done when it is asked for.
        found: Executor = self.client.get_executor(pure=False)
        return found

    def shared(self, what: object) -> Any:
        """What many tasks need, sent to every worker once; as an argument a task gets it whole."""
        self.client.wait_for_workers(1)
        (found,) = self.client.scatter([what], broadcast=True, hash=False)
        return found

    def in_hand(self) -> int:
        """How many tasks to have there at a time: of a cluster that grows, more as it does."""
        try:
            threads = sum(self.client.nthreads().values())
        except OSError:
            raise ComputationProblem(f"{GONE}; what was done is kept: run it again") from None
        return max(FEWEST, EACH * int(threads))


@contextmanager
def cluster_or_none(address: str | None) -> Iterator[Cluster | None]:
    """The cluster of a scheduler where one is named; see `cluster`."""
    if address is None:
        yield None
        return
    with cluster(address) as found:
        yield found


@contextmanager
def cluster(address: str) -> Iterator[Cluster]:
    """The cluster of a Dask scheduler.

    address : of the scheduler, `tcp://HOST:PORT`, or the path of its scheduler file (`*.json`)
    Work that was lost with a worker is done again by Dask, elsewhere; what ends three workers in a
    row raises an error.
    Raises ComputationProblem where Dask is not installed or nobody answers, UsageProblem for a
    scheduler file that is not there.
    """
    try:
        distributed: Any = import_module("distributed")
    except ModuleNotFoundError as error:
        if error.name not in ("distributed", "dask"):
            raise  # it is there, but broken
        raise ComputationProblem(
            "--cluster needs the library distributed: pip install 'erdctl[cluster]'"
        ) from None
    is_file = address.endswith(".json")
    if is_file and not os.path.isfile(address):
        raise UsageProblem(f"--cluster {address}: no such scheduler file")
    # That a worker was lost is said by Dask in many lines, and it mends it.
    for name in [n for n in logging.root.manager.loggerDict if n.startswith("distributed")]:
        logging.getLogger(name).setLevel(logging.CRITICAL)
    try:
        where = {"scheduler_file": address} if is_file else {"address": address}
        client = distributed.Client(timeout=PATIENCE, set_as_default=False, **where)
    except (OSError, ValueError, TypeError) as error:
        reason = (str(error).splitlines() or [type(error).__name__])[0][:200]
        raise ComputationProblem(
            f"--cluster {address}: no Dask scheduler there: {reason}"
        ) from None
    with client:
        yield Cluster(client)
