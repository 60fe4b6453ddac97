#!/bin/sh
# A sweep as an array of Slurm jobs, one shard each, and its table:
#
#   jobs=$(sbatch --parsable --array=0-6 examples/slurm/sweep.sh SCENE --vary "KEY=VALUES" --out FOLDER)
#   sbatch --dependency=afterok:$jobs --wrap "bearing sweep SCENE --vary 'KEY=VALUES' --out FOLDER --merge"
#
# Shards that were ended are resumed by their numbers, and the number of all:
#
#   SHARDS=7 sbatch --array=2,5 examples/slurm/sweep.sh SCENE --vary "KEY=VALUES" --out FOLDER
#SBATCH --job-name=bearing-sweep
#SBATCH --cpus-per-task=1
#SBATCH --output=sweep-%A-%a.log
exec "${BEARING:-bearing}" sweep "$@" --threads "${SLURM_CPUS_PER_TASK:-1}" \
    --shard "$SLURM_ARRAY_TASK_ID/${SHARDS:-$SLURM_ARRAY_TASK_COUNT}"
