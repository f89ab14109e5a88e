#!/usr/bin/env bash
# One shard of a sweep as a task of a Slurm job array:
#
#     sbatch slurm.sh sweep.toml results.csv
#
# A task that is killed, by the time limit too, keeps its rows; the same line once more goes on from there.
#SBATCH --job-name=pulloff-sweep
#SBATCH --array=1-8
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
#SBATCH --requeue
set -euo pipefail
spec=$1 results=$2

mkdir -p "$results.parts"
exec "${PULLOFF:-pulloff}" sweep "$spec" -o "$results.parts/$SLURM_ARRAY_TASK_ID.csv" \
    --shard "$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT" --jobs "${SLURM_CPUS_PER_TASK:-1}" --wait
