#!/usr/bin/env python3
"""Computes the shards of a sweep with HyperQueue and joins them.

    python3 hyperqueue_sweep.py sweep.toml results.csv --shards 8

Without --server-dir a server and --workers workers are started on this machine, for as long as it takes. A shard that
fails is submitted again and goes on from the rows it has, and so does everything when this program is run again.
"""

import argparse
import os
import subprocess
import sys
from contextlib import ExitStack
from pathlib import Path

from hyperqueue import Client, Job
from hyperqueue.cluster import LocalCluster, WorkerConfig

# How often a shard is tried.
ATTEMPTS = 3


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("spec", type=Path)
    parser.add_argument("results", type=Path)
    parser.add_argument("--shards", type=int, default=8)
    parser.add_argument("--workers", type=int, default=2, help="on this machine, one core each")
    parser.add_argument("--server-dir", type=Path, help="of a server that runs elsewhere")
    return parser.parse_args()


def connect(stack, given):
    """A client of the server that runs, or of one that is started here."""
    if given.server_dir:
        return Client(given.server_dir)
    cluster = stack.enter_context(LocalCluster())
    for _ in range(given.workers):
        cluster.start_worker(WorkerConfig(cores=1))
    return cluster.client()


def main():
    given = arguments()
    pulloff = os.environ.get("PULLOFF", "pulloff")
    folder = Path(f"{given.results}.parts").resolve()
    folder.mkdir(parents=True, exist_ok=True)
    parts = {f"{n}/{given.shards}": folder / f"{n}-of-{given.shards}.csv" for n in range(1, given.shards + 1)}

    def job():
        # One failed shard must not cancel the others.
        job = Job(max_fails=None, name="pulloff-sweep")
        for shard, part in parts.items():
            command = [pulloff, "sweep", given.spec.resolve(), "-o", part, "--shard", shard, "--jobs", "1"]
            # What a lost worker ran may still be running.
            command.append("--wait")
            job.program([str(word) for word in command], stdout=None, stderr=f"{part}.log", cwd=str(folder))
        return job

    with ExitStack() as stack:
        client = connect(stack, given)
        # A shard that is complete already costs nothing.
        done = any(client.wait_for_jobs([client.submit(job())], raise_on_error=False) for _ in range(ATTEMPTS))
    if not done:
        sys.exit(f"not all shards came to their end: see {folder}/*.log")
    merge = [pulloff, "sweep", "merge", *map(str, parts.values()), "-o", str(given.results), "--overwrite"]
    sys.exit(subprocess.run(merge, check=False).returncode)


if __name__ == "__main__":
    main()
