#!/usr/bin/env bash
# A sweep in shards, as a Slurm job array, and a job that joins them:
#
#     bash slurm.sh sweep.toml results.csv 8                      submits both: 8 shards, joined when all are done
#     sbatch --array=3,5 slurm.sh sweep.toml results.csv 8        computes shards 3 and 5 of the 8 again
#     sbatch slurm.sh sweep.toml results.csv 8                    joins the shards
#
# The number of shards belongs to the sweep: whatever the array is, its tasks are shards of that many. A task that is killed,
# by the time limit too, keeps its rows; the same line once more goes on from there.
#SBATCH --job-name=pulloff-sweep
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --requeue
set -euo pipefail
if [ $# -ne 3 ]; then
    echo 'usage: bash slurm.sh SPEC.toml RESULTS.csv SHARDS' >&2
    exit 2
fi
spec=$1 results=$2 shards=$3
case $shards in
    '' | 0* | *[!0-9]*)
        echo "slurm.sh: SHARDS is \"$shards\", and it must be a number from 1 up" >&2
        exit 2
        ;;
esac
pulloff=${PULLOFF:-pulloff}
part() { printf '%s.parts/%s-of-%s.csv' "$results" "$1" "$shards"; }

if [ -n "${SLURM_ARRAY_TASK_ID:-}" ]; then
    # A task of an array: one shard.
    task=$SLURM_ARRAY_TASK_ID
    if [ "$task" -lt 1 ] || [ "$task" -gt "$shards" ]; then
        echo "slurm.sh: the sweep has the shards 1 to $shards, and the array has a task $task" >&2
        exit 2
    fi
    mkdir -p "$results.parts"
    exec "$pulloff" sweep "$spec" -o "$(part "$task")" --shard "$task/$shards" \
        --jobs "${SLURM_CPUS_PER_TASK:-1}" --wait
elif [ -n "${SLURM_JOB_ID:-}" ]; then
    # A job of its own: all shards into one file.
    parts=()
    for ((n = 1; n <= shards; n++)); do
        parts+=("$(part "$n")")
    done
    exec "$pulloff" sweep merge "${parts[@]}" -o "$results"
else
    # Not a job: both are submitted, the second for when the first is done.
    array=$(sbatch --parsable --array="1-$shards" "$0" "$@")
    # With several clusters it is ID;CLUSTER.
    join=$(sbatch --parsable --dependency="afterok:${array%%;*}" --kill-on-invalid-dep=yes --job-name=pulloff-merge \
        "$0" "$@")
    echo "the shards are job ${array%%;*}, joined by job ${join%%;*}"
fi
