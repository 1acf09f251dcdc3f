"""Pieces of a study by workers of `dask.distributed`, on this machine or under a scheduler anywhere."""

import logging
import socket
import subprocess
import sys
from collections.abc import Collection, Generator, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from itertools import islice
from time import monotonic, sleep
from typing import TYPE_CHECKING, Any

from pitchpoint.errors import InputError, PitchpointError, shorten
from pitchpoint.input.quantities import shown
from pitchpoint.results.pieces import StudyPieces
from pitchpoint.runs.described import StudyDescription, piece_elsewhere

if TYPE_CHECKING:
    from distributed import Client, Future

__all__ = ["pieces_of_workers"]

PATIENCE = 10.0
"""Seconds after which a scheduler that does not answer is not there."""

START = 60.0
"""Seconds in which the first worker is there, with its imports on a busy machine."""

AHEAD = 2
"""Pieces that a thread of a worker has at once: the one that it computes, and the next one."""

GOES_ON = "pieces that are kept stay; the same command goes on from them"


def pieces_of_workers(
    study: StudyDescription,
    pieces: StudyPieces,
    missing: Sequence[int],
    workers: int | None,
    scheduler: str | None,
) -> Generator[tuple[int, bytes], None, None]:
    """Numbers and files of pieces in the order in which they are computed.

    Args:
        study: its description, which is all that a worker is sent.
        pieces: ranges of designs.
        missing: numbers of those that are computed.
        workers: processes of this machine.
        scheduler: the address of one in their place.

    Raises:
        InputError: no such scheduler, no workers, or one whose numbers would be others.
        PitchpointError: the scheduler or too many workers were lost.
    """
    with _client(workers, scheduler) as client:
        yield from _landing(client, study, pieces, missing)


@contextmanager
def _client(workers: int | None, scheduler: str | None) -> "Iterator[Client]":
    _demand_distributed()
    with _quiet():
        if scheduler is not None:
            with _connected(scheduler) as client:
                yield client
        else:
            with _local(workers or 1) as client:
                yield client


def _demand_distributed() -> None:
    try:
        import distributed  # noqa: F401
    except ImportError:
        raise InputError(
            "workers and schedulers need dask.distributed, which is not installed: "
            "pip install 'pitchpoint[distributed]'; without them this process computes the same"
        ) from None


@contextmanager
def _quiet() -> "Iterator[None]":
    """Keep what `distributed` logs of lost connections from standing before the sentence about them."""
    # Its configuration gives levels of their own to some below the first one.
    every = [name for name in logging.root.manager.loggerDict if name.startswith("distributed.")]
    logs = [logging.getLogger(name) for name in ("distributed", *every)]
    before = [log.level for log in logs]
    for log in logs:
        log.setLevel(logging.CRITICAL)
    try:
        yield
    finally:
        for log, level in zip(logs, before, strict=True):
            log.setLevel(level)


@contextmanager
def _connected(address: str) -> "Iterator[Client]":
    from distributed import Client

    _demand_answer(address)
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except OSError:
        told = (
            f"what answers at {shown(address)} is no scheduler, or one of another version of dask"
        )
        raise InputError(told, key="scheduler") from None
    try:
        _demand_workers(client, f"`dask worker {address} --nthreads 1` starts one")
        yield client
    finally:
        with suppress(Exception):  # whose scheduler may be gone
            client.close(timeout=PATIENCE)


def _demand_answer(address: str) -> None:
    """InputError where nobody listens, before a client waits for what never comes."""
    from distributed.comm.addressing import get_address_host_port

    try:
        host, port = get_address_host_port(address, strict=True)
        socket.create_connection((host, port), PATIENCE).close()
    # "inproc" addresses have no host and port, which distributed says by NotImplementedError.
    except (OSError, ValueError, TypeError, NotImplementedError) as error:
        why = (
            error.strerror or "no answer" if isinstance(error, OSError) else shorten(str(error), 80)
        )
        raise InputError(
            f"no scheduler at {shown(address)}: {why}; `dask scheduler` starts one and tells its address",
            key="scheduler",
        ) from None


def _demand_workers(client: "Client", otherwise: str) -> None:
    try:
        client.wait_for_workers(1, timeout=START)
    except TimeoutError:
        raise InputError(f"the scheduler has no worker; {otherwise}", key="scheduler") from None


@contextmanager
def _local(workers: int) -> "Iterator[Client]":
    """Workers as processes of this machine under a scheduler in this one; they end with it.

    They are started by their command: processes that Python spawns would run a user's script again.
    """
    from distributed import Client, LocalCluster

    with (
        LocalCluster(
            n_workers=0,
            protocol="tcp://",
            host="127.0.0.1",
            dashboard_address="127.0.0.1:0",
            processes=False,
        ) as cluster,
        _processes(cluster.scheduler_address, workers),
        Client(cluster, set_as_default=False) as client,
    ):
        _demand_workers(client, "its processes end before they begin")
        yield client


@contextmanager
def _processes(address: str, workers: int) -> Iterator[None]:
    command = [sys.executable, "-m", "distributed.cli.dask_worker", address, *_OF_WORKERS]
    running = [
        subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        for _ in range(workers)
    ]
    try:
        yield
    finally:
        for process in running:
            process.terminate()
        for process in running:
            process.wait()


_OF_WORKERS = (
    *("--nthreads", "1"),
    *("--memory-limit", "0"),  # of the machine, as for this process
    *("--death-timeout", "60"),
    "--no-dashboard",
    "--no-nanny",
)


def _landing(
    client: "Client", study: StudyDescription, pieces: StudyPieces, missing: Sequence[int]
) -> Generator[tuple[int, bytes], None, None]:
    """Pieces as they come; no more are asked for than keep the workers busy."""
    left, asked = iter(missing), dict[Any, int]()
    seen = monotonic()
    while True:
        with _reachable():
            threads = sum(client.nthreads().values())
            seen = monotonic() if threads else seen
            if monotonic() - seen > START:
                raise PitchpointError(
                    f"the scheduler has had no worker for {START:.0f} s; {GOES_ON}"
                )
            room = AHEAD * max(threads, 1) - len(asked)
            for number in islice(left, max(room, 0)):
                asked[_submitted(client, study, pieces, number)] = number
        if not asked:
            return
        done = _finished(asked)
        for future in done:
            number = asked.pop(future)
            yield number, _image(future, pieces.range(number), study.decisive)
            future.release()


@contextmanager
def _reachable() -> Iterator[None]:
    """PitchpointError where the scheduler is lost."""
    from distributed import CancelledError

    try:
        yield
    except (OSError, CancelledError):
        raise PitchpointError(f"the scheduler was lost; {GOES_ON}") from None


def _submitted(
    client: "Client", study: StudyDescription, pieces: StudyPieces, number: int
) -> "Future[Any]":
    return client.submit(
        piece_elsewhere,
        study.packed,
        study.mark,
        *pieces.range(number),
        key=f"{study.mark}-{number}",  # two of one name are one to the scheduler
        priority=-number,
    )


def _finished(asked: Collection["Future[Any]"]) -> "list[Future[Any]]":
    """Those that are done, as soon as there are some, or after a second."""
    for _ in range(20):
        if done := [future for future in asked if future.done()]:
            return done
        sleep(0.05)
    return []


def _image(future: "Future[Any]", designs: tuple[int, int], decisive: Mapping[str, str]) -> bytes:
    """The file that a worker made of a piece."""
    with _reachable():
        failure = future.exception()
    if failure is not None:
        raise _of_worker(failure, f"designs {designs[0]} to {designs[1] - 1}") from None
    with _reachable():
        made = future.result()
    if isinstance(made, dict):
        raise InputError(_other(made, decisive), key="scheduler")
    return bytes(made)


def _of_worker(failure: BaseException, designs: str) -> BaseException:
    """What a worker that failed is told as; errors that are none of its own stay what they are."""
    from distributed import KilledWorker

    if isinstance(failure, KilledWorker):
        return PitchpointError(f"several workers ended while they computed {designs}; {GOES_ON}")
    if isinstance(failure, OSError):
        return PitchpointError(f"a worker that computed {designs} failed: {failure}; {GOES_ON}")
    # Another version has no such function, or one that takes other arguments.
    called = any(name in str(failure) for name in ("pitchpoint", piece_elsewhere.__name__))
    if isinstance(failure, ImportError | AttributeError | TypeError) and called:
        why = shorten(str(failure), 120)
        return InputError(
            f"a worker has no pitchpoint, or another version of it: {why}", key="scheduler"
        )
    return failure


def _other(theirs: Mapping[str, str], here: Mapping[str, str]) -> str:
    """What a worker has that gives other bits than this process."""
    differ = [name for name in here if here[name] != theirs.get(name)]
    if not differ:
        return "a worker does not have the files that the case names"
    listed = (f"{name} {theirs.get(name) or 'none'} for {here[name] or 'none'}" for name in differ)
    return f"a worker has what gives other numbers than here: {', '.join(listed)}"
