"""A study of 100,000 pairs by a scheduler and two workers, killed at random moments: rate, memory, bits.

    python tests/long/large_study.py FOLDER [--designs 100000] [--kills 10] [--seed 1]

Processes are of this machine, and only those that the command started are ended. It prints what the study
takes in this process, by one worker and by two, and whether the stores are the same bit for bit.
"""

import argparse
import hashlib
import json
import os
import random
import resource
import shutil
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import psutil
import xarray as xr

import pitchpoint as pp
from pitchpoint.analyses.design_batch import TOGETHER

PAIR: dict[str, Any] = {
    "gears": {
        "teeth": [23, 61],
        "module": "2 mm",
        "face_width": "18 mm",
        "profile_shift": [0.4, -0.2],
    },
    "lubricant": {"name": "pao-vg-150"},
    "roughness": {"ra": "0.4 um"},
    "operation": {"torque": "60 N m", "speed": "1200 rpm", "temperature": "50 degC"},
    "models": {"friction": ["iso_tr_14179_2"], "load_sharing": "sanchez_2017"},
}
OVER: dict[str, Any] = {
    "gears.profile_shift.1": (
        0.0,
        0.9,
    ),  # beyond some 1.65 tips are pointed: designs without figures
    "gears.face_width": ("12 mm", "24 mm"),
    "operation.torque": ("20 N m", "90 N m"),
    "operation.speed": ("500 rpm", "3000 rpm"),
}
WORKER = (
    *("--nthreads", "1", "--memory-limit", "0", "--death-timeout", "20"),
    *("--no-nanny", "--no-dashboard"),
)


def client(folder: str, designs: int, scheduler: str) -> None:
    """The study in a process of its own; what it took as a line of JSON."""
    begun = time.monotonic()
    pp.study(
        PAIR,
        OVER,
        "latin_hypercube",
        n=designs,
        seed=1,
        folder=folder,
        piece=_piece(designs),
        scheduler=scheduler or None,
    )
    used = resource.getrusage(resource.RUSAGE_SELF)
    told = {
        "wall": time.monotonic() - begun,
        "cpu": used.ru_utime + used.ru_stime,
        "peak": used.ru_maxrss / 1024.0,
    }
    print(json.dumps(told))


def _piece(designs: int) -> int:
    """Designs of a piece: a hundred pieces or more, of which the last ones weigh little."""
    return max(designs // 25600, 1) * TOGETHER


class Machines:
    """A scheduler and workers, those that were killed started again."""

    def __init__(self, workers: int) -> None:
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"
        self.scheduler: subprocess.Popen[bytes] | None = None
        self.workers: list[subprocess.Popen[bytes] | None] = [None] * workers
        self.ensure()

    def ensure(self) -> None:
        """Whatever does not run is started."""
        if self.scheduler is None or self.scheduler.poll() is not None:
            at = ("--host", "127.0.0.1", "--port", str(self.port), "--no-dashboard")
            self.scheduler = _dask("scheduler", *at)
            _await(self.port)
        for number, worker in enumerate(self.workers):
            if worker is None or worker.poll() is not None:
                self.workers[number] = _dask("worker", self.address, *WORKER)

    def cpu(self) -> tuple[float, float]:
        """Seconds of the processor of the scheduler and of the workers."""
        every = [_cpu(process) for process in (self.scheduler, *self.workers)]
        return every[0], sum(every[1:])

    def end(self) -> None:
        """End all that were started."""
        for process in (*self.workers, self.scheduler):
            if process is not None:
                process.kill()
                process.wait()


def _dask(what: str, *given: str) -> "subprocess.Popen[bytes]":
    command = [sys.executable, "-m", f"distributed.cli.dask_{what}", *given]
    quiet = subprocess.DEVNULL
    return subprocess.Popen(command, stdout=quiet, stderr=quiet)


def _await(port: int) -> None:
    for _ in range(600):
        with socket.socket() as tried:
            if tried.connect_ex(("127.0.0.1", port)) == 0:
                return
        time.sleep(0.1)
    raise SystemExit("the scheduler does not begin")


def _cpu(process: "subprocess.Popen[bytes] | None") -> float:
    if process is None or process.poll() is not None:
        return 0.0
    used = psutil.Process(process.pid).cpu_times()
    return float(used.user + used.system)


def _client(folder: Path, designs: int, address: str) -> "subprocess.Popen[bytes]":
    given = [str(folder), "--client", address, "--designs", str(designs)]
    command = [sys.executable, str(Path(__file__)), *given]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def timed(folder: Path, designs: int, machines: Machines | None) -> dict[str, float]:
    """What a whole study takes."""
    before = (0.0, 0.0) if machines is None else machines.cpu()
    process = _client(folder, designs, "" if machines is None else machines.address)
    out, error = process.communicate()
    if process.returncode:
        raise SystemExit(error.decode())
    told: dict[str, float] = json.loads(out)
    if machines is not None:
        told["scheduler"], told["workers"] = np.subtract(machines.cpu(), before).tolist()
    return told


def killed(
    folder: Path, designs: int, machines: Machines, kills: int, seed: int
) -> tuple[list[str], float]:
    """The study with kills at random moments, each time begun again: whom they hit, largest client [MB]."""
    peak = 0.0
    rng = random.Random(seed)
    whom = [("client", "worker", "scheduler")[number % 3] for number in range(kills)]
    rng.shuffle(whom)
    told: list[str] = []
    moments = sorted(rng.uniform(0.0, designs / _piece(designs)) for _ in whom)
    process = _client(folder, designs, machines.address)
    for victim, moment in [*zip(whom, moments, strict=True), ("", float("inf"))]:
        while process.poll() is None and len(_pieces(folder)) < moment:
            peak = max(peak, _memory(process))
            time.sleep(0.05)
        time.sleep(rng.uniform(0.0, 1.0))
        if process.poll() is None:
            told.append(f"{victim} with {len(_pieces(folder))} pieces")
            _kill(victim, process, machines, rng)
        error = process.stderr.read().decode() if process.poll() and process.stderr else ""
        if process.poll() == 0:
            break
        machines.ensure()
        if process.poll() is not None:
            if process.returncode > 0:
                told[-1] += f" [{error.strip().splitlines()[-1]}]"
            process = _client(folder, designs, machines.address)
    while process.wait():
        machines.ensure()
        process = _client(folder, designs, machines.address)
    return told, peak


def _memory(process: "subprocess.Popen[bytes]") -> float:
    """What a process has [MB]."""
    try:
        return float(psutil.Process(process.pid).memory_info().rss) / 2**20
    except psutil.Error:
        return 0.0


def _kill(
    victim: str, process: "subprocess.Popen[bytes]", machines: Machines, rng: random.Random
) -> None:
    chosen = {
        "client": process,
        "worker": rng.choice(machines.workers),
        "scheduler": machines.scheduler,
    }[victim]
    assert chosen is not None
    os.kill(chosen.pid, signal.SIGKILL)
    chosen.wait()
    if victim == "scheduler":
        process.wait()  # it says in a sentence that the scheduler is lost
        for worker in machines.workers:
            if worker is not None:
                worker.wait()  # without a scheduler they end, one that begins after its patience


def _pieces(folder: Path) -> list[Path]:
    return sorted(folder.glob("designs_*.nc"))


def digest(folder: Path) -> str:
    """Of names and contents of all files."""
    whole = hashlib.sha256()
    for path in sorted(folder.iterdir()):
        whole.update(path.name.encode() + path.read_bytes())
    return whole.hexdigest()[:16]


def each_once(folder: Path, designs: int) -> bool:
    """True where the pieces have every design, in order."""
    numbers = [xr.open_dataset(path, engine="h5netcdf").design.values for path in _pieces(folder)]
    return bool(np.array_equal(np.concatenate(numbers), np.arange(designs)))


def _show(name: str, told: dict[str, float]) -> None:
    print(name, " ".join(f"{key} {value:.1f}" for key, value in told.items()), flush=True)


def main() -> None:
    """All that the issue asks of a large study."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--designs", type=int, default=100_000)
    parser.add_argument("--kills", type=int, default=10)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--client", default=None)
    given = parser.parse_args()
    if given.client is not None:
        client(str(given.folder), given.designs, given.client)
        return
    root: Path = given.folder
    shutil.rmtree(root, ignore_errors=True)
    tenth = given.designs // 10
    for workers in (1, 2):
        machines = Machines(workers)
        try:
            _show(f"1000, {workers} workers:", timed(root / f"first{workers}", 1000, machines))
            share = workers * tenth
            _show(f"{share}, {workers} workers:", timed(root / f"share{workers}", share, machines))
            if workers == 2:
                more = given.kills, given.seed
                hit, peak = killed(root / "killed", given.designs, machines, *more)
                print(len(hit), "kills:", "; ".join(hit), f"; client {peak:.0f} MB", flush=True)
        finally:
            machines.end()
    _show(f"{tenth}, this process:", timed(root / "tenth", tenth, None))
    _show(f"{given.designs}, this process:", timed(root / "here", given.designs, None))
    stores = {name: digest(root / name) for name in ("here", "killed")}
    print("stores", stores, "the same" if len({*stores.values()}) == 1 else "DIFFER")
    print("each design once:", each_once(root / "killed", given.designs))


if __name__ == "__main__":
    main()
