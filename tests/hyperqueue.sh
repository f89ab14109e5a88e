#!/usr/bin/env bash
# Shards of a sweep on a local HyperQueue cluster with two workers, tasks and workers lost half-way: the result must be that of a
# single run, to the byte. Takes the program to test; needs python3 with venv, and pip must find hyperqueue.
set -euo pipefail
pulloff=$(realpath "$1")
tests=$(realpath "$(dirname "$0")")
cluster=$tests/../examples/cluster
work=$(mktemp -d)
started=
cleanup() {
    # Its own session: the server, its workers and what they run.
    [ -z "$started" ] || kill -KILL -- "-$started" 2>/dev/null || true
    rm -rf "$work"
}
trap cleanup EXIT

if ! { python3 -m venv "$work/venv" && "$work/venv/bin/pip" install --quiet hyperqueue; } >"$work/pip.log" 2>&1; then
    echo "hyperqueue.sh: NOT RUN, hyperqueue cannot be installed:" >&2
    tail -n 3 "$work/pip.log" >&2
    exit 0
fi
export PULLOFF=$pulloff HOME=$work XDG_CONFIG_HOME=$work
cd "$work"
# The example with more rows: a shard must take long enough for two to run at once.
spec=$work/sweep.toml
sed 's/count = 40/count = 160/' "$cluster/sweep.toml" >"$spec"
"$pulloff" sweep "$spec" -o whole.csv

same() {
    cmp whole.csv "$1" && cmp whole.csv.spec.toml "$1.spec.toml" && echo "hyperqueue.sh: $2"
}

# Starts the cluster in a session of its own.
start() {
    setsid "$work/venv/bin/python" "$cluster/hyperqueue_sweep.py" "$spec" "$1" --shards 8 \
        >>"$1.log" 2>&1 &
    started=$!
}
# Waits until the parts of $1 have so many lines together.
rows() {
    local deadline=$((SECONDS + 120))
    until [ "$(cat "$1".parts/*.csv 2>/dev/null | wc -l)" -ge "$2" ]; do
        [ $SECONDS -lt $deadline ] || { echo "hyperqueue.sh: no rows" >&2; cat "$1.log" >&2; exit 1; }
        sleep 0.02
    done
}
# What the cluster's workers are running.
tasks() {
    local child
    for child in $(cat "/proc/$started"/task/*/children); do
        [ "$(readlink "/proc/$child/exe")" != "$pulloff" ] || echo "$child"
    done
}

# What one worker runs is killed half-way; the shard is submitted again and goes on.
start one.csv
rows one.csv 300
until victim=$(tasks | sed -n 1p) && [ -n "$victim" ] && kill -KILL "$victim" 2>/dev/null; do
    [ ! -e one.csv ] || { echo 'hyperqueue.sh: no task to kill' >&2; exit 1; }
done
wait "$started"
started=
same one.csv 'a task killed half-way: equal to the single run'

# One of the two workers is lost half-way: what it runs ends with it, or goes on while the shard is started again.
for outcome in killed running; do
    "$work/venv/bin/python" "$tests/lose_worker.py" "$outcome" "$spec" "lost-$outcome.csv" --shards 8 \
        >"lost-$outcome.log" 2>&1 || { cat "lost-$outcome.log" "lost-$outcome.csv".parts/*.log >&2; exit 1; }
    tail -n 1 "lost-$outcome.log"
    same "lost-$outcome.csv" "a worker lost half-way, what it ran $outcome: equal to the single run"
done

# The server, both workers and all they run are killed half-way, and everything is run again.
start all.csv
rows all.csv 300
kill -KILL -- "-$started"
wait "$started" || true
started=
[ ! -e all.csv ] || { echo 'hyperqueue.sh: the kill came too late' >&2; exit 1; }
kept=$(cat all.csv.parts/*.csv | wc -l)
start all.csv
wait "$started"
started=
same all.csv "the whole cluster killed half-way with $kept lines: equal to the single run"

for task in $(seq 8); do
    SLURM_JOB_ID=$task SLURM_ARRAY_TASK_ID=$task bash "$cluster/slurm.sh" "$spec" slurm.csv 8
done
SLURM_JOB_ID=9 bash "$cluster/slurm.sh" "$spec" slurm.csv 8
same slurm.csv 'the tasks of a job array: equal to the single run'
