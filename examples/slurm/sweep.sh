#!/bin/sh
# A sweep as an array of Slurm jobs, one shard each, and its table:
#
#   jobs=$(sbatch --parsable --array=0-6 examples/slurm/sweep.sh SCENE --vary "KEY=VALUES" --out FOLDER)
#   sbatch --dependency=afterok:$jobs --wrap "bearing sweep SCENE --vary 'KEY=VALUES' --out FOLDER --merge"
#
# A shard that was ended is resumed by submitting its number again.
#SBATCH --job-name=bearing-sweep
#SBATCH --cpus-per-task=1
#SBATCH --output=sweep-%A-%a.log
exec "${BEARING:-bearing}" sweep "$@" --threads "${SLURM_CPUS_PER_TASK:-1}"
