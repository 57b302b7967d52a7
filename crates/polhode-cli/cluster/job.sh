#!/usr/bin/env bash
# One share of an ensemble for each task of a Slurm array, and the results of all of them:
#   sbatch --array=1-16 crates/polhode-cli/cluster/job.sh SPEC.toml DIR
#   polhode gather DIR
# The array has no gaps, as each task takes its share from its place in it. A task that was killed is run again by the same
# line: tasks whose share is finished end at once.
#SBATCH --job-name=ensemble
#SBATCH --ntasks=1
#SBATCH --cpus-per-task=1
#SBATCH --time=01:00:00
set -euo pipefail
"${POLHODE:-polhode}" ensemble "$1" --out "$2" --threads "${SLURM_CPUS_PER_TASK:-1}"
