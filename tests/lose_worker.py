#!/usr/bin/env python3
"""Computes a sweep as examples/cluster/hyperqueue_sweep.py does, and half-way the server loses one of its two workers.

    PULLOFF=PROGRAM python3 lose_worker.py killed|running SPEC.toml RESULTS.csv --shards 8

The workers of a local cluster are threads of this process, so none can be killed alone. But to the server a worker is
lost when its connection breaks, and that is done here: then what the worker ran is killed with it (`killed`), or goes on
where nobody hears of it (`running`), while the server starts the same shard on the other worker.

Fails if no worker was lost, or nothing that it ran was started again.
"""

import json
import os
import signal
import socket
import stat
import sys
import tempfile
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent.parent / "examples" / "cluster"))
import hyperqueue_sweep  # noqa: E402

# Every start of a task stands in the file behind it: its shard, how often it was begun before, the way to its worker.
# Out of its worker's process group a task outlives the worker.
WRAPPER = """#!/bin/sh
[ -z "$HQ_TASK_ID" ] || echo "$HQ_TASK_ID $HQ_INSTANCE_ID ${{HQ_ACCESS_KEY%%:*}}" >>'{starts}'
{run}
"""
RUN = {"killed": "exec '{program}' \"$@\"", "running": "setsid '{program}' \"$@\" &\nwait $!"}
# In seconds.
PATIENCE = 120
# With so many rows a shard is half-way.
ROWS = 20


def starts(file):
    """Each start so far: shard, how often it was begun before, worker."""
    if not file.exists():
        return []
    words = (line.split() for line in file.read_text().splitlines())
    return [(int(shard), int(before), worker) for shard, before, worker in words]


def offspring(pid):
    """All processes below this one."""
    below = []
    for children in Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            below += map(int, children.read_text().split())
        except OSError:
            continue
    return below + [further for child in below for further in offspring(child)]


def under_way(program):
    """The tasks that the workers run and that have some rows, by their process: the file of the results."""
    found = {}
    for pid in offspring(os.getpid()):
        try:
            if Path(f"/proc/{pid}/exe").resolve() != program:
                continue
            words = Path(f"/proc/{pid}/cmdline").read_text().split("\0")
            part = Path(words[words.index("-o") + 1])
            if part.read_text().count("\n") > ROWS:
                found[pid] = part
        except (OSError, ValueError):
            continue
    return found


def connections(cluster):
    """The server's ends of the connections of its workers, by the address of the worker's end."""
    access = Path(cluster.cluster.server_dir, "hq-current", "access.json")
    port = json.loads(access.read_text())["worker"]["port"]
    found = {}
    for descriptor in os.listdir("/proc/self/fd"):
        try:
            if not stat.S_ISSOCK(os.stat(f"/proc/self/fd/{descriptor}").st_mode):
                continue
            end = socket.socket(fileno=os.dup(int(descriptor)))
            if end.family in (socket.AF_INET, socket.AF_INET6) and end.getsockname()[1] == port:
                found[end.getpeername()] = end
        except OSError:
            # Closed meanwhile, or the one that listens.
            continue
    return found


def until(what, found):
    """Waits until there is something."""
    deadline = time.monotonic() + PATIENCE
    while not (value := found()):
        if time.monotonic() > deadline:
            sys.exit(f"lose_worker.py: {what}")
        time.sleep(0.02)
    return value


def resume(pid):
    try:
        os.kill(pid, signal.SIGCONT)
    except ProcessLookupError:
        pass


def two_stopped(program):
    """The two tasks that are half-way, stopped, so that they cannot come to their end; nothing if there are no two."""
    tasks = under_way(program)
    if len(tasks) == 2:
        for pid in tasks:
            os.kill(pid, signal.SIGSTOP)
        if under_way(program) == tasks:
            return tasks
        for pid in tasks:
            resume(pid)
    return {}


def lose_a_worker(cluster, program, outcome):
    """Waits until both workers are half-way through a shard, and breaks the connection of one of them."""
    tasks = until("two shards never ran at once", lambda: two_stopped(program))
    try:
        ends = list(connections(cluster).values())
        assert len(ends) == 2, ends
        ends[0].shutdown(socket.SHUT_RDWR)
        gone = until("no task lost its worker", lambda: set(tasks) - set(under_way(program)))
        assert len(gone) == 1, gone
        [lost] = gone
        for pid in set(tasks) - gone:
            resume(pid)
        if outcome == "running":
            assert Path(f"/proc/{lost}/exe").resolve() == program, "it does not go on"
            log = Path(f"{tasks[lost]}.log")
            until("its shard was not started again beside it", lambda: "waiting for it to end" in log.read_text())
    finally:
        for pid in tasks:
            resume(pid)


def main():
    outcome, program = sys.argv.pop(1), Path(os.environ["PULLOFF"]).resolve()
    with tempfile.TemporaryDirectory() as folder:
        log, wrapper = Path(folder, "starts"), Path(folder, "pulloff")
        wrapper.write_text(WRAPPER.format(starts=log, run=RUN[outcome].format(program=program)))
        wrapper.chmod(0o755)
        os.environ["PULLOFF"] = str(wrapper)

        class Breaking(hyperqueue_sweep.LocalCluster):
            def client(self):
                client = super().client()
                submit = client.submit

                def submit_and_break(job):
                    submitted = submit(job)
                    if all(before == 0 for _, before, _ in starts(log)):
                        lose_a_worker(self, program, outcome)
                    return submitted

                client.submit = submit_and_break
                return client

        hyperqueue_sweep.LocalCluster = Breaking
        try:
            hyperqueue_sweep.main()
        except SystemExit as end:
            if end.code:
                raise
        again = [(shard, worker) for shard, before, worker in starts(log) if before > 0]
        lost = {worker for shard, before, worker in starts(log) if before == 0 and shard in dict(again)}
        if len(again) != 1 or len(lost) != 1 or again[0][1] in lost:
            sys.exit(f"lose_worker.py: not one shard was started again on the other worker: {starts(log)}")
        if len({shard for shard, _, _ in starts(log)}) != len(starts(log)) - 1:
            sys.exit(f"lose_worker.py: a shard failed and was submitted again: {starts(log)}")
        if starts(log)[-1][1] == 0 and starts(log)[-1][2] in lost:
            sys.exit(f"lose_worker.py: the lost worker went on: {starts(log)}")
        print(f"lose_worker.py: shard {again[0][0] + 1} of a lost worker was started again on the other one")


if __name__ == "__main__":
    main()
